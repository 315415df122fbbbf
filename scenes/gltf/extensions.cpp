#include "scenes/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/ranges.h>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

/// What docs/scenes.md lists as covered.
constexpr std::array<std::string_view, 23> kSupported{"EXT_lights_image_based",
                                                      "EXT_mesh_gpu_instancing",
                                                      "EXT_meshopt_compression",
                                                      "EXT_texture_webp",
                                                      "KHR_draco_mesh_compression",
                                                      "KHR_lights_punctual",
                                                      "KHR_materials_clearcoat",
                                                      "KHR_materials_emissive_strength",
                                                      "KHR_materials_ior",
                                                      "KHR_materials_pbrSpecularGlossiness",
                                                      "KHR_materials_sheen",
                                                      "KHR_materials_specular",
                                                      "KHR_materials_transmission",
                                                      "KHR_materials_unlit",
                                                      "KHR_materials_variants",
                                                      "KHR_materials_volume",
                                                      "KHR_meshopt_compression",
                                                      "KHR_mesh_quantization",
                                                      "KHR_node_visibility",
                                                      "KHR_texture_transform",
                                                      "MSFT_texture_dds",
                                                      "KHR_xmp",
                                                      "KHR_xmp_json_ld"};
/// Handled where a texture uses it: a fallback image is drawn with a warning of its own.
constexpr std::string_view kBasis = "KHR_texture_basisu";

bool supported(std::string_view name) { return std::ranges::find(kSupported, name) != kSupported.end(); }

std::string printable(std::string_view name) {
  std::string result(name.substr(0, 60));
  std::ranges::replace_if(
      result, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return result.empty() ? "''" : result;
}

/// Each once, at most sixteen of them.
std::string listed(const std::vector<std::string>& names, bool basis_is_known) {
  constexpr std::size_t kMost = 16;
  std::vector<std::string> lacking;
  for (const std::string& name : names) {
    if (supported(name) || (basis_is_known && name == kBasis)) continue;
    const std::string shown = printable(name);
    if (std::ranges::find(lacking, shown) != lacking.end()) continue;
    if (lacking.size() == kMost) return fmt::format("{} and more", fmt::join(lacking, ", "));
    lacking.push_back(shown);
  }
  return fmt::format("{}", fmt::join(lacking, ", "));
}

}  // namespace

void check_extensions(GltfFile& file) {
  const std::string lacking = listed(file.model.extensionsRequired, false);
  if (!lacking.empty())
    throw user_error("{}: extensionsRequired: {} not supported; supported are {}", file.path, lacking,
                     fmt::join(kSupported, ", "));
  const std::string ignored = listed(file.model.extensionsUsed, true);
  if (!ignored.empty())
    file.notes.push_back(fmt::format("extensionsUsed: {} not supported; drawn without", ignored));
}

}  // namespace quadrille::scenes
