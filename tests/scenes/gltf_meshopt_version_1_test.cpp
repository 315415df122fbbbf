/// Version 1 of the codec of attributes, and KHR_meshopt_compression, which brings it.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "scenes/gltf/file.h"
#include "scenes/gltf/meshopt.h"
#include "scenes/gltf/meshopt_attributes.h"
#include "tests/scenes/compressed_gltf.h"
#include "tests/scenes/gltf_text.h"
#include "tests/scenes/meshopt_views.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

/// The extension of the same views under Khronos' name.
std::string khronos(std::string text) {
  for (std::size_t at = 0; (at = text.find("EXT_meshopt", at)) != std::string::npos;)
    text.replace(at, 3, "KHR");
  return text;
}

template <class T>
T folded(T delta) {
  return static_cast<T>((delta >> (8 * sizeof(T) - 1) & 1) != 0 ? ~(delta << 1) : delta << 1);
}

/// An encoder of version 1 that is plain: it takes any control that can hold a byte position's deltas, in
/// turn, so that all are met.
class Encoder {
 public:
  Encoder(const std::vector<std::byte>& data, std::size_t stride, std::vector<unsigned> modes)
      : data_(data), stride_(stride), modes_(std::move(modes)) {}

  std::vector<std::byte> run() {
    put(0xa1);
    const std::size_t count = data_.size() / stride_,
                      most = std::min<std::size_t>(8192 / stride_ & ~std::size_t{15}, 256);
    for (std::size_t first = 0; first < count; first += most) block(first, std::min(most, count - first));
    for (std::size_t i = stride_ + stride_ / 4; i < 24; ++i) put(0);
    for (std::size_t k = 0; k < stride_; ++k) put(byte(0, k));  // the baseline is the first element
    for (const unsigned mode : modes_) put(mode);
    return out_;
  }
  std::array<int, 4> controls{};  ///< how often each was taken

 private:
  void put(unsigned b) { out_.push_back(static_cast<std::byte>(b)); }
  [[nodiscard]] unsigned byte(std::size_t element, std::size_t k) const {
    return std::to_integer<unsigned>(data_[element * stride_ + k]);
  }
  [[nodiscard]] std::uint32_t word(std::size_t element, std::size_t channel) const {
    std::uint32_t value = 0;
    std::memcpy(&value, &data_[element * stride_ + 4 * channel], 4);
    return value;
  }

  [[nodiscard]] std::uint32_t delta(std::size_t element, std::size_t channel) const {
    const std::uint32_t now = word(element, channel), before = word(element == 0 ? 0 : element - 1, channel);
    const unsigned mode = modes_[channel];
    if ((mode & 15) == 2) return std::rotr(now ^ before, static_cast<int>(mode >> 4));
    std::uint32_t result = 0;
    for (unsigned shift = 0; shift < 32; shift += mode == 0 ? 8 : 16) {
      if (mode == 0)
        result |= std::uint32_t{folded(static_cast<std::uint8_t>((now >> shift) - (before >> shift)))}
                  << shift;
      else
        result |= std::uint32_t{folded(static_cast<std::uint16_t>((now >> shift) - (before >> shift)))}
                  << shift;
    }
    return result;
  }

  void block(std::size_t first, std::size_t count) {
    const std::size_t header = out_.size();
    for (std::size_t i = 0; i < stride_ / 4; ++i) put(0);
    for (std::size_t k = 0; k < stride_; ++k) {
      std::vector<unsigned> deltas;
      for (std::size_t i = 0; i < count; ++i) deltas.push_back(delta(first + i, k / 4) >> 8 * (k % 4) & 255);
      const bool zeros = std::ranges::all_of(deltas, [](unsigned d) { return d == 0; });
      const unsigned control = zeros ? 2 : turn_++ % 3 == 2 ? 3 : turn_ % 2;
      ++controls[control];
      out_[header + k / 4] |= static_cast<std::byte>(control << 2 * (k % 4));
      if (control == 3) {
        for (const unsigned d : deltas) put(d);
      } else if (control < 2) {
        position(control, deltas);
      }
    }
  }

  void position(unsigned control, std::vector<unsigned> deltas) {
    deltas.resize((deltas.size() + 15) / 16 * 16);
    const std::size_t header = out_.size();
    for (std::size_t i = 0; i < (deltas.size() / 16 + 3) / 4; ++i) put(0);
    for (std::size_t g = 0; g < deltas.size() / 16; ++g) {
      const std::span<const unsigned> group = std::span(deltas).subspan(16 * g, 16);
      unsigned choice = group_turn_++ % 4;
      if (control == 0 && choice == 0 && std::ranges::any_of(group, [](unsigned d) { return d != 0; }))
        choice = 3;
      out_[header + g / 4] |= static_cast<std::byte>(choice << 2 * (g % 4));
      constexpr std::array<std::array<unsigned, 4>, 2> kBits{{{0, 1, 2, 4}, {1, 2, 4, 8}}};
      sixteen(kBits[control][choice], group);
    }
  }

  void sixteen(unsigned bits, std::span<const unsigned> group) {
    if (bits == 0) return;
    const unsigned ones = bits == 8 ? 256 : (1u << bits) - 1, in_byte = 8 / bits;
    for (unsigned i = 0; i < 16; i += in_byte) {
      unsigned packed = 0;
      for (unsigned n = 0; n < in_byte; ++n)
        packed |= std::min(group[i + n], ones) << (bits == 1 ? n : bits * (in_byte - 1 - n));
      put(packed);
    }
    for (const unsigned d : group) {
      if (d >= ones) put(d);
    }
  }

  const std::vector<std::byte>& data_;
  std::size_t stride_;
  std::vector<unsigned> modes_;
  std::vector<std::byte> out_;
  unsigned turn_ = 0, group_turn_ = 0;
};

/// Elements whose bytes stand, creep and jump.
std::vector<std::byte> elements(std::size_t count, std::size_t stride) {
  std::mt19937 dice(7);
  std::vector<std::byte> data(count * stride);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < stride; ++k) {
      const unsigned before = i == 0 ? 100 : std::to_integer<unsigned>(data[(i - 1) * stride + k]);
      constexpr std::array<unsigned, 5> kSteps{1, 2, 5, 23, 256};
      const unsigned step = static_cast<unsigned>(dice()) % kSteps[k % kSteps.size()];
      data[i * stride + k] = static_cast<std::byte>(before + step);
    }
  }
  return data;
}

}  // namespace

TEST_CASE("meshopt: the streams of EXT_meshopt_compression are those of KHR_meshopt_compression too") {
  const Grid grid = wavy_grid(9);
  const SceneData a = load_text(grid_gltf(grid, packed_views(grid))),
                  b = load_text(khronos(grid_gltf(grid, packed_views(grid))));
  REQUIRE(a.arrays.size() == b.arrays.size());
  for (std::size_t i = 0; i < a.arrays.size(); ++i) CHECK(a.arrays[i].data == b.arrays[i].data);
}

TEST_CASE(
    "meshopt: attributes of version 1 come back bit for bit, with every control, width and mode of a "
    "channel") {
  for (const std::size_t stride : {4u, 8u, 12u, 20u, 64u, 256u}) {
    for (const std::size_t count : {1u, 15u, 16u, 17u, 200u, 256u, 1000u}) {
      CAPTURE(stride, count);
      std::vector<unsigned> modes;
      for (std::size_t c = 0; c < stride / 4; ++c)
        modes.push_back(c % 4 == 3 ? 0x52 : static_cast<unsigned>(c % 3));
      const std::vector<std::byte> data = elements(count, stride);
      Encoder encoder(data, stride, modes);
      const std::vector<std::byte> packed = encoder.run();
      std::vector<std::byte> out(data.size());
      REQUIRE(is_attribute_stream_1(packed));
      REQUIRE(decode_attribute_stream_1(packed, count, stride, out));
      REQUIRE(out == data);
      if (count == 1000 && stride == 64) {
        for (const int taken : encoder.controls) CHECK(taken > 0);
      }
    }
  }
}

TEST_CASE("meshopt: the specification's example of sixteen deltas") {
  // One byte position of 4-bit deltas, the others still; the baseline is zero.
  std::vector<std::byte> stream;
  for (const unsigned b :
       {0xa1u, 0xa8u, 0x03u, 0x17u, 0x5fu, 0xf0u, 0xbcu, 0x77u, 0xa9u, 0x21u, 0x00u, 0x34u, 0xb5u})
    stream.push_back(static_cast<std::byte>(b));
  stream.resize(stream.size() + 24);
  std::vector<std::byte> out(64);
  REQUIRE(decode_attribute_stream_1(stream, 16, 4, out));
  int sum = 0;
  const std::array<int, 16> deltas{-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
  for (std::size_t i = 0; i < 16; ++i) {
    sum += deltas[i];
    CHECK(out[4 * i] == static_cast<std::byte>(sum));
    CHECK(out[4 * i + 1] == std::byte{0});
  }
}

TEST_CASE(
    "meshopt: damaged attributes of version 1 are refused, and nothing is read or written beyond them") {
  const std::vector<std::byte> data = elements(100, 16);
  const std::vector<std::byte> packed = Encoder(data, 16, {0, 1, 2, 0}).run();
  std::vector<std::byte> out(data.size());
  for (std::size_t size = 0; size < packed.size(); ++size) {
    const std::vector<std::byte> cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
    CHECK_FALSE(decode_attribute_stream_1(cut, 100, 16, out));
  }
  std::vector<std::byte> longer = packed;
  longer.insert(longer.begin() + 40, std::byte{0});
  CHECK_FALSE(decode_attribute_stream_1(longer, 100, 16, out));
  for (const unsigned mode : {3u, 15u, 0x10u, 0x11u}) {
    std::vector<std::byte> other = packed;
    other.back() = static_cast<std::byte>(mode);
    CHECK_FALSE(decode_attribute_stream_1(other, 100, 16, out));
  }
  std::mt19937 dice(3);
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> other = packed;
    other[dice() % other.size()] = static_cast<std::byte>(dice() & 255);
    (void)decode_attribute_stream_1(other, 100, 16, out);
  }
}

TEST_CASE(
    "meshopt: KHR_meshopt_compression brings version 1 and the filter of colours, EXT_meshopt_compression "
    "does not") {
  const Grid grid = wavy_grid(9);
  std::vector<View> views = packed_views(grid);
  std::vector<std::byte> positions(4 * grid.positions.size());
  std::memcpy(positions.data(), grid.positions.data(), positions.size());
  views[0].bytes = Encoder(positions, 12, {0, 1, 2}).run();
  const SceneData scene = load_text(khronos(grid_gltf(grid, views)));
  CHECK(stream(scene, Semantic::kPosition).data == positions);
  CHECK_THAT(load_result(grid_gltf(grid, views)),
             Contains("bufferViews[0].EXT_meshopt_compression.buffer: its data cannot be decoded"));

  // Colours of eight bits, K = 8: red, white and a half of grey with an alpha of 100 of 127.
  const std::vector<std::uint8_t> colors{64, 127, 192, 255, 255, 0, 0, 255, 128, 0, 0, 128 + 100};
  View view = attributes_view(colors.data(), 3, 4, "COLOR");
  views = packed_views(grid);
  views.push_back(view);
  GltfFile file;
  {
    const TempGltf text(khronos(grid_gltf(grid, views)));
    file = read_gltf_file(text.path());
  }
  const auto bytes = buffer_view_bytes(file, 4, "test");
  const std::vector<int> wanted{255, 0, 1, 255, 255, 255, 255, 255, 128, 128, 128, 200};
  for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(std::to_integer<int>(bytes[i]) == wanted[i]);
  CHECK_THAT(load_result(grid_gltf(grid, views)),
             Contains("filter: it is not NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL"));
  std::string both = grid_gltf(grid, packed_views(grid));
  both.insert(both.find(R"("EXT_meshopt_compression":{"buffer")"), R"("KHR_meshopt_compression":{},)");
  CHECK_THAT(
      load_result(both),
      Contains("bufferViews[0]: KHR_meshopt_compression and EXT_meshopt_compression exclude each other"));
}
