/// A row of frames (schema `quadrille-frames-1`, docs/figures.md) as a page for a browser and as a table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

/// Pictures of frames, as files of PNG, by the frame's number.
using FramePictures = std::vector<std::pair<std::int64_t, std::vector<std::byte>>>;

/// The page: the curve, every frame with what limits it, the slowest. It shows as many of the pictures as fit
/// into `kMostPictureBytes`, the slowest frame's among them.
[[nodiscard]] std::string frames_page(std::string_view frames_json, const FramePictures& pictures);
inline constexpr std::size_t kMostPictureBytes = 6'000'000;

/// A line a frame [RFC 4180]: number, moment, everything under `frame`, bytes by client, and the limit.
[[nodiscard]] std::string frames_csv(std::string_view frames_json);

}  // namespace quadrille::pipeline
