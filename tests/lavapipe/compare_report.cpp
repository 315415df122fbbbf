/// What a comparison found, for people and for programs.
#include "tests/lavapipe/compare_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace quadrille::lavapipe {
namespace {

std::string criterion(bool ok, std::string_view what, const std::string& figure, const std::string& limit) {
  return fmt::format("  {:4}  {:<40} {:>24}   {}\n", ok ? "ok" : "FAIL", what, figure, limit);
}

std::string share(std::uint64_t count, double fraction) {
  return fmt::format("{} px ({:.5f} %)", count, 100 * fraction);
}

/// The histogram up to its last entry that is not zero.
nlohmann::json trimmed(const std::array<std::uint64_t, 256>& histogram) {
  std::size_t size = histogram.size();
  while (size > 1 && histogram[size - 1] == 0) --size;
  return std::vector<std::uint64_t>(histogram.begin(), histogram.begin() + static_cast<std::ptrdiff_t>(size));
}

}  // namespace

std::string to_text(const Report& report) {
  const Comparison& r = report.result;
  const Limits& limits = report.limits;
  std::string text =
      fmt::format("{} {}x{} against {}\n", report.scene, report.width, report.height, report.device.driver);
  text += fmt::format("        precision: {} sub-pixel, {} sub-texel, {} level-of-detail bits{}\n",
                      report.precision.subpixel_bits, report.precision.subtexel_bits,
                      report.precision.lod_bits, report.precision.linear_log2 ? ", linear log2" : "");
  text += criterion(r.coverage_ok, "covered in one only",
                    share(r.shape.only_a + r.shape.only_b, r.shape.coverage_fraction()),
                    fmt::format("at most {:.5f} %", 100 * limits.coverage_fraction));
  text += criterion(r.triangles_ok, "another triangle seen",
                    share(r.shape.other_triangle, r.shape.triangle_fraction()),
                    fmt::format("at most {:.5f} %", 100 * limits.triangle_fraction));
  text += criterion(r.color_ok, fmt::format("colour within {}/255", limits.within_lsb),
                    fmt::format("{:.5f} %", 100 * r.color.fraction_within(limits.within_lsb)),
                    fmt::format("at least {:.3f} %", 100 * limits.within_fraction));
  text += criterion(r.blocks_ok, "8x8 blocks with a quarter off by > 8",
                    fmt::format("{} of {}", r.color.bad_blocks, r.color.blocks),
                    fmt::format("at most {}", limits.bad_blocks));
  text += fmt::format(
      "        excused: {} depth ties (2 ULP), {} alphas at the cut-off; largest difference {} LSB; PSNR "
      "{:.1f} dB\n",
      r.depth_ties, r.alpha_ties, r.color.max_lsb, r.color.psnr_db);
  if (report.lavapipe_times.frames > 0)
    text += fmt::format(
        "        host time: lavapipe {:.1f} ms wall, {:.1f} ms processor (medians of {}), Quadrille {:.1f} "
        "ms\n",
        report.lavapipe_times.median_ms, report.lavapipe_times.median_cpu_ms, report.lavapipe_times.frames,
        report.machine_ms);
  return text;
}

std::string to_json(const Report& report) {
  const Comparison& r = report.result;
  nlohmann::ordered_json json;
  json["schema"] = "quadrille.lavapipe_compare/1";
  json["scene"] = report.scene;
  json["width"] = report.width;
  json["height"] = report.height;
  json["device"] = {{"name", report.device.name}, {"driver", report.device.driver}};
  json["precision"] = {{"subpixel_bits", report.precision.subpixel_bits},
                       {"subtexel_bits", report.precision.subtexel_bits},
                       {"lod_bits", report.precision.lod_bits},
                       {"linear_log2", report.precision.linear_log2}};
  json["reported_precision"] = {{"subpixel_bits", report.device.subpixel_bits},
                                {"subtexel_bits", report.device.subtexel_bits},
                                {"lod_bits", report.device.mipmap_bits}};
  json["passed"] = r.passed();
  json["criteria"]["coverage"] = {
      {"pixels", r.shape.only_a + r.shape.only_b}, {"only_quadrille", r.shape.only_a},
      {"only_lavapipe", r.shape.only_b},           {"fraction", r.shape.coverage_fraction()},
      {"limit", report.limits.coverage_fraction},  {"passed", r.coverage_ok}};
  json["criteria"]["triangle"] = {{"pixels", r.shape.other_triangle},
                                  {"fraction", r.shape.triangle_fraction()},
                                  {"limit", report.limits.triangle_fraction},
                                  {"passed", r.triangles_ok}};
  json["criteria"]["color"] = {{"within_lsb", report.limits.within_lsb},
                               {"fraction", r.color.fraction_within(report.limits.within_lsb)},
                               {"limit", report.limits.within_fraction},
                               {"passed", r.color_ok}};
  json["criteria"]["blocks"] = {{"bad", r.color.bad_blocks},
                                {"of", r.color.blocks},
                                {"limit", report.limits.bad_blocks},
                                {"passed", r.blocks_ok},
                                {"worst_block", r.color.worst_block}};
  json["excused"] = {{"depth_ties", r.depth_ties}, {"alpha_ties", r.alpha_ties}};
  json["max_lsb"] = r.color.max_lsb;
  json["psnr_db"] = r.color.psnr_db;
  json["histogram_of_largest_channel"] = trimmed(r.color.max_histogram);
  json["host"] = {{"lavapipe_median_ms", report.lavapipe_times.median_ms},
                  {"lavapipe_median_cpu_ms", report.lavapipe_times.median_cpu_ms},
                  {"lavapipe_frames", report.lavapipe_times.frames},
                  {"quadrille_ms", report.machine_ms}};
  return json.dump(2) + "\n";
}

}  // namespace quadrille::lavapipe
