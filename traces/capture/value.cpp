/// Reading values, and asking them. [GFXR #parameters]
#include "traces/capture/value.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "models/base/error.h"

namespace quadrille::capture {
namespace {

// Attributes of a pointer. [GFXR #pointers]
constexpr std::uint32_t kNullPointer = 1, kArray = 4, kText = 8, kWideText = 16, kHasAddress = 64,
                        kHasData = 128, kArrayOfArrays = 256;
constexpr int kMaxDepth = 64;  // structures within structures: a chain of them is as long as the file says

std::uint8_t bytes_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::kByte: return 1;
    case FieldKind::kShort: return 2;
    case FieldKind::kWord:
    case FieldKind::kInt:
    case FieldKind::kFloat: return 4;
    case FieldKind::kLong: return 8;
    case FieldKind::kText:
    case FieldKind::kTexts:
    case FieldKind::kChain:
    case FieldKind::kStruct:
    case FieldKind::kTemplate: break;
  }
  return 0;
}

/// What the data of an update template is written as.
const Structure& template_structure() {
  static const Structure kMade = [] {
    Structure made;
    made.name = "template";
    const Structure* write = call_parameters("UpdateDescriptorSets");
    const Structure* set = std::ranges::find(write->fields, "pDescriptorWrites", &Field::name)->structure;
    for (const char* name : {"pImageInfo", "pBufferInfo", "pTexelBufferView"})
      made.fields.push_back(*std::ranges::find(set->fields, std::string_view(name), &Field::name));
    return made;
  }();
  return kMade;
}

}  // namespace

class Decoder {
 public:
  explicit Decoder(std::span<const std::byte> bytes) : rest_(bytes) {}
  Value structure(const Structure& structure) {
    if (++depth_ > kMaxDepth) throw user_error("structures nested deeper than {}", kMaxDepth);
    Value value;
    value.shape_ = Value::Shape::kStructure;
    value.structure_ = &structure;
    value.name_ = structure.name;
    value.parts_.reserve(structure.fields.size());
    for (const Field& field : structure.fields) value.parts_.push_back(read(field));
    --depth_;
    return value;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  struct Pointer {
    bool data = false;
    std::uint64_t length = 1;
  };

  Value read(const Field& field) {
    Value value = read_kind(field);
    value.name_ = field.name;
    return value;
  }
  Value read_kind(const Field& field) {
    switch (field.kind) {
      case FieldKind::kText: return text();
      case FieldKind::kTexts: return texts();
      case FieldKind::kChain: return chain();
      case FieldKind::kTemplate: return update_template();
      case FieldKind::kStruct: return field.pointer ? structures(field) : structure(*field.structure);
      case FieldKind::kByte:
      case FieldKind::kShort:
      case FieldKind::kWord:
      case FieldKind::kInt:
      case FieldKind::kFloat:
      case FieldKind::kLong: break;
    }
    if (!field.pointer) return numbers(field.kind, 1);
    const Pointer pointer = read_pointer();
    return pointer.data ? numbers(field.kind, pointer.length) : Value{};
  }
  Value numbers(FieldKind kind, std::uint64_t count) {
    Value value;
    value.shape_ = Value::Shape::kNumbers;
    value.bytes_each_ = bytes_of(kind);
    if (count > rest_.size() / value.bytes_each_)
      throw user_error("{} numbers are announced where {} bytes remain", count, rest_.size());
    value.data_ = take(count * value.bytes_each_);
    return value;
  }
  Value structures(const Field& field) {
    const Pointer pointer = read_pointer();
    if (!pointer.data) return {};
    Value value;
    value.shape_ = Value::Shape::kList;
    if (pointer.length > rest_.size())
      throw user_error("{} structures are announced where {} bytes remain", pointer.length, rest_.size());
    for (std::uint64_t i = 0; i < pointer.length; ++i) value.parts_.push_back(structure(*field.structure));
    return value;
  }
  Value text() {
    const Pointer pointer = read_pointer();
    if (!pointer.data) return {};
    Value value;
    value.shape_ = Value::Shape::kText;
    value.data_ = take(pointer.length);
    return value;
  }
  Value texts() {
    const Pointer pointer = read_pointer();
    if (!pointer.data) return {};
    Value value;
    value.shape_ = Value::Shape::kList;
    if (pointer.length > rest_.size())
      throw user_error("{} texts are announced where {} bytes remain", pointer.length, rest_.size());
    for (std::uint64_t i = 0; i < pointer.length; ++i) value.parts_.push_back(text());
    return value;
  }
  Value chain() {
    const Pointer pointer = read_pointer();
    if (!pointer.data) return {};
    std::uint32_t type = 0;
    if (rest_.size() < sizeof(type)) throw user_error("its parameters end early");
    std::memcpy(&type, rest_.data(), sizeof(type));
    const Structure* known = structure_of_type(type);
    if (known == nullptr)
      throw user_error("a structure of VkStructureType {} behind pNext is not known", type);
    Value value;
    value.shape_ = Value::Shape::kList;
    value.parts_.push_back(structure(*known));
    return value;
  }
  /// Its counts stand before all three arrays.
  Value update_template() {
    const Pointer pointer = read_pointer();
    if (!pointer.data) return {};
    Value value;
    value.shape_ = Value::Shape::kStructure;
    value.structure_ = &template_structure();
    std::uint64_t counts[3];
    for (std::uint64_t& count : counts) count = word<std::uint64_t>();
    for (std::size_t part = 0; part < 3; ++part) {
      const Field& field = value.structure_->fields[part];
      if (counts[part] > rest_.size())
        throw user_error("{} descriptors are announced where {} bytes remain", counts[part], rest_.size());
      Value list;
      list.shape_ = Value::Shape::kList;
      if (field.structure == nullptr) list = numbers(field.kind, counts[part]);
      else
        for (std::uint64_t i = 0; i < counts[part]; ++i) list.parts_.push_back(structure(*field.structure));
      list.name_ = field.name;
      value.parts_.push_back(std::move(list));
    }
    return value;
  }

  Pointer read_pointer() {
    const auto attributes = word<std::uint32_t>();
    if ((attributes & kNullPointer) != 0) return {};
    if ((attributes & kHasAddress) != 0) (void)word<std::uint64_t>();
    Pointer pointer;
    if ((attributes & (kArray | kText | kWideText | kArrayOfArrays)) != 0)
      pointer.length = word<std::uint64_t>();
    pointer.data = (attributes & kHasData) != 0;
    return pointer;
  }
  template <class T>
  T word() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::span<const std::byte> take(std::uint64_t bytes) {
    if (bytes > rest_.size()) throw user_error("its parameters end early");
    const std::span<const std::byte> taken = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return taken;
  }

  std::span<const std::byte> rest_;
  int depth_ = 0;
};

std::size_t Value::size() const {
  switch (shape_) {
    case Shape::kNull: return 0;
    case Shape::kNumbers: return data_.size() / bytes_each_;
    case Shape::kText: return data_.size();
    case Shape::kStructure: return 1;
    case Shape::kList: return parts_.size();
  }
  return 0;
}

std::uint64_t Value::number(std::size_t i) const {
  if (shape_ != Shape::kNumbers || i >= size()) throw user_error("{} has no number {}", name_, i);
  std::uint64_t value = 0;
  std::memcpy(&value, data_.data() + i * bytes_each_, bytes_each_);
  return value;
}

float Value::f32(std::size_t i) const { return std::bit_cast<float>(u32(i)); }

std::string Value::text() const {
  return shape_ == Shape::kText ? std::string(reinterpret_cast<const char*>(data_.data()), data_.size())
                                : std::string();
}

std::span<const std::byte> Value::bytes() const {
  return shape_ == Shape::kNumbers ? data_ : std::span<const std::byte>{};
}

const Value& Value::operator[](std::string_view member) const {
  if (shape_ == Shape::kList && parts_.size() == 1) return parts_[0][member];
  if (shape_ != Shape::kStructure) throw user_error("{} is missing, and with it {}", name_, member);
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (structure_->fields[i].name == member) return parts_[i];
  internal_error(__FILE__, __LINE__, "member", fmt::format("{} has no {}", structure_->name, member));
}

bool Value::has(std::string_view member) const {
  return shape_ == Shape::kStructure &&
         std::ranges::any_of(structure_->fields, [&](const Field& field) { return field.name == member; });
}

const Value& Value::at(std::size_t i) const {
  if (shape_ != Shape::kList || i >= parts_.size()) throw user_error("{} has no element {}", name_, i);
  return parts_[i];
}

const Value* Value::next(std::uint32_t type) const {
  const Value* link = &(*this)["pNext"];
  while (!link->null()) {
    if ((*link)["sType"].u32() == type) return &link->parts_[0];
    link = &(*link)["pNext"];
  }
  return nullptr;
}

Value read_parameters(const Structure& call, std::span<const std::byte> bytes) {
  Decoder decoder(bytes);
  Value value = decoder.structure(call);
  if (decoder.left() > 0) throw user_error("{} bytes follow its parameters", decoder.left());
  return value;
}

}  // namespace quadrille::capture
