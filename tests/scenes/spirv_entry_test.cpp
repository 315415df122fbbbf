#include "scenes/material/spirv_entry.h"

#include <catch2/catch.hpp>

#include "models/base/error.h"
#include "scenes/material/glsl.h"

namespace quadrille::scenes {
namespace {

using Words = std::vector<std::uint32_t>;
using traces::ShaderStage;

constexpr std::size_t kHeaderWords = 5, kNameWord = 3;

Words fragment() {
  return compile_glsl(
      "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1); }\n",
      ShaderStage::kFragment, "f");
}

std::size_t place_of_entry(const Words& spirv) {
  for (std::size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    if ((spirv[at] & 0xffff) == 15) return at;
  }
  FAIL("no entry point");
  return 0;
}

/// "main" and its end replaced by other words of text.
Words renamed(Words spirv, const Words& name) {
  const std::size_t at = place_of_entry(spirv);
  const auto first = spirv.begin() + static_cast<std::ptrdiff_t>(at + kNameWord);
  spirv.erase(first, first + 2);
  spirv.insert(spirv.begin() + static_cast<std::ptrdiff_t>(at + kNameWord), name.begin(), name.end());
  spirv[at] += static_cast<std::uint32_t>(name.size() - 2) << 16;
  return spirv;
}

const Words kShade{0x64616873, 0x00000065}, kLongName{0x64616873, 0x6c5f6465, 0x5f676e6f, 0x656d616e, 0};

}  // namespace

TEST_CASE("spir-v entry point: the only one of the stage is called main, and said so") {
  for (const Words& name : {kShade, kLongName, Words{0x00000066}}) {
    Words spirv = renamed(fragment(), name);
    std::string note;
    call_entry_point_main(spirv, ShaderStage::kFragment, "x.spv", note);
    CHECK(spirv == fragment());
    CHECK_THAT(note, Catch::Contains("x.spv") && Catch::Contains("fragment") && !Catch::Contains("\n"));
  }
}

TEST_CASE("spir-v entry point: main stays as it is, in silence") {
  Words spirv = fragment();
  std::string note;
  call_entry_point_main(spirv, ShaderStage::kFragment, "x.spv", note);
  CHECK(spirv == fragment());
  CHECK(note.empty());
}

TEST_CASE("spir-v entry point: several, or none of the stage, are refused with their names") {
  Words spirv = renamed(fragment(), kShade);
  const std::size_t at = place_of_entry(spirv);
  const Words entry(spirv.begin() + static_cast<std::ptrdiff_t>(at),
                    spirv.begin() + static_cast<std::ptrdiff_t>(at + (spirv[at] >> 16)));
  spirv.insert(spirv.begin() + static_cast<std::ptrdiff_t>(at), entry.begin(), entry.end());
  spirv[at + kNameWord] = 0x6c616873;  // "shal", so "shale"
  std::string note;
  CHECK_THROWS_WITH(call_entry_point_main(spirv, ShaderStage::kFragment, "x.spv", note),
                    Catch::Contains("'shale' (fragment), 'shade' (fragment)") && Catch::Contains("x.spv"));
  CHECK_THROWS_WITH(call_entry_point_main(spirv, ShaderStage::kVertex, "x.spv", note),
                    Catch::Contains("no entry point of the vertex stage"));
}

TEST_CASE("spir-v entry point: a module cut short anywhere is left to be refused later") {
  const Words whole = renamed(fragment(), kLongName);
  for (std::size_t size = kHeaderWords; size < whole.size(); ++size) {
    Words spirv(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    std::string note;
    call_entry_point_main(spirv, ShaderStage::kFragment, "x.spv", note);
  }
}

}  // namespace quadrille::scenes
