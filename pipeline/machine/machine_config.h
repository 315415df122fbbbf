/// A machine: every parameter of every unit and link, by path. Loaded from TOML, changed by `--set`, printed
/// by `quadrille describe`.
///
/// Paths are `group.parameter`: `gpu.cores`, `coarse_raster.tests_per_clk`, `link.coarse_to_fine.depth`. An
/// unknown key or an illegal value is an error that names the file, the line, the key and the legal values.
///
/// Machines come in layers: a file may name another machine as its `base` and say only what differs, and
/// `--set` is a layer more. A machine therefore knows the one it was made from, the last that came with the
/// program, and what was changed since.
#pragma once

#include "pipeline/driver/frame_target.h"
#include "pipeline/machine/machine_plan.h"

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

/// The whole: how many of each unit, clocks, widths.
struct GpuParams : hw::ParamGroup {
  hw::Param<int> cores{*this,   "cores",
                       4,       "core",
                       {1, 64}, "Shader cores, each with a texture unit. [G: a small integrated GPU]"};
  hw::Param<int> partitions{*this,
                            "partitions",
                            2,
                            "partition",
                            {1, 64},
                            "Screen partitions, each with a depth unit, a warp packer and a ROP. [G]",
                            hw::Effect::kTradeOff};
  hw::Param<int> engines{*this,
                         "engines",
                         1,
                         "engine",
                         {1, 16},
                         "Raster engines, each with set-up, coarse and fine rasteriser, for an equal part of "
                         "the screen partitions, which are a multiple of them. [G: as small GPUs]"};
  hw::Param<int> front_ends{
      *this,
      "front_ends",
      1,
      "front end",
      {1, 16},
      "Geometry front ends, each with vertex fetch, primitive assembly and clipper. They share each draw by "
      "vertex_fetch.range_primitives, so batches at the ends of ranges are less full. [G: as small GPUs]",
      hw::Effect::kTradeOff};
  hw::Param<int> channels{*this,     "channels", 2,
                          "channel", {1, 64},    "Memory channels, each with an L2 slice. [G]"};
  hw::Param<double> clock_mhz{*this,
                              "clock_mhz",
                              1000,
                              "MHz",
                              {0.001, 1e6},
                              "Clock of everything but the memory channels. [G]",
                              hw::Effect::kTradeOff};
  hw::Param<double> memory_mhz{*this, "memory_mhz", 1000,
                               "MHz", {0.001, 1e6}, "Clock of the memory channels. [G]"};
  hw::Param<int> memory_mib{
      *this, "memory_mib", 4096, "MiB", {1, 16384}, "Device memory. [G]", hw::Effect::kNeutral};
  hw::Param<int> subpixel_bits{*this,
                               "subpixel_bits",
                               8,
                               "bit",
                               {4, 12},
                               "Fractional bits of window positions. [VK1.3 limit subPixelPrecisionBits]",
                               hw::Effect::kPicture};
  hw::Param<int> subtexel_bits{*this,
                               "subtexel_bits",
                               8,
                               "bit",
                               {1, 8},
                               "Fractional bits of texture coordinates. [VK1.3 limit subTexelPrecisionBits]",
                               hw::Effect::kPicture};
  hw::Param<int> lod_bits{*this,
                          "lod_bits",
                          8,
                          "bit",
                          {1, 8},
                          "Fractional bits of the level of detail. [VK1.3 limit mipmapPrecisionBits]",
                          hw::Effect::kPicture};
  hw::Param<bool> linear_log2{
      *this,
      "linear_log2",
      false,
      "",
      "Level of detail by a log2 that is linear between powers of two. [M: Mesa's lavapipe does so]",
      hw::Effect::kPicture};
  hw::Choice<models::AnisotropicFootprint> anisotropic_footprint{
      *this,
      "anisotropic_footprint",
      models::AnisotropicFootprint::kLongerDifference,
      {"longer_difference", "ellipse_axis", "ellipse"},
      "What an anisotropic filter takes: samples along a pixel's longer difference, as in Vulkan's "
      "equations, "
      "or along the longer axis of its ellipse, or the texels within the ellipse by their weights. [P: "
      "Heckbert "
      "1989]",
      hw::Effect::kPicture};
};

/// How many tokens the producer of a link can have for it: what that does not reach, more depth or width does
/// nothing.
enum class LinkFlow : std::uint8_t { kSeveralACycle, kOneACycle, kOneAPass };

/// One class of links. Full rate needs depth >= width * (latency + credit_latency).
struct LinkParams : hw::ParamGroup {
  /// `link_name` has to live as long.
  LinkParams(std::string_view link_name, int depth_default, int width_default, int latency_default,
             LinkFlow flow)
      : name(link_name),
        depth{*this,
              "depth",
              depth_default,
              "token",
              {1, 1 << 20},
              "Tokens the link holds.",
              unless_one_a_pass(flow, hw::Effect::kFaster)},
        width{*this,
              "width",
              width_default,
              "token/clk",
              {1, 64},
              "Tokens a cycle.",
              flow == LinkFlow::kSeveralACycle ? hw::Effect::kFaster : hw::Effect::kNeutral},
        latency{*this,
                "latency",
                latency_default,
                "clk",
                {1, 1 << 24},
                "Cycles from push to visibility.",
                hw::Effect::kSlower},
        credit_latency{*this,
                       "credit_latency",
                       1,
                       "clk",
                       {1, 1 << 24},
                       "Cycles from pop to a usable slot.",
                       unless_one_a_pass(flow, hw::Effect::kSlower)} {}
  std::string_view name;
  hw::Param<int> depth, width, latency, credit_latency;
  [[nodiscard]] hw::LinkSpec spec() const { return {depth, width, latency, credit_latency}; }

 private:
  static hw::Effect unless_one_a_pass(LinkFlow flow, hw::Effect effect) {
    return flow == LinkFlow::kOneAPass ? hw::Effect::kNeutral : effect;
  }
};

struct Links {
#define QUADRILLE_LINK(name, depth, width, latency, flow, way, ...) \
  LinkParams name{#name, depth, width, latency, LinkFlow::flow};
  QUADRILLE_LINKS(QUADRILLE_LINK)
#undef QUADRILLE_LINK
};

class MachineConfig {
 public:
  MachineConfig();
  MachineConfig(const MachineConfig&) = delete;
  MachineConfig& operator=(const MachineConfig&) = delete;

  GpuParams gpu;
#define QUADRILLE_PARAMS(name, type, how_often, frames) type::Params name;
  QUADRILLE_UNITS(QUADRILLE_PARAMS)
#undef QUADRILLE_PARAMS
  Links link;

  /// what reports call it: the name of the machine that comes with the program, or of its file
  std::string name = "default";

  /// A parameter whose value differs from that of the base.
  struct Change {
    std::string path, value, base_value;
  };
  /// The machine this one was made from: one that comes with the program; "default" where no file names
  /// another.
  [[nodiscard]] const std::string& base() const { return base_; }
  /// What was changed since, in the order of `groups()`.
  [[nodiscard]] std::vector<Change> changes() const;
  /// From here on, this is the base called `name`.
  void become_base(const std::string& name);
  /// In a line: "large", "large with gpu.cores=8 (16)", "mine.toml: large with gpu.cores=8 (16) and 12 more".
  /// In brackets is what the base has.
  [[nodiscard]] std::string title() const;

  /// Every group with its path, in the order of the pipeline.
  [[nodiscard]] const std::vector<std::pair<std::string, hw::ParamGroup*>>& groups() const { return groups_; }
  /// `group.parameter` of every parameter.
  [[nodiscard]] std::vector<std::string> paths() const;
  /// What is set from here on belongs together: a file, or all of `--set`. Within a layer the order does not
  /// matter in which `memory.kind` and what it stands for are set.
  void begin_layer() { given_.clear(); }
  /// The parameter of that name; null if there is none.
  [[nodiscard]] const hw::ParamBase* find(std::string_view key) const;
  /// Sets `group.parameter` from text; `memory.kind` also what its data file holds and this layer does not
  /// set. Throws `UserError` with the key and what is legal; `where` leads it.
  void set(std::string_view key, std::string_view value, std::string_view where);
  /// Checks that hold between parameters.
  void check() const;
  [[nodiscard]] models::Precision precision() const {
    return {gpu.subpixel_bits, gpu.subtexel_bits, gpu.lod_bits, gpu.linear_log2, gpu.anisotropic_footprint};
  }
  /// What a frame in its memory depends on.
  [[nodiscard]] FrameTarget frame_target() const { return {shader_target(), texture.layout.value()}; }
  /// What the shader compiler knows of the cores.
  [[nodiscard]] ShaderTarget shader_target() const {
    return {core.warp_slots, core.register_rows, hw::ShaderCore::issue_timing(core)};
  }

 private:
  [[nodiscard]] std::vector<std::string> values() const;
  void assign(std::string_view key, std::string_view value, std::string_view where);
  void check_memory() const;

  std::vector<std::pair<std::string, hw::ParamGroup*>> groups_;
  std::string base_ = "default";
  std::set<std::string, std::less<>> given_;  ///< keys that this layer set
  std::vector<std::string> base_values_;      ///< of every parameter, in the order of `groups_`
};

/// Applies a machine: a path ending in .toml, or the name of one in configs/. Its base, and the base of that,
/// are applied before it. Throws `UserError`.
void load_machine(MachineConfig& config, const std::string& name_or_path);
/// Applies the text of a machine file (TOML); `file` is its name in errors, and a base that is a path is
/// looked for beside it. Throws `UserError` with file and line.
void apply_machine_text(MachineConfig& config, std::string_view text, const std::string& file);
/// What a kind of memory stands for: keys and values of its data file, `gpu.memory_mhz` among them. Throws
/// `UserError`.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> memory_kind_values(const std::string& kind);
/// Names of the machines that come with the program.
[[nodiscard]] std::vector<std::string> machine_names();

/// Parameters of a group, by its path.
using DescribedGroup = std::pair<std::string, std::vector<const hw::ParamBase*>>;
/// Them as the text of a machine file: each with its value, and a comment with unit, legal values and reason.
/// Read back, they give the same values.
[[nodiscard]] std::string machine_toml(const std::vector<DescribedGroup>& groups);

}  // namespace quadrille::pipeline
