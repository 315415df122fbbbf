/// From the text of the tables to structures that refer to each other.
#include "traces/capture/schema.h"

#include <map>
#include <string>

#include "models/base/error.h"

namespace quadrille::capture {
namespace {

class Schema {
 public:
  Schema() {
    for (const auto rows : {structure_rows(), copy_structure_rows()})
      for (const SchemaRow& row : rows) structures_[row.name] = {row.name, row.type, {}};
    for (const auto rows : {structure_rows(), copy_structure_rows()})
      for (const SchemaRow& row : rows) fill(structures_[row.name], row.fields);
    for (const auto rows : {call_rows(), copy_call_rows()})
      for (const SchemaRow& row : rows) {
        Structure& call = calls_[row.name];
        call.name = row.name;
        fill(call, row.fields);
      }
    for (const auto& [name, structure] : structures_)
      if (structure.type != 0) types_[structure.type] = &structure;
  }
  [[nodiscard]] const Structure* call(std::string_view name) const {
    const auto found = calls_.find(name);
    return found == calls_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const Structure* of_type(std::uint32_t type) const {
    const auto found = types_.find(type);
    return found == types_.end() ? nullptr : found->second;
  }

 private:
  void fill(Structure& structure, std::string_view text) {
    while (!text.empty()) {
      const std::size_t space = std::min(text.find(' '), text.size());
      structure.fields.push_back(parse(text.substr(0, space)));
      text.remove_prefix(std::min(text.size(), space + 1));
    }
  }
  Field parse(std::string_view text) {
    Field field;
    const std::size_t colon = text.find(':');
    field.name = text.substr(0, colon);
    std::string_view type = text.substr(colon + 1);
    field.pointer = type.starts_with('*');
    if (field.pointer) type.remove_prefix(1);
    static const std::map<std::string_view, FieldKind> kKinds{
        {"u8", FieldKind::kByte},          {"u16", FieldKind::kShort},  {"u32", FieldKind::kWord},
        {"i32", FieldKind::kInt},          {"f32", FieldKind::kFloat},  {"u64", FieldKind::kLong},
        {"str", FieldKind::kText},         {"strs", FieldKind::kTexts}, {"next", FieldKind::kChain},
        {"template", FieldKind::kTemplate}};
    const auto kind = kKinds.find(type);
    if (kind != kKinds.end()) {
      field.kind = kind->second;
      return field;
    }
    const auto structure = structures_.find(type);
    QUADRILLE_CHECK(structure != structures_.end(), "no row for {}", type);
    field.kind = FieldKind::kStruct;
    field.structure = &structure->second;
    return field;
  }

  std::map<std::string_view, Structure> structures_, calls_;
  std::map<std::uint32_t, const Structure*> types_;
};

const Schema& schema() {
  static const Schema made;
  return made;
}

}  // namespace

const Structure* call_parameters(std::string_view call) {
  const Structure* found = schema().call(call);
  // What an extension brought and a later version took over has both names.
  if (found == nullptr && (call.ends_with("KHR") || call.ends_with("EXT")))
    return schema().call(call.substr(0, call.size() - 3));
  return found;
}
const Structure* structure_of_type(std::uint32_t type) { return schema().of_type(type); }

}  // namespace quadrille::capture
