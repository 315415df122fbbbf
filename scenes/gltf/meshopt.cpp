#include "scenes/gltf/meshopt.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <meshoptimizer.h>

#include "models/base/error.h"
#include "scenes/gltf/meshopt_attributes.h"
#include "scenes/gltf/value.h"

namespace quadrille::scenes {
namespace {

// the latter adds to the former
constexpr const char *kVendorName = "EXT_meshopt_compression", *kName = "KHR_meshopt_compression";
// of all views together
constexpr std::uint64_t kMaxDecodedBytes = std::uint64_t{1} << 30;
// of a view, whatever it is packed in
constexpr std::uint64_t kFreeBytes = std::uint64_t{1} << 26;
constexpr std::uint64_t kMaxStride = 256;

enum class Mode : std::uint8_t { kAttributes, kTriangles, kIndices };
enum class Filter : std::uint8_t { kNone, kOctahedral, kQuaternion, kExponential, kColor };

/// The extension's object on one buffer view, checked member by member.
struct Packed {
  std::span<const std::byte> source;
  std::uint64_t stride = 0, count = 0;
  Mode mode = Mode::kAttributes;
  Filter filter = Filter::kNone;
};

Mode read_mode(const GltfObject& object) {
  const std::string mode = object.text("mode", "");
  if (mode == "ATTRIBUTES") return Mode::kAttributes;
  if (mode == "TRIANGLES") return Mode::kTriangles;
  if (mode == "INDICES") return Mode::kIndices;
  object.fail("mode", "it is not ATTRIBUTES, TRIANGLES or INDICES");
}

Filter read_filter(const GltfObject& object, bool khronos) {
  const std::string filter = object.text("filter", "NONE");
  if (filter == "NONE") return Filter::kNone;
  if (filter == "OCTAHEDRAL") return Filter::kOctahedral;
  if (filter == "QUATERNION") return Filter::kQuaternion;
  if (filter == "EXPONENTIAL") return Filter::kExponential;
  if (khronos && filter == "COLOR") return Filter::kColor;
  object.fail("filter", khronos ? "it is not NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR"
                                : "it is not NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
}

/// The strides that the extension allows for the mode and the filter.
bool legal_stride(const Packed& p) {
  if (p.mode != Mode::kAttributes) return p.stride == 2 || p.stride == 4;
  switch (p.filter) {
    case Filter::kNone:
    case Filter::kExponential: return p.stride > 0 && p.stride <= kMaxStride && p.stride % 4 == 0;
    case Filter::kOctahedral:
    case Filter::kColor: return p.stride == 4 || p.stride == 8;
    case Filter::kQuaternion: return p.stride == 8;
  }
  return false;
}

/// The fewest bytes that can hold `count` elements: the vertex codec spends two bits on sixteen values of a
/// byte, the index codecs a byte on a triangle or an index. Version 1 of the vertex codec may spend less on
/// what does not change, which is allowed up to a size.
std::uint64_t least_bytes(const Packed& p) {
  const std::uint64_t free = is_attribute_stream_1(p.source) ? kFreeBytes : 0;
  switch (p.mode) {
    case Mode::kAttributes: return (p.count * p.stride - std::min(free, p.count * p.stride)) / 64;
    case Mode::kTriangles: return p.count / 3;
    case Mode::kIndices: return p.count;
  }
  return 0;
}

std::span<const std::byte> source_bytes(const GltfFile& file, const GltfObject& object) {
  const auto buffer = static_cast<std::size_t>(object.index("buffer", file.model.buffers.size()));
  const std::uint64_t offset = object.integer("byteOffset", 0),
                      length = object.required_integer("byteLength");
  const std::vector<unsigned char>& data = file.model.buffers[buffer].data;
  if (offset > data.size() || length > data.size() - offset)
    object.fail("byteLength", fmt::format("bytes {}+{} reach beyond buffer {} of {} bytes", offset, length,
                                          buffer, data.size()));
  return std::as_bytes(std::span(data)).subspan(offset, length);
}

Packed read_packed(const GltfFile& file, const tinygltf::BufferView& view, const GltfObject& object,
                   bool khronos) {
  Packed p;
  p.source = source_bytes(file, object);
  p.stride = object.required_integer("byteStride");
  p.count = object.required_integer("count");
  p.mode = read_mode(object);
  p.filter = read_filter(object, khronos);
  if (p.mode != Mode::kAttributes && p.filter != Filter::kNone)
    object.fail("filter", "only mode ATTRIBUTES has one");
  if (!legal_stride(p))
    object.fail("byteStride", fmt::format("{} is not a stride of this mode and filter", p.stride));
  if (p.mode == Mode::kTriangles && p.count % 3 != 0)
    object.fail("count", fmt::format("{} indices are not triangles", p.count));
  if (p.count == 0 || p.count > kMaxDecodedBytes / p.stride || least_bytes(p) > p.source.size())
    object.fail("count", fmt::format("{} elements of {} bytes cannot lie in {} bytes", p.count, p.stride,
                                     p.source.size()));
  if (p.count * p.stride != view.byteLength)
    object.fail("count", fmt::format("{} elements of {} bytes are not the view's {} bytes", p.count, p.stride,
                                     view.byteLength));
  return p;
}

/// The library knows the streams of EXT_meshopt_compression; attributes of KHR_meshopt_compression may be of
/// the codec's version 1.
bool unpack(const Packed& p, bool khronos, std::vector<std::byte>& out) {
  const auto* source = reinterpret_cast<const unsigned char*>(p.source.data());
  switch (p.mode) {
    case Mode::kAttributes:
      if (khronos && is_attribute_stream_1(p.source))
        return decode_attribute_stream_1(p.source, p.count, p.stride, out);
      return meshopt_decodeVertexBuffer(out.data(), p.count, p.stride, source, p.source.size()) == 0;
    case Mode::kTriangles:
      return meshopt_decodeIndexBuffer(out.data(), p.count, p.stride, source, p.source.size()) == 0;
    case Mode::kIndices:
      return meshopt_decodeIndexSequence(out.data(), p.count, p.stride, source, p.source.size()) == 0;
  }
  return false;
}

/// Luma, two differences of colour and alpha, in K bits as alpha's highest bit says, to red, green, blue and
/// alpha. [KHR_meshopt_compression: filter 4]
template <class T>
void decode_colors(std::vector<std::byte>& out) {
  using Signed = std::make_signed_t<T>;
  for (std::size_t at = 0; at < out.size(); at += 4 * sizeof(T)) {
    std::array<T, 4> v;
    std::memcpy(v.data(), &out[at], sizeof(v));
    const int largest = (1 << std::bit_width(v[3])) - 1;
    const int y = v[0], co = static_cast<Signed>(v[1]), cg = static_cast<Signed>(v[2]),
              low = v[3] & largest >> 1;
    const std::array<int, 4> color{y + co - cg, y + cg, y - co - cg, low << 1 | (low & 1)};
    for (std::size_t c = 0; c < 4; ++c) {
      const double value =
          std::round(color[c] * (static_cast<double>(std::numeric_limits<T>::max()) / std::max(1, largest)));
      v[c] = static_cast<T>(std::clamp(value, 0.0, static_cast<double>(std::numeric_limits<T>::max())));
    }
    std::memcpy(&out[at], v.data(), sizeof(v));
  }
}

void apply_filter(const Packed& p, std::vector<std::byte>& out) {
  switch (p.filter) {
    case Filter::kNone: return;
    case Filter::kOctahedral: return meshopt_decodeFilterOct(out.data(), p.count, p.stride);
    case Filter::kQuaternion: return meshopt_decodeFilterQuat(out.data(), p.count, p.stride);
    case Filter::kExponential: return meshopt_decodeFilterExp(out.data(), p.count, p.stride);
    case Filter::kColor:
      return p.stride == 4 ? decode_colors<std::uint8_t>(out) : decode_colors<std::uint16_t>(out);
  }
}

}  // namespace

void decode_meshopt_views(GltfFile& file) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < file.model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = file.model.bufferViews[i];
    const bool khronos = view.extensions.contains(kName), vendor = view.extensions.contains(kVendorName);
    if (!khronos && !vendor) continue;
    if (khronos && vendor)
      throw user_error("{}: bufferViews[{}]: {} and {} exclude each other", file.path, i, kName, kVendorName);
    const char* const name = khronos ? kName : kVendorName;
    const GltfObject object(file.path, fmt::format("bufferViews[{}].{}", i, name), view.extensions.at(name));
    const Packed packed = read_packed(file, view, object, khronos);
    total += packed.count * packed.stride;
    if (total > kMaxDecodedBytes)
      object.fail("count",
                  fmt::format("the compressed views expand to more than {} bytes", kMaxDecodedBytes));
    std::vector<std::byte> out(packed.count * packed.stride);
    if (!unpack(packed, khronos, out)) object.fail("buffer", "its data cannot be decoded");
    apply_filter(packed, out);
    file.decoded_views[static_cast<int>(i)] = std::move(out);
  }
}

}  // namespace quadrille::scenes
