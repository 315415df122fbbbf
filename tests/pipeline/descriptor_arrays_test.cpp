/// Arrays of textures, samplers, blocks and buffers in whole frames, and what is refused.
#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "scenes/material/glsl.h"
#include "studies/given_reference.h"
#include "tests/pipeline/descriptor_arrays_stream.h"
#include "tests/pipeline/machine_specimen.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <filesystem>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

/// The stream with another fragment shader, which samples by `declaration`.
traces::CommandStream with_declaration(const std::string& declaration) {
  traces::CommandStream stream = descriptor_arrays_stream(1);
  const std::string source =
      "#version 450\n#extension GL_EXT_nonuniform_qualifier : require\n"
      "layout(location = 0) in vec2 at; layout(location = 0) out vec4 o;\n" +
      declaration + "}";
  stream.shaders[1].spirv = scenes::compile_glsl(source, traces::ShaderStage::kFragment, "arrays");
  return stream;
}

}  // namespace

TEST_CASE("descriptor arrays: random machines draw the functional run's pixels, and keep all laws") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    INFO("stream and machine " << seed);
    CHECK(machine_faults(descriptor_arrays_stream(seed), seed) == "");
    CHECK(machine_faults(descriptor_arrays_stream(seed, true), seed) == "");
  }
}

TEST_CASE("descriptor arrays: the machine's picture is the reference's in given mode") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const studies::MachineAndReference both =
        studies::render_with_reference(descriptor_arrays_stream(seed), {});
    const auto difference =
        models::reference::compare_images({both.machine.width, both.machine.height, both.machine.color},
                                          {both.machine.width, both.machine.height, both.reference.color});
    INFO("stream " << seed << ": " << difference.fraction_within(1));
    CHECK(difference.fraction_within(1) == 1.0);
  }
}

TEST_CASE("descriptor arrays: every element is used, so another picture of any of them shows") {
  const traces::CommandStream stream = descriptor_arrays_stream(1);
  const std::uint64_t before = functional_digest(stream);
  for (std::size_t t = 0; t < stream.images.size(); ++t) {
    if (stream.images[t].texels.empty()) continue;
    traces::CommandStream other = stream;
    for (std::byte& byte : other.images[t].texels) byte ^= std::byte{0x5a};
    INFO(stream.images[t].name);
    CHECK(functional_digest(other) != before);
  }
}

TEST_CASE("descriptor arrays: counts in an array of buffers are those of the squares") {
  const traces::CommandStream stream = descriptor_arrays_stream(1, true);
  const pipeline::RenderedFrame frame = pipeline::render_functional_frame(stream, {});
  std::uint64_t fragments = 0;
  for (const auto& buffer : frame.buffers) {
    for (std::size_t word = 0; word * 4 < buffer.data.size(); ++word) {
      std::uint32_t count = 0;
      std::memcpy(&count, &buffer.data[4 * word], 4);
      fragments += count;
    }
  }
  CHECK(frame.buffers.size() == 2);
  CHECK(fragments == 48 * 40);
}

TEST_CASE("descriptor arrays: a trace file keeps them") {
  const traces::CommandStream stream = descriptor_arrays_stream(2);
  const std::string path = (std::filesystem::temp_directory_path() / "descriptor_arrays.qtrace").string();
  traces::write_trace(stream, path);
  CHECK(traces::read_trace(path) == stream);
  std::filesystem::remove(path);
}

TEST_CASE("descriptor arrays: what is missing or not supported is named") {
  using Catch::Matchers::Contains;
  traces::CommandStream missing = descriptor_arrays_stream(1);
  std::erase_if(missing.descriptor_sets[0].textures,
                [](const auto& t) { return t.binding == models::element_binding(0, 3); });
  CHECK_THAT(refusal(missing), Contains("no texture is bound at set 0, binding 0[3]"));
  traces::CommandStream twice = descriptor_arrays_stream(1);
  twice.descriptor_sets[0].textures[0].binding = models::element_binding(0, 3);
  CHECK_THAT(refusal(twice), Contains("binding 0[3] is given twice"));
  CHECK_THAT(refusal(with_declaration("layout(set = 0, binding = 4) buffer B { uint n; } counts[2];"
                                      "void main() { o = vec4(counts[int(at.x)].n++);")),
             Contains("array of buffers with an index that is not a constant"));
  CHECK_THAT(refusal(with_declaration("layout(set = 0, binding = 0) uniform sampler2D t[];"
                                      "void main() { o = texture(t[nonuniformEXT(int(at.x))], at);")),
             Contains("without a size"));
  CHECK_THAT(refusal(with_declaration("layout(set = 0, binding = 0) uniform sampler2D t[300];"
                                      "void main() { o = texture(t[int(at.x)], at);")),
             Contains("at most 256"));
  traces::CommandStream far = descriptor_arrays_stream(1);
  std::vector<std::uint32_t>& words = far.shaders[1].spirv;
  for (std::size_t w = 3; w < words.size(); ++w)
    if (words[w - 3] == (4u << 16 | 71u) && words[w - 1] == 33) words[w] += 70000;  // OpDecorate Binding
  CHECK_THAT(refusal(far), Contains("binding 7000"));
}
