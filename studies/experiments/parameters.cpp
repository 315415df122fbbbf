/// Every parameter of the machine, changed by itself: does it do something, and what it declares?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/parameter_changes.h"
#include "studies/experiments/triangle_mesh.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

/// More of a resource may not slow a frame by more than this part, and less of it may not make it faster.
constexpr double kWrong = 0.01;
/// What declares to do nothing may not move a frame by more.
constexpr double kChaos = 0.005;
/// A change of less than this part is no effect.
constexpr double kEffect = 0.0005;
/// A short frame moves by a per cent or two when any unit acts a cycle later. What seems wrong is drawn again
/// so many times, on machines whose memory is a little farther away each time, and the mean counts.
constexpr int kShakes = 12;
constexpr int kShakeClk = 3;

/// Those that go against what they declare, and why: measured.
struct Anomaly {
  std::string_view path, cause;
};
constexpr Anomaly kAnomalies[] = {
    {"memory.queue_depth",
     "short frames: one run of kept-back writes more or less before the frame ends, 1000 to 1500 cycles "
     "here"},
    {"memory.banks", "as of memory.queue_depth: 1496 cycles of writes more within the frame of builtin:flag"},
};
/// No more are allowed.
constexpr std::size_t kMostAnomalies = 5;

std::string_view cause_of(const std::string& path) {
  const auto found = std::ranges::find(kAnomalies, path, &Anomaly::path);
  return found == std::end(kAnomalies) ? std::string_view() : found->cause;
}

/// Loads of words that lie apart, stores by pixel and counts.
traces::CommandStream storage_stream(const Setting& setting) {
  constexpr std::uint32_t kRead = 8192, kCounts = 64;  // words
  const std::string shader = storage_shader(fmt::format(
      "uint at = uint(gl_FragCoord.y) * {0}u + uint(gl_FragCoord.x); uint v = b.w[at * 37u % {1}u] + at;"
      "atomicAdd(b.w[{1}u + at % {2}u], v); b.w[{1}u + {2}u + at] = v; o = vec4(float(v % 256u) / 255.0);",
      setting.width, kRead, kCounts));
  return stream_of(
      layers(setting.width, setting.height, 4, true),
      {.fragment_shader = shader, .storage_words = kRead + kCounts + setting.width * setting.height});
}

/// What none of the scenes has: triangles beyond the guard band, many small ones, the same dropped by set-up,
/// layers that lie behind each other, fragments that the shader drops, blended as floats, layers from back to
/// front, lines within and beyond the guard band, points, compressed textures, storage buffers, and draws out
/// of view.
std::vector<traces::CommandStream> own_streams(const Setting& setting) {
  using traces::Format;
  constexpr std::int32_t kBeyond = 100'000;  // pixels
  constexpr int kLayers = 8;
  TriangleMesh clipped{setting.width, setting.height, {}, {}};
  for (int i = 0; i < kLayers; ++i) clipped.rectangle(-kBeyond + i, -kBeyond, kBeyond, kBeyond - i, 0.5F);
  const TriangleMesh hiding = layers(setting.width, setting.height, kLayers, true);
  const TriangleMesh small = tiled_frame(setting.width, setting.height, 2, 2);
  std::vector<traces::CommandStream> streams;
  streams.push_back(stream_of(clipped));
  streams.push_back(stream_of(small));
  streams.push_back(stream_of(small, {.cull = traces::CullMode::kBack}));
  streams.push_back(stream_of(hiding, {.depth = true}));
  streams.push_back(stream_of(
      hiding, {.depth = true, .discards = true, .blends = true, .format = Format::kR16G16B16A16Float}));
  streams.push_back(stream_of(layers(setting.width, setting.height, kLayers, false),
                              {.depth = true, .blends = true, .format = Format::kR32G32Float}));
  streams.push_back(stream_of(clipped, {.topology = traces::Topology::kLineList}));
  streams.push_back(stream_of(through_near_plane(setting.width, setting.height, 1),
                              {.topology = traces::Topology::kLineList, .depth = true}));
  streams.push_back(stream_of(small, {.topology = traces::Topology::kLineList}));
  streams.push_back(stream_of(small, {.topology = traces::Topology::kPointList}));
  for (const Format format : {Format::kBc1RgbaUnorm, Format::kAstc4x4Unorm}) {
    const DrawTexture blocks{4 * setting.width, 4 * setting.height, 1, traces::Filter::kLinear, format};
    streams.push_back(
        stream_of(layers(setting.width, setting.height, 2, false),
                  {.fragment_shader = sampling_shader(blocks, {.right = 4, .down = 4}), .texture = blocks}));
  }
  streams.push_back(storage_stream(setting));
  streams.push_back(stream_of(moved_right(small, 2 * setting.width), {.draws = kLayers}));
  return streams;
}

/// By how much a change made frames longer, as a part of them.
struct Measured {
  double mean = 0;      ///< over the scenes
  double greatest = 0;  ///< of one scene, without sign
};

class Sweep {
 public:
  explicit Sweep(const Setting& setting) : setting_(setting) {
    for (const auto& [name, load] : setting.scenes) streams_.push_back(load());
    for (traces::CommandStream& stream : own_streams(setting)) streams_.push_back(std::move(stream));
  }

  std::vector<Measured> measure(const std::vector<Change>& changes, int shakes) const {
    std::vector<Machine> machines;
    std::map<std::vector<std::string>, std::size_t> bases;
    const auto add_base = [&](const std::vector<std::string>& settings) {
      const auto [place, fresh] = bases.emplace(settings, machines.size());
      if (fresh) machines.push_back(settings);
      return place->second;
    };
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // ground, changed: of each change its shakes
    for (const Change& c : changes) {
      for (int shake = 0; shake < shakes; ++shake) {
        Machine machine = shaken(c, shake);
        const std::size_t base = add_base(machine);
        machine.push_back(c.path + "=" + c.value);
        pairs.emplace_back(base, machines.size());
        machines.push_back(machine);
      }
    }
    const std::vector<std::vector<double>> cycles = frame_cycles(streams_, machines, setting_);
    std::vector<Measured> all(changes.size());
    for (std::size_t i = 0; i < changes.size(); ++i) {
      for (std::size_t s = 0; s < streams_.size(); ++s) {
        double base = 0, changed = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(shakes); ++k) {
          const auto& [b, c] = pairs[i * static_cast<std::size_t>(shakes) + k];
          base += cycles[b][s];
          changed += cycles[c][s];
        }
        all[i].mean += (changed / base - 1) / static_cast<double>(streams_.size());
        all[i].greatest = std::max(all[i].greatest, std::abs(changed / base - 1));
      }
    }
    return all;
  }

 private:
  using Machine = std::vector<std::string>;
  static Machine shaken(const Change& c, int shake) {
    Machine machine = c.settings;
    if (shake == 0) return machine;
    const pipeline::MachineConfig plain;
    const int farther = kShakeClk * shake;
    if (c.path == "memory.path_clk")
      machine.push_back(fmt::format("l2.hit_clk={}", plain.l2.hit_clk + farther));
    else machine.push_back(fmt::format("memory.path_clk={}", plain.memory.path_clk + farther));
    return machine;
  }

  const Setting& setting_;
  std::vector<traces::CommandStream> streams_;
};

/// Does it go against what its parameter declares?
bool is_wrong(const Change& c, double mean) {
  if (c.effect == hw::Effect::kNeutral) return std::abs(mean) > kChaos;
  if (c.effect != hw::Effect::kFaster && c.effect != hw::Effect::kSlower) return false;
  const bool should_gain = c.more == (c.effect == hw::Effect::kFaster);
  return should_gain ? mean > kWrong : mean < -kWrong;
}

/// What is known of a parameter by now.
struct Finding {
  hw::Effect effect = hw::Effect::kFaster;
  double greatest = 0;
  std::string wrong;
};
using Findings = std::map<std::string, Finding>;

/// Measures changes, and again those that seem wrong.
void try_changes(const Sweep& sweep, const std::vector<Change>& changes, Findings& findings) {
  const std::vector<Measured> first = sweep.measure(changes, 1);
  std::vector<Change> suspects;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Finding& finding = findings[changes[i].path];
    finding.effect = changes[i].effect;
    finding.greatest = std::max(finding.greatest, first[i].greatest);
    if (is_wrong(changes[i], first[i].mean)) suspects.push_back(changes[i]);
  }
  const std::vector<Measured> again = sweep.measure(suspects, kShakes);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    if (!is_wrong(suspects[i], again[i].mean)) continue;
    std::string& wrong = findings[suspects[i].path].wrong;
    wrong += fmt::format("{}{} on {}: {:+.1f} %", wrong.empty() ? "" : "; ", suspects[i].value,
                         suspects[i].ground, 100 * again[i].mean);
  }
}

bool without_effect(const Finding& finding) {
  return finding.greatest < kEffect && finding.effect != hw::Effect::kNeutral;
}

std::vector<std::string> silent(const Findings& findings) {
  std::vector<std::string> paths;
  for (const auto& [path, finding] : findings)
    if (without_effect(finding)) paths.push_back(path);
  return paths;
}

}  // namespace

Result parameters(const Setting& setting) {
  const Sweep sweep(setting);
  Findings findings;
  const std::vector<Change> near = near_changes();
  try_changes(sweep, near, findings);
  const std::vector<Change> far = far_changes(silent(findings));
  try_changes(sweep, far, findings);

  Result result;
  result.table.head = {"parameter", "more is", "greatest change of a frame, %", "against what it declares",
                       "cause"};
  std::string data;
  std::size_t unnamed = 0, named = 0;
  for (const auto& [path, finding] : findings) {
    const std::string_view cause = cause_of(path);
    if (!finding.wrong.empty()) ++(cause.empty() ? unnamed : named);
    result.table.rows.push_back(
        {path, std::string(hw::effect_name(finding.effect)),
         fmt::format("{:.2f}{}", 100 * finding.greatest, without_effect(finding) ? " (none)" : ""),
         finding.wrong, finding.wrong.empty() ? "" : std::string(cause)});
    data += fmt::format("{}\n", std::max(0.01, 100 * finding.greatest));
  }
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  result.verdicts = {
      {"parameters that go against what they declare, without a known cause", count(unnamed), 0, 0},
      {"parameters that do so with a cause named here", count(named), 0, count(kMostAnomalies)},
      {"parameters without any effect", count(silent(findings).size()), 0, 0}};
  result.remarks = {
      fmt::format("{} changes: half and twice of each number and every other word of each choice, on three "
                  "machines (of links on the default one); and {} "
                  "of those that did nothing so, farther and on machines made for them. What seemed wrong "
                  "was drawn {} times.",
                  near.size(), far.size(), kShakes)};
  result.plot =
      "set logscale y\nset ylabel 'greatest change, % of a frame'\nset xlabel 'parameters, in the order of "
      "the table'\nset grid y\nset "
      "key off\n$d << EOD\n" +
      data + "EOD\nplot $d using 0:1 with impulses lw 2";
  return result;
}

}  // namespace quadrille::studies::experiments
