/// The plots: gnuplot's commands, with the data inside them.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "studies/accuracy_report.h"
#include "studies/plot.h"
#include "studies/statistics.h"

namespace quadrille::studies {
namespace {

// A logarithmic axis has no zero: what is smaller is drawn here.
constexpr double kLeastPercent = 1e-3, kLeastRmse = 1e-2;

/// Shapes of points: one a setting, so that settings are told apart where they lie together.
constexpr std::array<int, 8> kShapes{7, 5, 9, 11, 13, 6, 4, 8};
int shape(std::size_t setting) { return kShapes[setting % kShapes.size()]; }

constexpr const char* kFrame =
    "set grid lc rgb '#dddddd'\nset border lc rgb '#444444'\n"
    "set linetype 1 lc rgb '#0072b2'\nset linetype 2 lc rgb '#d55e00'\nset linetype 3 lc rgb '#009e73'\nset "
    "linetype 4 lc rgb '#cc79a7'\n"
    "set linetype 5 lc rgb '#e69f00'\nset linetype 6 lc rgb '#56b4e9'\n";

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& p : parts) out += (out.empty() ? "" : ", \\\n  ") + p;
  return out;
}

/// What the axes have to hold.
struct Extent {
  double left = 100, right = 100, top = 1;
};
constexpr double kMargin = 1.04;

/// A line a setting: run time and its quartiles in % of the exact run, the error, the shape of the point.
std::string window_data(const SceneAccuracy& scene, std::size_t number, Extent& extent) {
  std::string out = fmt::format("$windows{} << EOD\n", number);
  double exact_s = 1;
  for (std::size_t i = 0; i < scene.settings.size(); ++i) {
    const SettingResult& s = scene.settings[i];
    if (!s.error) continue;
    const Spread t = spread_of(s.cpu_s);
    if (s.setting.window.value_or(0) == 0) exact_s = std::max(1e-9, t.median);
    out += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {}\n", 100 * t.median / exact_s,
                       100 * t.lower_quartile / exact_s, 100 * t.upper_quartile / exact_s,
                       std::max(kLeastPercent, std::abs(s.error->cycles_percent)), shape(i));
    extent.left = std::min(extent.left, 100 * t.lower_quartile / exact_s);
    extent.right = std::max(extent.right, 100 * t.upper_quartile / exact_s);
    extent.top = std::max(extent.top, std::abs(s.error->cycles_percent));
  }
  return out + "EOD\n";
}

/// A file without its folders.
std::string short_name(const SceneAccuracy& scene) { return scene.name.substr(scene.name.rfind('/') + 1); }

double drawn_rmse(double rmse) { return std::max(kLeastRmse, rmse); }

/// A line a number of bits: the error of all pixels, and of those that show the same triangle.
std::string precision_data(const SceneAccuracy& scene, std::size_t number, const std::string& parameter) {
  std::string out = fmt::format("${}{} << EOD\n", parameter, number);
  for (const PrecisionResult& p : scene.precision) {
    if (p.parameter != parameter) continue;
    out += fmt::format("{} {:.6g} {}\n", p.bits, drawn_rmse(p.all.rmse),
                       p.same_triangle ? fmt::format("{:.6g}", drawn_rmse(p.same_triangle->rmse)) : "NaN");
  }
  return out + "EOD\n";
}

}  // namespace

std::string accuracy_plot(std::span<const SceneAccuracy> scenes) {
  std::string out = std::string(kFrame) +
                    "set title 'Error against run time: windows of look-ahead, in cycles beyond the exact "
                    "bound'\nset logscale xy\n"
                    "set key outside bottom center horizontal font ',10' samplen 2 maxrows 4\nset xtics (20, "
                    "30, 40, 50, 60, 70, 80, 90, "
                    "100, 110, 120, 150, 200, 500)\n"
                    "set xlabel 'run time of the simulation, % of the exact run (median; bars: quartiles)'\n"
                    "set ylabel 'error of frame cycles, % (0.001: that or less)'\n";
  std::vector<std::string> lines;
  Extent extent;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    out += window_data(scenes[i], i, extent);
    lines.push_back(fmt::format("$windows{} using 1:4 with lines lt {} lw 1.5 title {}", i, i + 1,
                                quoted(short_name(scenes[i]))));
    lines.push_back(fmt::format("$windows{} using 1:4:2:3 with xerrorbars lt {} pt 0 notitle", i, i + 1));
    lines.push_back(
        fmt::format("$windows{} using 1:4:5 with points lt {} pt variable ps 1 notitle", i, i + 1));
  }
  for (std::size_t i = 0; !scenes.empty() && i < scenes[0].settings.size(); ++i) {
    const SettingResult& s = scenes[0].settings[i];
    if (s.error)
      lines.push_back(
          fmt::format("NaN with points lc rgb '#444444' pt {} ps 1 title '{}'", shape(i), s.setting.name()));
  }
  return out +
         fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\nplot ", extent.left / kMargin,
                     extent.right * kMargin, kLeastPercent / 2, extent.top * 2) +
         joined(lines) + "\n";
}

std::string precision_plot(std::span<const SceneAccuracy> scenes) {
  struct Panel {
    const char* parameter;
    const char* label;
    const char* range;
  };
  constexpr std::array<Panel, 3> kPanels{{{"subpixel_bits", "sub-pixel bits", "3.5:12.5"},
                                          {"subtexel_bits", "sub-texel bits", "0.5:8.5"},
                                          {"lod_bits", "level-of-detail bits", "0.5:8.5"}}};
  std::string out =
      std::string(kFrame) +
      "set logscale y\nset xtics 1\nset key outside bottom center vertical maxrows 8 font ',9' samplen 2\n"
      "set multiplot layout 1,3 title \"Error of the picture against the ideal reference: RMSE in steps of "
      "1/255\\n"
      "solid: all pixels; dashed: those that show the same triangle\"\nset tmargin 2\n";
  for (const Panel& panel : kPanels) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      if (scenes[i].precision.empty()) continue;
      out += precision_data(scenes[i], i, panel.parameter);
      const std::string data = fmt::format("${}{}", panel.parameter, i);
      lines.push_back(fmt::format("{} using 1:2 with linespoints lt {} pt 7 ps 0.5 title {}", data, i + 1,
                                  quoted(short_name(scenes[i]))));
      lines.push_back(fmt::format("{} using 1:3 with lines lt {} dt 2 notitle", data, i + 1));
    }
    out +=
        fmt::format("set xlabel '{}'\nset xrange [{}]\nplot {}\n", panel.label, panel.range, joined(lines));
  }
  return out + "unset multiplot\n";
}

}  // namespace quadrille::studies
