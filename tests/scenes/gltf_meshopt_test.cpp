/// What meshoptimizer's encoders pack is unpacked bit for bit; what nobody packed is refused.
#include "scenes/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "scenes/gltf/loader.h"
#include "scenes/gltf/meshopt_attributes.h"
#include "tests/scenes/compressed_gltf.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;
using Catch::Contains;

namespace {

template <class Encode>
std::vector<std::byte> encoded(std::size_t bound, const Encode& encode) {
  std::vector<unsigned char> buffer(bound);
  buffer.resize(encode(buffer.data(), buffer.size()));
  std::vector<std::byte> bytes(buffer.size());
  std::memcpy(bytes.data(), buffer.data(), bytes.size());
  return bytes;
}

View attributes(const void* data, std::size_t count, std::size_t stride, const std::string& filter = "NONE") {
  const auto bytes =
      encoded(meshopt_encodeVertexBufferBound(count, stride), [&](unsigned char* out, std::size_t size) {
        return meshopt_encodeVertexBuffer(out, size, data, count, stride);
      });
  return {
      bytes, count * stride,
      fmt::format(R"("byteStride":{},"count":{},"mode":"ATTRIBUTES","filter":"{}")", stride, count, filter)};
}

View triangles(const Grid& grid) {
  const auto bytes =
      encoded(meshopt_encodeIndexBufferBound(grid.indices.size(), grid.vertices()),
              [&](unsigned char* out, std::size_t size) {
                return meshopt_encodeIndexBuffer(out, size, grid.indices.data(), grid.indices.size());
              });
  return {bytes, 4 * grid.indices.size(),
          fmt::format(R"("byteStride":4,"count":{},"mode":"TRIANGLES")", grid.indices.size())};
}

View sequence(const Grid& grid) {
  const auto bytes =
      encoded(meshopt_encodeIndexSequenceBound(grid.indices.size(), grid.vertices()),
              [&](unsigned char* out, std::size_t size) {
                return meshopt_encodeIndexSequence(out, size, grid.indices.data(), grid.indices.size());
              });
  return {bytes, 4 * grid.indices.size(),
          fmt::format(R"("byteStride":4,"count":{},"mode":"INDICES")", grid.indices.size())};
}

std::vector<View> packed_views(const Grid& grid) {
  return {attributes(grid.positions.data(), grid.vertices(), 12),
          attributes(grid.normals.data(), grid.vertices(), 12),
          attributes(grid.uvs.data(), grid.vertices(), 8), triangles(grid)};
}

SceneData load(const std::string& text) {
  const TempGltf file(text);
  return load_gltf(file.path());
}

/// Triangles as sorted triples of corners: the triangle codec may turn each.
std::vector<std::array<std::uint32_t, 3>> turned(const Array& indices) {
  std::vector<std::array<std::uint32_t, 3>> result(indices.count / 3);
  std::memcpy(result.data(), indices.data.data(), indices.data.size());
  for (auto& t : result) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return result;
}

const Array& stream(const SceneData& scene, Semantic semantic) {
  return scene
      .arrays[static_cast<std::size_t>(scene.primitives[0].attributes[static_cast<std::size_t>(semantic)])];
}

}  // namespace

TEST_CASE("meshopt: packed attributes and triangles are the plain ones, bit for bit") {
  const Grid grid = wavy_grid(33);
  const SceneData plain = load(grid_gltf(grid, plain_views(grid))),
                  packed = load(grid_gltf(grid, packed_views(grid)));
  for (const Semantic semantic : {Semantic::kPosition, Semantic::kNormal, Semantic::kUv0})
    REQUIRE(stream(packed, semantic).data == stream(plain, semantic).data);
  const auto index = [](const SceneData& s) -> const Array& {
    return s.arrays[static_cast<std::size_t>(s.primitives[0].indices)];
  };
  REQUIRE(turned(index(packed)) == turned(index(plain)));
}

TEST_CASE("meshopt: an index sequence keeps every index in its place") {
  const Grid grid = wavy_grid(9);
  std::vector<View> views = packed_views(grid);
  views[3] = sequence(grid);
  const SceneData scene = load(grid_gltf(grid, views));
  const Array& indices = scene.arrays[static_cast<std::size_t>(scene.primitives[0].indices)];
  REQUIRE(std::memcmp(indices.data.data(), grid.indices.data(), indices.data.size()) == 0);
}

TEST_CASE("meshopt: the octahedral filter gives unit normals within its bits") {
  const Grid grid = wavy_grid(9);
  std::vector<float> four;
  for (std::size_t i = 0; i < grid.vertices(); ++i)
    four.insert(four.end(), {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
  std::vector<std::int16_t> filtered(four.size());
  meshopt_encodeFilterOct(filtered.data(), grid.vertices(), 8, 16, four.data());
  std::vector<View> views = packed_views(grid);
  views[1] = attributes(filtered.data(), grid.vertices(), 8, "OCTAHEDRAL");
  std::string text = grid_gltf(grid, views, R"("componentType":5122,"normalized":true)");
  text.replace(text.find(fmt::format(R"("byteLength":{},"ext)", 8 * grid.vertices())), 0,
               R"("byteStride":8,)");
  const SceneData scene = load(text);
  const Array& normals = stream(scene, Semantic::kNormal);
  for (std::size_t i = 0; i < grid.vertices(); ++i) {
    std::array<std::int16_t, 4> n{};
    std::memcpy(n.data(), &normals.data[8 * i], 8);
    for (std::size_t k = 0; k < 3; ++k)
      REQUIRE(std::abs(static_cast<float>(n[k]) / 32767 - grid.normals[3 * i + k]) < 2e-4F);
  }
}

TEST_CASE(
    "meshopt: the exponential filter keeps floats within its bits, and quaternions come back by their "
    "filter") {
  const Grid grid = wavy_grid(9);
  std::vector<std::uint32_t> filtered(grid.positions.size());
  meshopt_encodeFilterExp(filtered.data(), grid.vertices(), 12, 15, grid.positions.data());
  std::vector<View> views = packed_views(grid);
  views[0] = attributes(filtered.data(), grid.vertices(), 12, "EXPONENTIAL");
  const SceneData scene = load(grid_gltf(grid, views));
  std::vector<float> positions(grid.positions.size());
  std::memcpy(positions.data(), stream(scene, Semantic::kPosition).data.data(), 4 * positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    REQUIRE(std::abs(positions[i] - grid.positions[i]) < 1e-4F);

  std::vector<float> quaternions;
  for (std::size_t i = 0; i < 64; ++i)
    quaternions.insert(quaternions.end(), {0.6F, 0, 0, i % 2 == 0 ? 0.8F : -0.8F});
  std::vector<std::int16_t> packed(quaternions.size());
  meshopt_encodeFilterQuat(packed.data(), 64, 8, 12, quaternions.data());
  views.push_back(attributes(packed.data(), 64, 8, "QUATERNION"));
  GltfFile file;
  {
    const TempGltf text(grid_gltf(grid, views));
    file = read_gltf_file(text.path());
  }
  const auto bytes = buffer_view_bytes(file, 4, "test");
  for (std::size_t i = 0; i < 64; ++i) {
    std::array<std::int16_t, 4> q{};
    std::memcpy(q.data(), &bytes[8 * i], 8);
    float dot = 0;
    for (std::size_t k = 0; k < 4; ++k) dot += static_cast<float>(q[k]) / 32767 * quaternions[4 * i + k];
    REQUIRE(std::abs(dot) > 0.999F);
  }
}

TEST_CASE("meshopt: counts, strides, modes and lengths that do not fit are refused with their place") {
  const Grid grid = wavy_grid(9);
  const auto result = [&](const std::string& extension) {
    std::vector<View> views = packed_views(grid);
    views[0].extension = extension;
    return load_result(grid_gltf(grid, views));
  };
  REQUIRE_THAT(result(R"("byteStride":12,"count":99,"mode":"ATTRIBUTES")"),
               Contains("bufferViews[0].EXT_meshopt_compression.count: 99 elements"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":2000000000,"mode":"ATTRIBUTES")"),
               Contains("cannot lie in"));
  REQUIRE_THAT(result(R"("byteStride":13,"count":100,"mode":"ATTRIBUTES")"),
               Contains("byteStride: 13 is not a stride"));
  REQUIRE_THAT(result(R"("byteStride":0,"count":100,"mode":"ATTRIBUTES")"),
               Contains("byteStride: 0 is not a stride"));
  REQUIRE_THAT(result(R"("byteStride":4,"count":301,"mode":"TRIANGLES")"),
               Contains("301 indices are not triangles"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":100,"mode":"ZIP")"), Contains("mode: it is not ATTRIBUTES"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":100,"mode":"ATTRIBUTES","filter":"OCTAHEDRAL")"),
               Contains("byteStride: 12"));
  REQUIRE_THAT(result(R"("byteStride":12,"count":-1,"mode":"ATTRIBUTES")"),
               Contains("count: a non-negative integer is due"));
  REQUIRE_THAT(result(R"("byteStride":4,"count":300,"mode":"TRIANGLES")"),
               Contains("buffer: its data cannot be decoded"));
}

TEST_CASE("meshopt: random damage to the packed bytes is decoded or refused") {
  const Grid grid = wavy_grid(9);
  std::mt19937 dice(5);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<View> views = packed_views(grid);
    auto& bytes = views[dice() % 4].bytes;
    for (unsigned k = 0; k < 1 + dice() % 4; ++k)
      bytes[dice() % bytes.size()] = static_cast<std::byte>(dice() % 256);
    if (dice() % 3 == 0) bytes.resize(1 + dice() % bytes.size());
    const std::string result = load_result(grid_gltf(grid, views));
    REQUIRE(result.find('\n') == std::string::npos);
    refused += result == "loaded" ? 0 : 1;
  }
  REQUIRE(refused > 50);
}

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
  const SceneData a = load(grid_gltf(grid, packed_views(grid))),
                  b = load(khronos(grid_gltf(grid, packed_views(grid))));
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
  const SceneData scene = load(khronos(grid_gltf(grid, views)));
  CHECK(stream(scene, Semantic::kPosition).data == positions);
  CHECK_THAT(load_result(grid_gltf(grid, views)),
             Contains("bufferViews[0].EXT_meshopt_compression.buffer: its data cannot be decoded"));

  // Colours of eight bits, K = 8: red, white and a half of grey with an alpha of 100 of 127.
  const std::vector<std::uint8_t> colors{64, 127, 192, 255, 255, 0, 0, 255, 128, 0, 0, 128 + 100};
  View view = attributes(colors.data(), 3, 4, "COLOR");
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
