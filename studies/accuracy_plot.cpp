/// The plots: gnuplot's commands, with the data inside them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "studies/accuracy_report.h"
#include "studies/plot.h"
#include "studies/statistics.h"

namespace quadrille::studies {
namespace {

constexpr double kLeastPercent = 1e-3;  // a logarithmic axis has no zero
constexpr double kLeastRmse = 1e-3;

std::string heading() {
  return "set grid lc rgb '#dddddd'\nset border lc rgb '#444444'\nset key outside bottom center horizontal maxrows 3\nset tmargin 3\n";
}

/// The data of one scene: run time in ms, its quartiles, the error, the window.
std::string window_data(const SceneAccuracy& scene, std::size_t number) {
  std::string out = fmt::format("$windows{} << EOD\n", number);
  for (const SettingResult& s : scene.settings) {
    if (!s.error) continue;
    const Spread t = spread_of(s.cpu_s);
    out += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {}\n", 1e3 * t.median, 1e3 * t.lower_quartile, 1e3 * t.upper_quartile,
                       std::max(kLeastPercent, std::abs(s.error->cycles_percent)),
                       *s.setting.window == 0 ? "exact" : fmt::format("{}", *s.setting.window));
  }
  return out + "EOD\n";
}

std::string join(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& p : parts) out += (out.empty() ? "" : ", \\\n  ") + p;
  return out;
}

std::string precision_data(const SceneAccuracy& scene, std::size_t number, const std::string& parameter) {
  std::string out = fmt::format("${}{} << EOD\n", parameter, number);
  for (const PrecisionResult& p : scene.precision) {
    if (p.parameter == parameter) out += fmt::format("{} {:.6g}\n", p.bits, std::max(kLeastRmse, p.all.rmse));
  }
  return out + "EOD\n";
}

}  // namespace

std::string accuracy_plot(std::span<const SceneAccuracy> scenes) {
  std::string out =
      heading() +
      "set title 'Error against run time: windows of look-ahead, by cycles beyond the exact bound'\nset logscale xy\n"
      "set xlabel 'run time of the simulation, ms of processor time (median; bars: quartiles)'\n"
      "set ylabel 'error of frame cycles, % (0.001: that or less)'\nset offsets graph 0.05, graph 0.1, graph 0.05, graph 0.05\n";
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    out += window_data(scenes[i], i);
    lines.push_back(fmt::format("$windows{0} using 1:4 with lines lc {1} lw 1.5 notitle", i, i + 1));
    lines.push_back(
        fmt::format("$windows{0} using 1:4:2:3 with xerrorbars lc {1} pt 7 ps 0.6 title {2}", i, i + 1, quoted(scenes[i].name)));
    lines.push_back(fmt::format("$windows{0} using 1:4:5 with labels offset 0.3,0.7 left font ',9' tc lt {1} notitle", i, i + 1));
  }
  return out + "plot " + join(lines) + "\n";
}

std::string precision_plot(std::span<const SceneAccuracy> scenes) {
  struct Panel {
    const char* parameter;
    const char* label;
  };
  constexpr Panel kPanels[] = {
      {"subpixel_bits", "sub-pixel bits"}, {"subtexel_bits", "sub-texel bits"}, {"lod_bits", "level-of-detail bits"}};
  std::string out = heading() +
                    "set key bottom left inside vertical maxrows 0 font ',9'\nset logscale y\nset yrange [*:*]\n"
                    "set multiplot layout 1,3 title 'Error of the picture against the ideal reference: RMSE in steps of 1/255'\nset "
                    "offsets 0.3, 0.3, 0, 0\n";
  for (const Panel& panel : kPanels) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      out += precision_data(scenes[i], i, panel.parameter);
      lines.push_back(
          fmt::format("${}{} using 1:2 with linespoints lc {} pt 7 ps 0.5 title {}", panel.parameter, i, i + 1, quoted(scenes[i].name)));
    }
    out += fmt::format("set xlabel '{}'\nset xtics 1\nplot {}\nunset key\n", panel.label, join(lines));
  }
  return out + "unset multiplot\n";
}

}  // namespace quadrille::studies
