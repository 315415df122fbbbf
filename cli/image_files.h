/// Files that the program writes, and pictures that it reads: which are legal, and how stored colours become
/// those of a file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/render.h"

namespace quadrille::cli {

/// Refuses a path that could not be written at the end of a long run: a wrong extension, no such folder, no
/// permission, not a plain file. Creates nothing. Throws `UserError` that starts with `flag`.
void check_output(std::string_view flag, const std::string& path, const std::vector<std::string>& extensions);
/// Whether a document's name is "-".
[[nodiscard]] bool is_standard_output(const std::string& path);
/// The same for a JSON document, which may go to standard output.
void check_json_output(std::string_view flag, const std::string& path);
/// Refuses two outputs with one name. Paths that were not given are empty.
void check_distinct(const std::vector<std::pair<std::string_view, std::optional<std::string>>>& outputs);

/// Writes a text, whole or not at all; "-" is standard output. Throws `UserError`, or `std::system_error`
/// when standard output cannot be written.
void write_text(const std::string& path, const std::string& text);
/// Writes the colours: a .png holds the stored codes, an .exr linear values. Alpha is written as 1 unless
/// `keep_alpha`. `srgb` says how the target encodes.
void write_color(const std::string& path, const pipeline::FrameImage& image, bool srgb, bool keep_alpha);
/// Writes the depths: an .exr holds them as they are, a .png shows them as grey, the nearest white, the
/// farthest black.
void write_depth(const std::string& path, const pipeline::FrameImage& image);
/// The same two pictures as files of PNG in memory; `depth_png` is empty where there are no depths.
[[nodiscard]] std::vector<std::byte> color_png(const pipeline::FrameImage& image);
[[nodiscard]] std::vector<std::byte> depth_png(const pipeline::FrameImage& image);

/// A picture as 8-bit RGBA, red in the low byte. Linear values of an .exr are encoded as sRGB, so that it
/// compares with a .png of the same frame.
struct CodedImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> rgba;
};
[[nodiscard]] CodedImage read_coded(const std::string& path);
[[nodiscard]] bool is_exr(const std::string& path);

}  // namespace quadrille::cli
