/// A scene, trace or capture as the arguments name it, loaded.
#include <fmt/format.h>

#include "cli/scene_arguments.h"
#include "traces/capture/import.h"
#include "traces/trace_file.h"

namespace quadrille::cli {

traces::CommandStream SceneArguments::load_visibility() const {
  scenes::SceneOptions visible = options();
  visible.visibility = true;
  return scenes::load_scene(scene, visible);
}

SceneArguments::Loaded SceneArguments::record(scenes::Scene& file, const scenes::Moment& moment) const {
  Loaded loaded{file.record(moment), {}};
  use_samples(loaded.stream);
  use_anisotropy(loaded.stream);
  use_compression(loaded.stream);
  use_queries(loaded.stream);
  if (exposure == "auto") fmt::print(stderr, "{}: exposure {:.4g}\n", scene, file.exposure());
  if (const std::size_t packed = file.unused_images(); packed > 0)
    loaded.left_out.push_back({"images", "no shader of the frame samples them",
                               fmt::format("{} images of the file stay packed", packed)});
  if (const auto depths = file.depth_range())
    fmt::print(stderr, "{}: depth {:.9g} is white, {:.9g} black\n", scene, depths->first, depths->second);
  const std::size_t shaders = loaded.stream.shaders.size();
  if (leave_out && shaders > 0 && file.compiled_shaders() == 0)
    loaded.left_out.push_back({"GLSL compiler", "all shaders of the frame are at hand as SPIR-V",
                               fmt::format("compiling {} shaders", shaders)});
  return loaded;
}

SceneArguments::Loaded SceneArguments::take_import(capture::Import import) const {
  Loaded loaded{std::move(import.stream), {}};
  for (const std::string& note : import.notes) fmt::print(stderr, "{}: {}\n", scene, note);
  for (const auto& [reason, count] : import.skipped) {
    fmt::print(stderr, "{}: left out, {} times: {}\n", scene, count, reason);
    loaded.left_out.push_back({"commands of the capture", "not supported: " + reason,
                               fmt::format("drawing them, {} times; the picture lacks them", count)});
  }
  return loaded;
}

void SceneArguments::change(traces::CommandStream& stream) const {
  cut(stream);
  use_samples(stream);
  use_anisotropy(stream);
  use_compression(stream);
  use_queries(stream);
}

SceneArguments::Loaded SceneArguments::load() const {
  if (is_trace()) {
    Loaded loaded = is_capture()
                        ? take_import(capture::import_capture(scene, {.skip_unsupported = skip_unsupported}))
                        : Loaded{traces::read_trace(scene), {}};
    change(loaded.stream);
    return loaded;
  }
  const scenes::SceneOptions wanted = options();
  scenes::Scene file(scene, wanted);
  return record(file, {wanted.time.value_or(0), wanted.orbit});
}

}  // namespace quadrille::cli
