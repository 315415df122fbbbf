/// `quadrille diff`: how far apart two pictures are.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/image_files.h"
#include "cli/scene_arguments.h"
#include "models/base/error.h"
#include "models/base/say.h"
#include "models/reference/compare.h"
#include "scenes/image/image_io.h"

namespace quadrille::cli {
namespace {

namespace reference = models::reference;

struct DiffArguments {
  std::string a, b;
  std::optional<std::string> max_lsb, heat;
};

double mean_difference(const std::array<std::uint64_t, 256>& histogram, std::uint64_t pixels) {
  double sum = 0;
  for (std::size_t d = 0; d < histogram.size(); ++d)
    sum += static_cast<double>(d) * static_cast<double>(histogram[d]);
  return pixels > 0 ? sum / static_cast<double>(pixels) : 0;
}

/// Pixels by their largest channel difference, in bins that double.
std::string histogram_text(const reference::ImageDifference& d) {
  std::string text = "difference of a pixel's worst channel, in 1/255:\n";
  for (int from = 0, to = 0; from < 256; from = to + 1, to = from < 2 ? from : 2 * from - 1) {
    std::uint64_t pixels = 0;
    for (int i = from; i <= std::min(to, 255); ++i) pixels += d.max_histogram[static_cast<std::size_t>(i)];
    const std::string range =
        from == to ? fmt::format("{}", from) : fmt::format("{}..{}", from, std::min(to, 255));
    text += fmt::format(
        "  {:>8} {:>11} pixels {:>9.4f} %\n", range, pixels,
        100.0 * static_cast<double>(pixels) / static_cast<double>(std::max<std::uint64_t>(1, d.pixels)));
  }
  return text;
}

std::string difference_text(const reference::ImageDifference& d) {
  constexpr std::array<const char*, 4> kChannels{"red", "green", "blue", "alpha"};
  std::string text = d.max_lsb == 0 ? fmt::format("equal: {} pixels\n", d.pixels)
                                    : fmt::format("largest difference {} of 255, PSNR {:.2f} dB, {} pixels\n",
                                                  d.max_lsb, d.psnr_db, d.pixels);
  for (std::size_t c = 0; c < 4; ++c)
    text += fmt::format("  mean {:<6}{:>9.5f}\n", kChannels[c], mean_difference(d.histogram[c], d.pixels));
  text += histogram_text(d) + "pixels within:\n";
  for (const int lsb : {1, 2, 8})
    text += fmt::format("  {}/255 {:>10.5f} %\n", lsb, 100 * d.fraction_within(lsb));
  text += fmt::format("8x8 blocks with more than a quarter of their pixels off by more than {}/255: {} of {}",
                      reference::kBlockLimit, d.bad_blocks, d.blocks);
  if (d.max_lsb > reference::kBlockLimit)
    text += fmt::format("; worst at pixel ({}, {})", d.worst_block[0] * reference::kBlockSide,
                        d.worst_block[1] * reference::kBlockSide);
  return text + "\n";
}

void write_heat(const std::string& path, reference::ImageView a, reference::ImageView b) {
  const std::vector<std::uint32_t> heat = reference::difference_heat_map(a, b);
  scenes::Rgba8Image image{a.width, a.height, std::vector<std::uint8_t>(heat.size() * 4)};
  std::memcpy(image.pixels.data(), heat.data(), image.pixels.size());
  scenes::save_png(path, image);
}

/// Refuses what this program writes or reads but is no picture, by what it is.
void check_picture(const std::string& path) {
  constexpr std::array<std::pair<const char*, const char*>, 5> kOthers{{{".json", "figures"},
                                                                        {".qtrace", "a trace"},
                                                                        {".gltf", "a scene"},
                                                                        {".glb", "a scene"},
                                                                        {".toml", "a machine"}}};
  for (const auto& [extension, what] : kOthers) {
    if (!path.ends_with(extension)) continue;
    throw user_error(
        "{}: {}, by its name; diff compares two pictures (PNG, JPEG, WebP, DDS or EXR), as --out of render "
        "writes them",
        path, what);
  }
}

int run_diff(const DiffArguments& arguments) {
  std::optional<std::int64_t> limit;
  if (arguments.max_lsb) limit = parse_whole(*arguments.max_lsb, "--max-lsb", 0, 255);
  if (arguments.heat) check_output("--heat", *arguments.heat, {".png"});
  check_picture(arguments.a);
  check_picture(arguments.b);
  const CodedImage a = read_coded(arguments.a), b = read_coded(arguments.b);
  if (a.width != b.width || a.height != b.height) {
    throw user_error("{} is {}x{}, {} is {}x{}: only pictures of one size compare", arguments.a, a.width,
                     a.height, arguments.b, b.width, b.height);
  }
  const reference::ImageView view_a{a.width, a.height, a.rgba}, view_b{b.width, b.height, b.rgba};
  const reference::ImageDifference difference = reference::compare_images(view_a, view_b);
  fmt::print("{}", difference_text(difference));
  if (arguments.heat) write_heat(*arguments.heat, view_a, view_b);
  if (!limit || difference.max_lsb <= *limit) return kDone;
  say(fmt::format("quadrille: the pictures differ by {} of 255; --max-lsb allows {}\n", difference.max_lsb,
                  *limit));
  return kFailed;
}

}  // namespace

void add_diff(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "diff", "Says how far apart two pictures are (PNG, JPEG, WebP, DDS or EXR, of one size).");
  const auto arguments = std::make_shared<DiffArguments>();
  command->add_option("A", arguments->a, "a picture")->required();
  command->add_option("B", arguments->b, "another")->required();
  command
      ->add_option("--max-lsb", arguments->max_lsb,
                   "exit code 1 when any channel of any pixel differs by more than N of 255")
      ->type_name("N");
  command
      ->add_option("--heat", arguments->heat,
                   "writes a picture of the difference: grey equal, blue 1, green about 8, red 64 and more")
      ->type_name("F.png");
  command->footer(
      R"(Colours are compared as a .png stores them, one unit is 1/255; the linear values of an .exr are encoded first.
Examples:
  quadrille diff a.png b.png
  quadrille diff a.png b.png --max-lsb 0 --heat where.png)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return run_diff(*arguments); }; });
}

}  // namespace quadrille::cli
