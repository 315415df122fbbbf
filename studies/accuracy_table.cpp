/// The tables: a row a setting, the unit of every column in its heading.
#include <cmath>

#include <fmt/format.h>

#include "pipeline/report/unit_facets.h"
#include "studies/accuracy_report.h"
#include "studies/statistics.h"

namespace quadrille::studies {
namespace {

constexpr double kMilli = 1e3;

std::string percent(double value) { return value == 0 ? "0" : fmt::format("{:+.3f}", value); }
std::string points(double value) { return value == 0 ? "0" : fmt::format("{:.3f}", value); }

std::string time_columns(const std::vector<double>& cpu_s) {
  const Spread s = spread_of(cpu_s);
  const std::string range = fmt::format("{:.1f}..{:.1f}", kMilli * s.least, kMilli * s.most);
  return fmt::format("{:>9.1f}  {:<15}", kMilli * s.median, range);
}

std::string setting_row(const SettingResult& s) {
  std::string row = fmt::format("  {:<12}{}{:>6.2f}", s.setting.name(), time_columns(s.cpu_s), s.speed_up);
  if (s.cost && s.error) {
    row += fmt::format(
        "{:>14}{:>10}{:>8}{:>8}  {:<18}{:>9.2f}{:>9}{:>9}  {:<13}",
        pipeline::grouped(static_cast<std::uint64_t>(s.cost->cycles)), percent(s.error->cycles_percent),
        points(s.error->busy_mean_points), points(s.error->busy_max_points),
        s.error->worst_unit.empty() ? "-" : s.error->worst_unit,
        static_cast<double>(s.cost->memory_bytes) * 1e-6, percent(s.error->memory_percent),
        points(s.error->client_max_percent), s.error->worst_client.empty() ? "-" : s.error->worst_client);
  } else {
    row += fmt::format("{:>14}{:>10}{:>8}{:>8}  {:<18}{:>9}{:>9}{:>9}  {:<13}", "-", "-", "-", "-", "-", "-",
                       "-", "-", "-");
  }
  return row + (s.image == 0 ? "equal" : "DIFFERS") + "\n";
}

std::string settings_table(const SceneAccuracy& scene) {
  std::string out = fmt::format(
      "  {:<12}{:>9}  {:<15}{:>6}{:>14}{:>10}{:>16}  {:<18}{:>9}{:>9}{:>9}  {:<13}{}\n", "", "run time", "",
      "speed", "frame", "error", "busy, off by", "", "memory", "error", "error", "", "picture");
  out += fmt::format("  {:<12}{:>9}  {:<15}{:>6}{:>14}{:>10}{:>8}{:>8}  {:<18}{:>9}{:>9}{:>9}  {:<13}{}\n",
                     "setting", "ms", "min..max", "up", "cycles", "%", "mean pp", "max pp", "worst unit",
                     "MB", "%", "max %", "worst client", "is exact's");
  for (const SettingResult& s : scene.settings) out += setting_row(s);
  return out;
}

std::string decibels(double psnr) { return std::isinf(psnr) ? "inf" : fmt::format("{:.2f}", psnr); }

std::string image_row(std::size_t number, const ImageError& e) {
  return fmt::format(
      "  picture {}   RMSE {:.4f} of 255   PSNR {} dB   within 1: {:.3f} %   within 2: {:.3f} %   largest {} "
      "of 255\n",
      number + 1, e.rmse, decibels(e.psnr_db), e.within_1_percent, e.within_2_percent, e.max);
}

std::string precision_row(const PrecisionResult& p) {
  std::string row = fmt::format("  {:<14}{:>5}{:>12.4f}{:>10}{:>12.4f}", p.parameter, p.bits, p.all.rmse,
                                decibels(p.all.psnr_db), 100 - p.all.within_2_percent);
  if (p.same_triangle && p.other_triangle_percent) {
    row += fmt::format("{:>14.4f}{:>14.4f}{:>10}{:>12.4f}", *p.other_triangle_percent, p.same_triangle->rmse,
                       decibels(p.same_triangle->psnr_db), 100 - p.same_triangle->within_2_percent);
  } else {
    row += fmt::format("{:>14}{:>14}{:>10}{:>12}", "-", "-", "-", "-");
  }
  row += "  " + time_columns(p.cpu_s);
  return row.erase(row.find_last_not_of(' ') + 1) + "\n";
}

std::string precision_table(const SceneAccuracy& scene) {
  std::string out = fmt::format("\n  {:<14}{:>5}{:>34}{:>14}{:>36}  {:>9}\n", "", "", "all pixels", "another",
                                "pixels of the same triangle", "run time");
  out += fmt::format("  {:<14}{:>5}{:>12}{:>10}{:>12}{:>14}{:>14}{:>10}{:>12}  {:>9}  {}\n", "gpu.", "bits",
                     "RMSE of 255", "PSNR dB", "off by >2 %", "triangle %", "RMSE of 255", "PSNR dB",
                     "off by >2 %", "ms", "min..max");
  std::string last;
  for (const PrecisionResult& p : scene.precision) {
    if (!last.empty() && p.parameter != last) out += "\n";
    last = p.parameter;
    out += precision_row(p);
  }
  return out;
}

}  // namespace

std::string accuracy_table(const SceneAccuracy& scene, const pipeline::MachineConfig& machine) {
  std::string out = fmt::format(
      "ACCURACY  {}, {}x{}, machine {}; each setting {} times in turn; run time is the simulation's "
      "processor time, its median; windows "
      "are "
      "approximate\n",
      scene.name, scene.width, scene.height, machine.title(), scene.settings.front().cpu_s.size());
  out += settings_table(scene) +
         "\nPICTURE  against the ideal reference (double precision, nothing snapped or quantised before the "
         "last store)\n";
  for (std::size_t i = 0; i < scene.images.size(); ++i) out += image_row(i, scene.images[i]);
  if (!scene.precision.empty())
    out +=
        "\nPRECISION  pictures against the ideal reference, one precision varied, the others as in the "
        "machine" +
        precision_table(scene);
  return out;
}

}  // namespace quadrille::studies
