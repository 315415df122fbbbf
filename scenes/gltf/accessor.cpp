/// Fetching: where the bytes of an accessor are, and whether they are.
#include "scenes/gltf/accessor.h"

#include <cstring>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kMaxAccessorBytes = std::uint64_t{1} << 30;
// of an accessor that no file has to bring the bytes of
constexpr std::uint64_t kMaxZeroBytes = std::uint64_t{1} << 26;

/// An accessor under inspection, with the words for its errors.
class Reader {
 public:
  Reader(const GltfFile& file, int index, const std::string& place)
      : file_(file), place_(fmt::format("{}: accessor {}", place, index)) {
    const auto& all = file.model.accessors;
    if (index < 0 || static_cast<std::size_t>(index) >= all.size())
      fail(fmt::format("does not exist (the file has {})", all.size()));
    accessor_ = &all[static_cast<std::size_t>(index)];
  }

  Elements type() const {
    Elements elements;
    elements.component = component(accessor_->componentType);
    elements.components = components();
    elements.normalized = accessor_->normalized && elements.component != Component::kFloat;
    return elements;
  }

  Elements read() {
    Elements elements = type();
    size_ = component_bytes(elements.component) * elements.components;
    if (accessor_->count == 0 || accessor_->count > kMaxAccessorBytes / size_)
      fail(fmt::format("count {} is not 1..{}", accessor_->count, kMaxAccessorBytes / size_));
    if (accessor_->bufferView < 0 && accessor_->count > kMaxZeroBytes / size_)
      fail(fmt::format("count {} without a bufferView; at most {} elements of {} bytes are legal",
                       accessor_->count, kMaxZeroBytes / size_, size_));
    if (accessor_->bufferView >= 0) check_view();
    elements.count = static_cast<std::uint32_t>(accessor_->count);
    elements.data.resize(elements.count * size_);
    if (accessor_->bufferView >= 0) copy_elements(elements);
    if (accessor_->sparse.isSparse) put_sparse(elements);
    return elements;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw user_error("{}: {}: {}", file_.path, place_, reason);
  }

  Component component(int type) const {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE: return Component::kInt8;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return Component::kUint8;
      case TINYGLTF_COMPONENT_TYPE_SHORT: return Component::kInt16;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return Component::kUint16;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return Component::kUint32;
      case TINYGLTF_COMPONENT_TYPE_FLOAT: return Component::kFloat;
      default: fail(fmt::format("componentType {} is not one of glTF's", type));
    }
  }

  std::size_t components() const {
    switch (accessor_->type) {
      case TINYGLTF_TYPE_SCALAR: return 1;
      case TINYGLTF_TYPE_VEC2: return 2;
      case TINYGLTF_TYPE_VEC3: return 3;
      case TINYGLTF_TYPE_VEC4: return 4;
      case TINYGLTF_TYPE_MAT4: return 16;  // columns of whole words whatever the component
      default: fail("its type is not SCALAR, VEC2, VEC3, VEC4 or MAT4");
    }
  }

  /// `count` elements of `size` bytes, `stride` apart, from `offset` on, must lie within `view`.
  void check_range(std::span<const std::byte> view, std::uint64_t offset, std::uint64_t count,
                   std::uint64_t stride, std::uint64_t size, const char* what) const {
    const std::uint64_t length = (count - 1) * stride + size;  // counts and strides are below 2^31
    if (offset > view.size() || length > view.size() - offset) {
      fail(fmt::format(
          "{}{} elements of {} bytes, {} apart, from byte {} on, reach beyond its bufferView of {} bytes",
          what, count, size, stride, offset, view.size()));
    }
  }

  std::size_t stride() const {
    const std::size_t given =
        file_.model.bufferViews[static_cast<std::size_t>(accessor_->bufferView)].byteStride;
    return given == 0 ? size_ : given;
  }

  /// That the bytes are there, before anything is allocated for them.
  void check_view() const {
    const std::span<const std::byte> view = buffer_view_bytes(file_, accessor_->bufferView, place_);
    if (stride() < size_ || stride() > 252)
      fail(fmt::format("its bufferView's byteStride {} is not {}..252", stride(), size_));
    check_range(view, accessor_->byteOffset, accessor_->count, stride(), size_, "");
  }

  void copy_elements(Elements& elements) const {
    const std::span<const std::byte> view = buffer_view_bytes(file_, accessor_->bufferView, place_);
    const std::size_t stride = this->stride();
    const std::byte* source = view.data() + accessor_->byteOffset;
    for (std::size_t i = 0; i < elements.count; ++i)
      std::memcpy(&elements.data[i * size_], source + i * stride, size_);
  }

  std::uint32_t sparse_index(const std::byte* source, Component type) const {
    std::uint32_t value = 0;
    std::memcpy(&value, source, component_bytes(type));  // unsigned, little-endian
    return value;
  }

  void put_sparse(Elements& elements) const {
    const auto& sparse = accessor_->sparse;
    if (sparse.count < 1 || static_cast<std::uint64_t>(sparse.count) > elements.count)
      fail(fmt::format("sparse.count {} is not 1..{}", sparse.count, elements.count));
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
      fail("a byteOffset of its sparse part is negative");
    const Component type = component(sparse.indices.componentType);
    if (type != Component::kUint8 && type != Component::kUint16 && type != Component::kUint32)
      fail("sparse.indices: not of an unsigned type");
    const auto count = static_cast<std::uint64_t>(sparse.count);
    const auto index_offset = static_cast<std::uint64_t>(sparse.indices.byteOffset),
               value_offset = static_cast<std::uint64_t>(sparse.values.byteOffset);
    const std::size_t index_size = component_bytes(type);
    const auto indices = buffer_view_bytes(file_, sparse.indices.bufferView, place_ + " sparse.indices");
    const auto values = buffer_view_bytes(file_, sparse.values.bufferView, place_ + " sparse.values");
    check_range(indices, index_offset, count, index_size, index_size, "sparse.indices: ");
    check_range(values, value_offset, count, size_, size_, "sparse.values: ");
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint32_t target = sparse_index(indices.data() + index_offset + i * index_size, type);
      if (target >= elements.count)
        fail(fmt::format("sparse.indices: index {} is beyond {} elements", target, elements.count));
      std::memcpy(&elements.data[target * size_], values.data() + value_offset + i * size_, size_);
    }
  }

  const GltfFile& file_;
  std::string place_;
  const tinygltf::Accessor* accessor_ = nullptr;
  std::size_t size_ = 0;  ///< bytes an element
};

}  // namespace

std::size_t component_bytes(Component component) {
  switch (component) {
    case Component::kInt8:
    case Component::kUint8: return 1;
    case Component::kInt16:
    case Component::kUint16: return 2;
    case Component::kUint32:
    case Component::kFloat: return 4;
  }
  return 0;
}

Elements accessor_type(const GltfFile& file, int index, const std::string& place) {
  return Reader(file, index, place).type();
}

Elements read_accessor(const GltfFile& file, int index, const std::string& place) {
  if (const auto decoded = file.decoded_accessors.find(index); decoded != file.decoded_accessors.end())
    return *decoded->second;
  return Reader(file, index, place).read();
}

}  // namespace quadrille::scenes
