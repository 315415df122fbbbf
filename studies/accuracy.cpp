#include "studies/accuracy.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "models/base/error.h"
#include "models/reference/reference.h"
#include "studies/statistics.h"

namespace quadrille::studies {
namespace {

namespace reference = models::reference;
using Pixels = std::vector<std::uint32_t>;

constexpr std::size_t kExact = 1;  // index into SceneAccuracy::settings

struct Precise {
  const char* name;
  int models::Precision::*bits;
  int least, most;
};
constexpr Precise kPrecisions[] = {{"subpixel_bits", &models::Precision::subpixel_bits, 4, 12},
                                   {"subtexel_bits", &models::Precision::subtexel_bits, 1, 8},
                                   {"lod_bits", &models::Precision::lod_bits, 1, 8}};

bool equal(const MachineCost& a, const MachineCost& b) {
  const auto same_unit = [](const UnitBusy& x, const UnitBusy& y) {
    return x.path == y.path && x.percent == y.percent;
  };
  const auto same_client = [](const ClientBytes& x, const ClientBytes& y) {
    return x.name == y.name && x.bytes == y.bytes;
  };
  return a.cycles == b.cycles && a.memory_bytes == b.memory_bytes &&
         std::ranges::equal(a.units, b.units, same_unit) &&
         std::ranges::equal(a.clients, b.clients, same_client);
}

Pixels ideal_of(const traces::CommandStream& stream) {
  reference::Options options;
  options.mode = reference::Mode::kIdeal;
  return reference::render(stream, options).color;
}

/// The measurement of one scene, step by step.
class Study {
 public:
  Study(const StudyScene& scene, const pipeline::MachineConfig& machine, const AccuracyOptions& options)
      : scene_(scene), machine_(machine), options_(options) {}

  SceneAccuracy run() {
    out_.name = scene_.name;
    time_settings();
    compare_settings();
    say("the ideal reference");
    ideal_ = ideal_of(scene_.stream);
    for (const Pixels& image : images_) out_.images.push_back(image_error(image, ideal_));
    if (options_.precision) vary_precision();
    return std::move(out_);
  }

 private:
  void say(const std::string& what) const {
    if (options_.progress) options_.progress(fmt::format("{}: {}", scene_.name, what));
  }
  [[nodiscard]] std::size_t repeat() const { return static_cast<std::size_t>(options_.repeat); }

  /// Calls `once(setting)` for all settings, round after round.
  template <class Once>
  void in_turns(const std::vector<RunSetting>& settings, const char* what, Once once) {
    for (std::size_t round = 0; round < repeat(); ++round) {
      for (const std::size_t i : round_order(settings.size(), round, repeat())) {
        say(fmt::format("{}: round {} of {}, {}", what, round + 1, repeat(), settings[i].name()));
        once(i, run_timed(scene_.stream, machine_, settings[i]));
      }
    }
  }

  void time_settings() {
    std::vector<RunSetting> settings{{std::nullopt, machine_.precision()}, {0, {}}};
    for (const std::int64_t window : options_.windows) settings.push_back({window, {}});
    out_.settings.resize(settings.size());
    for (std::size_t i = 0; i < settings.size(); ++i) out_.settings[i].setting = settings[i];
    in_turns(settings, "windows",
             [&](std::size_t i, TimedRun run) { keep(out_.settings[i], std::move(run)); });
  }

  void keep(SettingResult& result, TimedRun run) {
    out_.width = run.width;
    out_.height = run.height;
    const bool first = result.cpu_s.empty();
    result.cpu_s.push_back(run.cpu_s);
    result.wall_s.push_back(run.wall_s);
    const std::size_t image = number_of(std::move(run.color));
    QUADRILLE_CHECK(first || (image == result.image && run.cost.has_value() == result.cost.has_value() &&
                              (!run.cost || equal(*run.cost, *result.cost))),
                    "{}: two runs of '{}' differ", scene_.name, result.setting.name());
    result.image = image;
    result.cost = std::move(run.cost);
  }

  std::size_t number_of(Pixels image) {
    const auto known = std::ranges::find(images_, image);
    const auto number = static_cast<std::size_t>(known - images_.begin());
    if (known == images_.end()) images_.push_back(std::move(image));
    return number;
  }

  void compare_settings() {
    const SettingResult exact = out_.settings[kExact];
    const double exact_s = spread_of(exact.cpu_s).median;
    for (SettingResult& s : out_.settings) {
      s.speed_up = exact_s / std::max(1e-9, spread_of(s.cpu_s).median);
      if (s.cost) s.error = cost_error(*exact.cost, *s.cost);
    }
    std::swap(images_[0], images_[exact.image]);
    for (SettingResult& s : out_.settings) {
      if (s.image == exact.image) s.image = 0;
      else if (s.image == 0) s.image = exact.image;
    }
  }

  void vary_precision() {
    std::vector<RunSetting> settings;
    for (const Precise& p : kPrecisions) {
      for (int bits = p.least; bits <= p.most; ++bits) {
        models::Precision precision = machine_.precision();
        precision.*p.bits = bits;
        settings.push_back({std::nullopt, precision});
        PrecisionResult result;
        result.parameter = p.name;
        result.bits = bits;
        out_.precision.push_back(result);
      }
    }
    if (scene_.visibility) {
      say("the reference's triangles");
      ideal_triangles_ = ideal_of(*scene_.visibility);
    }
    in_turns(settings, "precisions", [&](std::size_t i, const TimedRun& run) {
      PrecisionResult& result = out_.precision[i];
      if (result.cpu_s.empty()) judge(result, run.color, settings[i].precision);
      result.cpu_s.push_back(run.cpu_s);
    });
  }

  void judge(PrecisionResult& result, const Pixels& image, const models::Precision& precision) {
    result.all = image_error(image, ideal_);
    if (!scene_.visibility) return;
    const std::vector<std::uint8_t>& other = other_triangles(precision);
    result.same_triangle = image_error(image, ideal_, other);
    result.other_triangle_percent =
        100.0 * static_cast<double>(std::ranges::count(other, 1)) / static_cast<double>(other.size());
  }

  /// By pixel: 1 where another triangle is seen than the reference shows. Texture precisions move the edges
  /// of cut-outs, and so count too.
  const std::vector<std::uint8_t>& other_triangles(const models::Precision& p) {
    const auto [place, fresh] = other_triangles_.try_emplace({p.subpixel_bits, p.subtexel_bits, p.lod_bits});
    if (!fresh) return place->second;
    const Pixels seen = run_timed(*scene_.visibility, machine_, {std::nullopt, p}).color;
    for (std::size_t i = 0; i < seen.size(); ++i)
      place->second.push_back(seen[i] != ideal_triangles_[i] ? 1 : 0);
    return place->second;
  }

  const StudyScene& scene_;
  const pipeline::MachineConfig& machine_;
  const AccuracyOptions& options_;
  SceneAccuracy out_;
  std::vector<Pixels> images_;
  Pixels ideal_, ideal_triangles_;
  /// by the bits of the three precisions
  std::map<std::array<int, 3>, std::vector<std::uint8_t>> other_triangles_;
};

}  // namespace

SceneAccuracy measure_accuracy(const StudyScene& scene, const pipeline::MachineConfig& machine,
                               const AccuracyOptions& options) {
  return Study(scene, machine, options).run();
}

}  // namespace quadrille::studies
