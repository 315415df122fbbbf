/// Elements into vertex streams: which types glTF allows where, and which vertex format holds them without
/// loss.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"

namespace quadrille::scenes {
namespace {

using traces::Format;

const char* semantic_name(Semantic semantic) {
  switch (semantic) {
    case Semantic::kPosition: return "POSITION";
    case Semantic::kNormal: return "NORMAL";
    case Semantic::kTangent: return "TANGENT";
    case Semantic::kUv0: return "TEXCOORD_0";
    case Semantic::kUv1: return "TEXCOORD_1";
    case Semantic::kColor: return "COLOR_0";
  }
  return "";
}

template <class T>
T load(const std::byte* source) {
  T value;
  std::memcpy(&value, source, sizeof(T));
  return value;
}

float integer_value(const std::byte* source, Component component, bool normalized) {
  const auto unit = [&](double value, double largest) {
    return static_cast<float>(normalized ? std::max(value / largest, -1.0) : value);
  };
  switch (component) {
    case Component::kInt8: return unit(load<std::int8_t>(source), 127);
    case Component::kUint8: return unit(load<std::uint8_t>(source), 255);
    case Component::kInt16: return unit(load<std::int16_t>(source), 32767);
    case Component::kUint16: return unit(load<std::uint16_t>(source), 65535);
    case Component::kUint32: return unit(load<std::uint32_t>(source), 4294967295.0);
    case Component::kFloat: return load<float>(source);
  }
  return 0;
}

/// Components that glTF, or KHR_mesh_quantization, allows for the semantic. [glTF2.0 #meshes-overview]
/// [KHR_mesh_quantization]
bool allowed_type(const Elements& e, Semantic semantic) {
  const bool is_float = e.component == Component::kFloat;
  const bool small = e.component != Component::kUint32;
  const bool is_signed = e.component == Component::kInt8 || e.component == Component::kInt16;
  switch (semantic) {
    case Semantic::kPosition: return e.components == 3 && small;
    case Semantic::kNormal: return e.components == 3 && (is_float || (is_signed && e.normalized));
    case Semantic::kTangent: return e.components == 4 && (is_float || (is_signed && e.normalized));
    case Semantic::kUv0:
    case Semantic::kUv1: return e.components == 2 && small;
    case Semantic::kColor:
      return (e.components == 3 || e.components == 4) && (is_float || (small && !is_signed && e.normalized));
  }
  return false;
}

/// The vertex format that holds these elements as they are; kUndefined: they are converted to float.
Format native_format(const Elements& e, Semantic semantic) {
  if (!e.normalized || semantic == Semantic::kPosition) return Format::kUndefined;
  const bool pair = e.components == 2;
  switch (e.component) {
    case Component::kUint8: return pair ? Format::kR8G8Unorm : Format::kR8G8B8A8UnormVertex;
    case Component::kUint16: return pair ? Format::kR16G16Unorm : Format::kR16G16B16A16Unorm;
    case Component::kInt8: return pair ? Format::kUndefined : Format::kR8G8B8A8Snorm;
    case Component::kInt16: return pair ? Format::kUndefined : Format::kR16G16B16A16Snorm;
    case Component::kUint32:
    case Component::kFloat: break;
  }
  return Format::kUndefined;
}

Format float_format(std::size_t components) {
  constexpr std::array<Format, 4> kFormats{Format::kR32Float, Format::kR32G32Float, Format::kR32G32B32Float,
                                           Format::kR32G32B32A32Float};
  return kFormats[components - 1];
}

/// Three components to the four of an 8- or 16-bit format; the fourth is one, as a missing alpha is.
std::vector<std::byte> padded(const Elements& e) {
  const std::size_t part = component_bytes(e.component), in = part * e.components, out = part * 4;
  const bool is_signed = e.component == Component::kInt8 || e.component == Component::kInt16;
  const std::uint16_t one = is_signed ? (part == 1 ? 0x7f : 0x7fff) : 0xffff;
  std::vector<std::byte> data(e.count * out);
  for (std::size_t i = 0; i < e.count; ++i) {
    std::memcpy(&data[i * out], &e.data[i * in], in);
    std::memcpy(&data[i * out + in], &one, part);
  }
  return data;
}

std::vector<std::byte> as_floats(const Elements& e) {
  if (e.component == Component::kFloat) return e.data;
  std::vector<std::byte> data(std::size_t{4} * e.count * e.components);
  for (std::size_t i = 0; i < e.count * e.components; ++i) {
    const float value = component_value(e, i / e.components, i % e.components);
    std::memcpy(&data[4 * i], &value, 4);
  }
  return data;
}

void require_finite(const GltfFile& file, const Elements& e, const std::string& place) {
  if (e.component != Component::kFloat) return;
  for (std::size_t i = 0; i < e.count * e.components; ++i) {
    if (!std::isfinite(load<float>(&e.data[4 * i])))
      throw user_error("{}: {}: element {} is not finite", file.path, place, i / e.components);
  }
}

constexpr double kShortest = 1e-12, kLongest = 1e12;  // lengths whose squares the shader holds with ease

/// Zeros in the place of what is no direction; lengths far from one become one. Returns how many are no
/// direction.
std::uint32_t mend_directions(Elements& e) {
  const bool is_float = e.component == Component::kFloat;
  std::uint32_t lacking = 0;
  for (std::size_t i = 0; i < e.count; ++i) {
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) squares += std::pow(static_cast<double>(component_value(e, i, c)), 2);
    const double length = std::sqrt(squares);
    const float side = e.components == 4 ? component_value(e, i, 3) : 1.0F;
    if (!(length > 0) || !std::isfinite(length) || side == 0 || !std::isfinite(side)) {
      const std::size_t size = component_bytes(e.component) * e.components;
      std::memset(&e.data[i * size], 0, size);
      ++lacking;
    } else if (is_float && (length < kShortest || length > kLongest)) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto value = static_cast<float>(static_cast<double>(component_value(e, i, c)) / length);
        std::memcpy(&e.data[4 * (i * e.components + c)], &value, 4);
      }
    }
  }
  return lacking;
}

}  // namespace

float component_value(const Elements& elements, std::size_t element, std::size_t component) {
  const std::size_t at = (element * elements.components + component) * component_bytes(elements.component);
  return integer_value(&elements.data[at], elements.component, elements.normalized);
}

Array to_vertex_array(const GltfFile& file, Elements elements, Semantic semantic, const std::string& place,
                      std::uint32_t* without_direction) {
  if (!allowed_type(elements, semantic)) {
    throw user_error("{}: {}: {} components of this type are not allowed for {}", file.path, place,
                     elements.components, semantic_name(semantic));
  }
  if (semantic == Semantic::kNormal || semantic == Semantic::kTangent) {
    const std::uint32_t lacking = mend_directions(elements);
    if (without_direction != nullptr) *without_direction = lacking;
  }
  require_finite(file, elements, place);
  const Format native = native_format(elements, semantic);
  if (native == Format::kUndefined)
    return {semantic_name(semantic), float_format(elements.components), elements.count, as_floats(elements)};
  return {semantic_name(semantic), native, elements.count,
          elements.components == 3 ? padded(elements) : elements.data};
}

std::uint64_t float_bytes(const Elements& elements) {
  return std::uint64_t{4} * elements.count * elements.components;
}

std::uint64_t vertex_array_bytes(const Elements& elements, Semantic semantic) {
  if (native_format(elements, semantic) == Format::kUndefined) return float_bytes(elements);
  const std::size_t components = elements.components == 3 ? 4 : elements.components;
  return std::uint64_t{component_bytes(elements.component)} * elements.count * components;
}

Array to_delta_array(const GltfFile& file, const Elements& elements, std::size_t components,
                     const std::string& place) {
  const bool small = elements.component != Component::kUint32;
  if (elements.components != components || !small)
    throw user_error("{}: {}: {} components of this type are not what a morph target adds here ({} are)",
                     file.path, place, elements.components, components);
  require_finite(file, elements, place);
  return {"morph target", float_format(components), elements.count, as_floats(elements)};
}

}  // namespace quadrille::scenes
