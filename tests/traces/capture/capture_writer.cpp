#include "tests/traces/capture/capture_writer.h"

#include <lz4.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "traces/capture/schema.h"

namespace quadrille::capture {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kNull = 1, kSingle = 2, kArray = 4, kText = 8, kStructure = 0x20, kData = 0x80;

template <class T>
void put(Bytes& to, T value) {
  const auto* from = reinterpret_cast<const std::byte*>(&value);
  to.insert(to.end(), from, from + sizeof(T));
}

void put_structure(Bytes& to, const Structure& structure, const json& given);

void put_number(Bytes& to, FieldKind kind, const json& value) {
  const bool real = value.is_number_float();
  const std::uint64_t bits = real              ? std::bit_cast<std::uint32_t>(value.get<float>())
                             : value.is_null() ? 0
                                               : value.get<std::uint64_t>();
  switch (kind) {
    case FieldKind::kByte: return put(to, static_cast<std::uint8_t>(bits));
    case FieldKind::kShort: return put(to, static_cast<std::uint16_t>(bits));
    case FieldKind::kLong: return put(to, bits);
    case FieldKind::kFloat: return put(to, value.is_number() ? value.get<float>() : 0.0f);
    case FieldKind::kWord:
    case FieldKind::kInt: return put(to, static_cast<std::uint32_t>(bits));
    case FieldKind::kText:
    case FieldKind::kTexts:
    case FieldKind::kChain:
    case FieldKind::kStruct:
    case FieldKind::kTemplate: break;
  }
  throw std::logic_error("not a number");
}

void put_field(Bytes& to, const Field& field, const json& value) {
  if (field.kind == FieldKind::kText && !value.is_null()) {
    const auto text = value.get<std::string>();
    put(to, kText | kData);
    put<std::uint64_t>(to, text.size());
    for (const char c : text) put(to, c);
    return;
  }
  const bool pointer = field.pointer || field.kind == FieldKind::kText || field.kind == FieldKind::kTexts ||
                       field.kind == FieldKind::kChain || field.kind == FieldKind::kTemplate;
  if (!pointer) {
    if (field.kind == FieldKind::kStruct) return put_structure(to, *field.structure, value);
    return put_number(to, field.kind, value);
  }
  if (value.is_null()) return put(to, kNull);
  const std::uint32_t structures = field.kind == FieldKind::kStruct ? kStructure : 0;
  const json list = value.is_array() ? value : json::array({value});
  put(to, (value.is_array() ? kArray : kSingle) | structures | kData);
  if (value.is_array()) put<std::uint64_t>(to, list.size());
  for (const json& one : list) {
    if (field.kind == FieldKind::kStruct) put_structure(to, *field.structure, one);
    else put_number(to, field.kind, one);
  }
}

void put_structure(Bytes& to, const Structure& structure, const json& given) {
  for (const Field& field : structure.fields) {
    const std::string name(field.name);
    const json value = given.is_object() && given.contains(name) ? given[name]
                       : field.name == "sType"                   ? json(structure.type)
                                                                 : json();
    put_field(to, field, value);
  }
}

}  // namespace

std::uint32_t call_number(std::string_view name) {
  for (std::uint32_t id = 0x11000; id < 0x12000; ++id)
    if (call_name(id) == name) return id;
  throw std::logic_error("no such call");
}

CaptureWriter::CaptureWriter(Packing packing) : packing_(packing) {
  for (const std::uint32_t word : {0x52584647u, 0u, 0u, 1u, 1u, static_cast<std::uint32_t>(packing)})
    put(bytes_, word);
}

void CaptureWriter::block(std::uint32_t type, std::span<const std::byte> head,
                          std::span<const std::byte> body, bool names_size) {
  Bytes packed(body.begin(), body.end());
  if (packing_ == Packing::kLz4) {
    packed.resize(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(body.size()))));
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(
        reinterpret_cast<const char*>(body.data()), reinterpret_cast<char*>(packed.data()),
        static_cast<int>(body.size()), static_cast<int>(packed.size()))));
  } else if (packing_ == Packing::kZstd) {
    packed.resize(ZSTD_compressBound(body.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), body.data(), body.size(), 1));
  }
  const bool compressed = packing_ != Packing::kPlain;
  put<std::uint64_t>(bytes_, head.size() + packed.size() + (compressed && names_size ? 8 : 0));
  put(bytes_, type | (compressed ? 0x80000000u : 0u));
  bytes_.insert(bytes_.end(), head.begin(), head.end());
  if (compressed && names_size) put<std::uint64_t>(bytes_, body.size());
  bytes_.insert(bytes_.end(), packed.begin(), packed.end());
}

void CaptureWriter::raw_call(std::uint32_t id, std::span<const std::byte> parameters) {
  Bytes head;
  put(head, id);
  put<std::uint64_t>(head, 1);
  block(4, head, parameters, true);
}

void CaptureWriter::call(std::string_view name, const json& parameters) {
  Bytes body;
  put_structure(body, *call_parameters(name), parameters);
  raw_call(call_number(name), body);
}

void CaptureWriter::fill_memory(std::uint64_t memory, std::uint64_t offset,
                                std::span<const std::byte> bytes) {
  Bytes head;
  put<std::uint32_t>(head, 0x10002);
  for (const std::uint64_t number : {std::uint64_t{1}, memory, offset, std::uint64_t{bytes.size()}})
    put(head, number);
  block(3, head, bytes, false);
}

void CaptureWriter::device_properties(bool lavapipe) {
  Bytes head;
  put<std::uint32_t>(head, 0x1000b);
  for (const std::uint64_t number : {1u, 2u}) put(head, number);  // thread, physical device
  for (const std::uint32_t number : {0u, 0u, 0x10005u, 0u, lavapipe ? 4u : 2u}) put(head, number);
  block(3, head, Bytes(20), false);  // the cache's number, and a name without letters
}

void CaptureWriter::init_image(std::uint64_t image, std::span<const std::byte> bytes) {
  Bytes head;
  put<std::uint32_t>(head, 0x10008);
  for (const std::uint64_t number : {std::uint64_t{1}, std::uint64_t{1}, image, std::uint64_t{bytes.size()}})
    put(head, number);
  for (const std::uint32_t number : {1u, 5u, 1u}) put(head, number);
  put<std::uint64_t>(head, bytes.size());
  block(3, head, bytes, false);
}

}  // namespace quadrille::capture
