#include "scenes/gltf/draco.h"

#include <algorithm>
#include <cstring>
#include <exception>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/value.h"

namespace quadrille::scenes {
namespace {

constexpr const char* kName = "KHR_draco_mesh_compression";
// of a primitive; Draco takes about 100 bytes for each [G: half of 2 GiB]
constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 23;
// triangles times connectivity tables, of which each attribute may have its own
constexpr std::uint64_t kMaxWork = std::uint64_t{1} << 24;
constexpr std::uint64_t kMaxAttributeBytes = std::uint64_t{1} << 29;  // of a primitive
// no vertex attribute has more [glTF2.0 #meshes-overview]
constexpr std::size_t kMaxComponents = 4;
constexpr std::uint64_t kMaxDecodedBytes = std::uint64_t{1} << 30;  // of a file

/// A decoder of Draco's that stops before its two allocations by counts which the data claims: connectivity
/// and attributes. It looks at the counts where bitstream 2.2 has them. [Draco 1.5,
/// mesh_edgebreaker_decoder_impl.cc, mesh_sequential_decoder.cc]
template <class Decoder, bool kEdgebreaker>
class BoundedDecoder final : public Decoder {
 public:
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  bool refuse(const std::string& reason) {
    refusal_ = reason;
    return false;
  }

  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead(*this->buffer());
    std::uint32_t first = 0, second = 0;
    std::uint8_t tables = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead))
      return refuse("its data is truncated");
    if (kEdgebreaker && !ahead.Decode(&tables)) return refuse("its data is truncated");
    const std::uint64_t triangles = kEdgebreaker ? second : first, points = kEdgebreaker ? first : second;
    if (triangles == 0 || triangles > kMaxTriangles || points > 3 * triangles ||
        triangles * (tables + 1U) > kMaxWork)
      return refuse(
          fmt::format("{} triangles of {} vertices; 1 to {} are read", triangles, points, kMaxTriangles));
    return Decoder::DecodeConnectivity() || refuse("its triangles cannot be decoded");
  }

  bool DecodeAllAttributes() override {
    std::uint64_t bytes = 0;
    const draco::PointCloud& cloud = *this->point_cloud();
    for (int i = 0; i < cloud.num_attributes(); ++i)
      bytes += static_cast<std::uint64_t>(std::max<std::int64_t>(cloud.attribute(i)->byte_stride(), 4));
    if (bytes * cloud.num_points() > kMaxAttributeBytes)
      return refuse(fmt::format("{} vertices of {} bytes take more than {} bytes", cloud.num_points(), bytes,
                                kMaxAttributeBytes));
    return Decoder::DecodeAllAttributes() || refuse("its attributes cannot be decoded");
  }

  std::string refusal_;
};

template <class Decoder>
void run(const GltfObject& object, draco::DecoderBuffer& buffer, draco::Mesh& mesh) {
  Decoder decoder;
  const draco::DecoderOptions options;
  std::string reason;
  try {
    if (!decoder.Decode(options, &buffer, &mesh).ok())
      reason = decoder.refusal().empty() ? "its data cannot be decoded" : decoder.refusal();
  } catch (const std::exception& error) { reason = error.what(); }
  if (!reason.empty()) object.fail("bufferView", reason);
}

void decode_mesh(const GltfObject& object, std::span<const std::byte> bytes, draco::Mesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer ahead(buffer);
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok())
    object.fail("bufferView", "its data is not Draco's");
  if (header.encoder_type != draco::TRIANGULAR_MESH)
    object.fail("bufferView", "its data is no triangle mesh");
  if (header.version_major != 2 || header.version_minor != 2)
    object.fail("bufferView",
                fmt::format("bitstream {}.{}; 2.2 is read", header.version_major, header.version_minor));
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    return run<BoundedDecoder<draco::MeshEdgebreakerDecoder, true>>(object, buffer, mesh);
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    return run<BoundedDecoder<draco::MeshSequentialDecoder, false>>(object, buffer, mesh);
  object.fail("bufferView", fmt::format("encoding method {} is not one of Draco's", header.encoder_method));
}

template <class T>
bool convert(const draco::PointAttribute& source, draco::AttributeValueIndex index, std::size_t components,
             std::byte* out) {
  std::array<T, kMaxComponents> value{};
  if (!source.ConvertValue<T>(index, static_cast<std::int8_t>(components), value.data())) return false;
  std::memcpy(out, value.data(), components * sizeof(T));
  return true;
}

bool convert(const draco::PointAttribute& source, draco::AttributeValueIndex index, const Elements& form,
             std::byte* out) {
  switch (form.component) {
    case Component::kInt8: return convert<std::int8_t>(source, index, form.components, out);
    case Component::kUint8: return convert<std::uint8_t>(source, index, form.components, out);
    case Component::kInt16: return convert<std::int16_t>(source, index, form.components, out);
    case Component::kUint16: return convert<std::uint16_t>(source, index, form.components, out);
    case Component::kUint32: return convert<std::uint32_t>(source, index, form.components, out);
    case Component::kFloat: return convert<float>(source, index, form.components, out);
  }
  return false;
}

/// One attribute of the decoded mesh in the type that its accessor has.
Elements attribute_elements(const GltfObject& object, const draco::Mesh& mesh, std::uint64_t id,
                            const char* name, Elements form) {
  const draco::PointAttribute* source =
      id > 0xffffffff ? nullptr : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (source == nullptr) object.fail(name, fmt::format("Draco's data has no attribute {}", id));
  if (static_cast<std::size_t>(source->num_components()) != form.components)
    object.fail(name, fmt::format("{} components in Draco's data, {} in the accessor",
                                  source->num_components(), form.components));
  if (form.components > kMaxComponents)
    object.fail(name, fmt::format("{} components; Draco's attributes are read with at most {}",
                                  form.components, kMaxComponents));
  const std::size_t size = form.components * component_bytes(form.component);
  form.count = mesh.num_points();
  form.data.resize(form.count * size);
  const auto stored = static_cast<std::uint64_t>(source->buffer()->data_size());
  const auto stride = static_cast<std::uint64_t>(source->byte_stride());
  for (std::uint32_t i = 0; i < form.count; ++i) {
    const draco::AttributeValueIndex index = source->mapped_index(draco::PointIndex(i));
    const bool inside = index.value() < source->size() && (index.value() + 1) * stride <= stored;
    if (!inside || !convert(*source, index, form, &form.data[i * size]))
      object.fail(name, fmt::format("vertex {} cannot be decoded", i));
  }
  return form;
}

/// Indices keep the type of their accessor where the vertices fit it.
Elements index_elements(const draco::Mesh& mesh, Component wanted) {
  Elements out;
  const bool fits = (wanted == Component::kUint8 && mesh.num_points() <= 0x100) ||
                    (wanted == Component::kUint16 && mesh.num_points() <= 0x10000);
  out.component = fits ? wanted : Component::kUint32;
  out.count = 3 * mesh.num_faces();
  const std::size_t size = component_bytes(out.component);
  out.data.resize(out.count * size);
  for (std::uint32_t i = 0; i < out.count; ++i) {
    const std::uint32_t value = mesh.face(draco::FaceIndex(i / 3))[i % 3].value();
    std::memcpy(&out.data[i * size], &value, size);  // little-endian
  }
  return out;
}

class Reader {
 public:
  explicit Reader(GltfFile& file) : file_(file) {}

  void read(tinygltf::Primitive& primitive, const std::string& place, const tinygltf::Value& extension) {
    const GltfObject object(file_.path, place + "." + kName, extension);
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
      object.fail(
          "bufferView",
          fmt::format("primitive mode {}; triangles and triangle strips can be compressed", primitive.mode));
    const int view = object.index("bufferView", file_.model.bufferViews.size());
    if (!object.has("attributes")) object.fail("attributes", "it is missing");
    const GltfObject attributes = object.object("attributes");
    draco::Mesh mesh;
    decode_mesh(object, buffer_view_bytes(file_, view, object.place()), mesh);
    for (const std::string& name : attributes.value().Keys()) {
      const auto found = primitive.attributes.find(name);
      if (found == primitive.attributes.end()) attributes.fail(name, "the primitive has no such attribute");
      const Elements form = accessor_form(found->second, attributes, name);
      keep(
          found->second,
          attribute_elements(attributes, mesh, attributes.required_integer(name.c_str()), name.c_str(), form),
          object);
    }
    if (primitive.indices < 0) object.fail("bufferView", "its primitive has no accessor of indices");
    keep(primitive.indices,
         index_elements(mesh, accessor_form(primitive.indices, object, "indices").component), object);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;  // Draco's meshes are lists
  }

 private:
  Elements accessor_form(int index, const GltfObject& object, const std::string& name) const {
    const auto& accessors = file_.model.accessors;
    if (index < 0 || static_cast<std::size_t>(index) >= accessors.size())
      object.fail(name, fmt::format("accessor {} does not exist (the file has {})", index, accessors.size()));
    return accessor_type(file_, index, object.place());
  }

  void keep(int accessor, Elements elements, const GltfObject& object) {
    total_ += elements.data.size();
    if (total_ > kMaxDecodedBytes)
      object.fail("bufferView",
                  fmt::format("the compressed meshes expand to more than {} bytes", kMaxDecodedBytes));
    file_.decoded_accessors[accessor] = std::make_shared<const Elements>(std::move(elements));
  }

  GltfFile& file_;
  std::uint64_t total_ = 0;
};

}  // namespace

void decode_draco_primitives(GltfFile& file) {
  Reader reader(file);
  for (std::size_t m = 0; m < file.model.meshes.size(); ++m) {
    auto& primitives = file.model.meshes[m].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const auto extension = primitives[p].extensions.find(kName);
      if (extension != primitives[p].extensions.end())
        reader.read(primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p), extension->second);
    }
  }
}

}  // namespace quadrille::scenes
