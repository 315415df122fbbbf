/// What a call's parameters and a structure's members are, as Vulkan's registry declares them: what is needed
/// to read the bytes of a call. [VK registry] [GFXR #parameters]
///
/// The tables (schema_calls.cpp, schema_copies.cpp, schema_structs.cpp) are text: "name:type", a star for
/// what is pointed to or stands in an array. They hold the calls that this program acts upon, and every
/// structure that these can reach.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::capture {

enum class FieldKind : std::uint8_t {
  kByte,      ///< u8
  kShort,     ///< u16
  kWord,      ///< u32: numbers, flags, enumerations
  kInt,       ///< i32
  kFloat,     ///< f32
  kLong,      ///< u64: sizes, handles, addresses
  kText,      ///< a string, of which there is a pointer
  kTexts,     ///< an array of strings
  kChain,     ///< pNext
  kStruct,    ///< of `Field::structure`
  kTemplate,  ///< the data of an update template
};

struct Structure;
struct Field {
  std::string_view name;
  FieldKind kind = FieldKind::kWord;
  bool pointer = false;  ///< or an array within a structure, which is encoded alike
  const Structure* structure = nullptr;
};
/// Of a structure, or the parameters of a call.
struct Structure {
  std::string_view name;
  std::uint32_t type = 0;  ///< VkStructureType; 0 if it has none
  std::vector<Field> fields;
};

/// The parameters of a call by its name, its result last as "return"; null for a call that is not in the
/// tables.
[[nodiscard]] const Structure* call_parameters(std::string_view call);
/// The structure of a VkStructureType; null if it is not in the tables.
[[nodiscard]] const Structure* structure_of_type(std::uint32_t type);

struct SchemaRow {
  std::string_view name, fields;
  std::uint32_t type = 0;
};
[[nodiscard]] std::span<const SchemaRow> call_rows();
[[nodiscard]] std::span<const SchemaRow> structure_rows();
/// Those of copies.
[[nodiscard]] std::span<const SchemaRow> copy_call_rows();
[[nodiscard]] std::span<const SchemaRow> copy_structure_rows();

/// The name of a call by its number in the file, without "vk"; empty if it is not known. [GFXR #call-ids]
[[nodiscard]] std::string_view call_name(std::uint32_t id);

}  // namespace quadrille::capture
