/// The arguments that say what to draw, shared by `render` and `trace record`.
#pragma once

#include <CLI/CLI.hpp>

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/driver/frame_builder.h"
#include "scenes/scene.h"

namespace quadrille::capture {
struct Import;
}  // namespace quadrille::capture

namespace quadrille::cli {

struct SceneArguments {
  std::string scene;  ///< .gltf, .glb, .qtrace, .gfxr or builtin:NAME
  std::optional<std::string> size, scene_choice, camera, eye, at, time, animation, exposure, environment,
      shading, order, view, color_format, depth_format, vert, frag;
  std::optional<std::string> samples;  ///< a pixel, of a scene or trace
  std::optional<std::string> transparency, transparency_layers;
  std::optional<std::string> anisotropy, compress;
  std::optional<std::string> last_pass, draws;  ///< that are kept of a trace or capture
  bool supersample = false;                     ///< each sample is shaded for itself
  bool alpha_to_coverage = false;               ///< of masked materials; not of a trace
  bool skip_unsupported = false;                ///< of a capture, draw without it
  bool queries = false;                         ///< around every draw and pass

  /// false: also load what no shader of the frame samples; set by the commands that offer it
  bool leave_out = true;
  /// textures are unpacked by the machine, when it samples them; set by the commands that run one on the
  /// frame alone
  bool keep_packed = false;

  /// Adds SCENE and the options that choose the view and the shaders.
  void add_to(CLI::App& command);
  /// Adds those options alone, for a command that takes several scenes. `default_size` is what its help
  /// names.
  void add_view_to(CLI::App& command, const std::string& default_size);
  /// Adds --color-format and --depth-format, for a command that draws or records.
  void add_formats_to(CLI::App& command);
  /// Adds --transparency and --transparency-layers, for such a command.
  void add_transparency_to(CLI::App& command);
  /// Adds --samples and what goes with it, for a command that draws or records.
  void add_samples_to(CLI::App& command);
  /// Adds --queries, for a command that draws or records.
  void add_queries_to(CLI::App& command);
  /// Adds --skip-unsupported, for a command that draws or imports.
  void add_capture_to(CLI::App& command);
  /// Adds SCENE alone, for a trace, which has its view and shaders in it.
  void add_trace_to(CLI::App& command);
  /// Checks everything that needs no file to be read. Throws `UserError` naming the flag.
  void check() const;
  /// Checks that the file, or the built-in scene, is there: for a command that measures several, before it
  /// measures the first. Throws `UserError`.
  void check_there() const;
  struct Loaded {
    traces::CommandStream stream;
    std::vector<pipeline::LeftOut> left_out;  ///< what loading did not have to do
  };
  /// One frame of a scene that is open, with what did not have to be done for it.
  [[nodiscard]] Loaded record(scenes::Scene& file, const scenes::Moment& moment) const;
  /// Takes a frame of a capture, and says on standard error what of it is missing.
  [[nodiscard]] Loaded take_import(capture::Import import) const;
  /// Makes a trace's or capture's frame what the arguments ask for: a part of it, samples, queries. Throws
  /// `UserError`.
  void change(traces::CommandStream& stream) const;
  /// Loads the scene or trace. Throws `UserError`.
  [[nodiscard]] Loaded load() const;
  /// Lets the passes of a stream have the wished samples, and shade by sample if wished. Throws `UserError`.
  void use_samples(traces::CommandStream& stream) const;
  void check_cut() const;
  /// Of a trace or capture, what `--pass` and `--draws` keep.
  void cut(traces::CommandStream& stream) const;
  void use_compression(traces::CommandStream& stream) const;
  void use_anisotropy(traces::CommandStream& stream) const;
  /// Puts queries around its draws and passes if wished. Throws `UserError`.
  void use_queries(traces::CommandStream& stream) const;
  /// The same frame in the colours of its triangles (`scenes::triangle_id_color`). Not of a trace.
  [[nodiscard]] traces::CommandStream load_visibility() const;
  /// Of a file that holds a frame's commands: a trace of ours, or a capture.
  [[nodiscard]] bool is_trace() const;
  [[nodiscard]] bool is_capture() const;
  /// Throws `UserError` naming the flag.
  [[nodiscard]] models::TransparencyState parse_transparency() const;
  /// The options as the scene library takes them. Throws `UserError` naming the flag.
  [[nodiscard]] scenes::SceneOptions options() const;
};

/// "1920x1080", each side 1..16384. Throws `UserError` naming `flag`.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_size(std::string_view text,
                                                                 std::string_view flag);
/// "X,Y,Z": three finite numbers. Throws `UserError` naming `flag`.
[[nodiscard]] glm::vec3 parse_point(std::string_view text, std::string_view flag);
/// A number within [least, most]. Throws `UserError` naming `flag`.
[[nodiscard]] double parse_number(std::string_view text, std::string_view flag, double least, double most);
/// 1, 2, 4 or 8. Throws `UserError`.
[[nodiscard]] std::uint32_t parse_samples(std::string_view text);
/// A whole number within [least, most]. Throws `UserError` naming `flag`.
[[nodiscard]] std::int64_t parse_whole(std::string_view text, std::string_view flag, std::int64_t least,
                                       std::int64_t most);

}  // namespace quadrille::cli
