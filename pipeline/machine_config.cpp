#include "pipeline/machine_config.h"

#include <algorithm>

namespace quadrille::pipeline {

MachineConfig::MachineConfig() {
  groups_ = {{"gpu", &gpu},
             {"command_processor", &command_processor},
             {"vertex_fetch", &vertex_fetch},
             {"clipper", &clipper},
             {"triangle_setup", &triangle_setup},
             {"coarse_raster", &coarse_raster},
             {"fine_raster", &fine_raster},
             {"depth", &depth},
             {"warp_packer", &warp_packer},
             {"core", &core},
             {"texture", &texture},
             {"rop", &rop},
             {"l2", &l2},
             {"memory", &memory},
             {"scan_out", &scan_out},
             {"link.command_to_fetch", &link.command_to_fetch},
             {"link.fetch_to_distributor", &link.fetch_to_distributor},
             {"link.fetch_to_assembly", &link.fetch_to_assembly},
             {"link.setup_to_fetch", &link.setup_to_fetch},
             {"link.core_to_assembly", &link.core_to_assembly},
             {"link.assembly_to_clipper", &link.assembly_to_clipper},
             {"link.clipper_to_setup", &link.clipper_to_setup},
             {"link.setup_to_coarse", &link.setup_to_coarse},
             {"link.coarse_to_fine", &link.coarse_to_fine},
             {"link.fine_to_depth", &link.fine_to_depth},
             {"link.depth_to_coarse", &link.depth_to_coarse},
             {"link.depth_to_packer", &link.depth_to_packer},
             {"link.packer_to_distributor", &link.packer_to_distributor},
             {"link.packer_to_rop", &link.packer_to_rop},
             {"link.rop_to_packer", &link.rop_to_packer},
             {"link.distributor_to_core", &link.distributor_to_core},
             {"link.core_to_rop", &link.core_to_rop},
             {"link.rop_to_depth", &link.rop_to_depth},
             {"link.depth_to_rop", &link.depth_to_rop},
             {"link.rop_to_setup", &link.rop_to_setup},
             {"link.rop_to_command", &link.rop_to_command},
             {"link.core_to_texture", &link.core_to_texture},
             {"link.texture_to_core", &link.texture_to_core},
             {"link.client_to_l2", &link.client_to_l2},
             {"link.l2_to_client", &link.l2_to_client},
             {"link.l2_to_memory", &link.l2_to_memory},
             {"link.memory_to_l2", &link.memory_to_l2},
             {"link.command_to_scan", &link.command_to_scan},
             {"link.scan_to_command", &link.scan_to_command}};
}

void MachineConfig::set(std::string_view key, std::string_view value, std::string_view where) {
  const std::size_t dot = key.rfind('.');
  const std::string_view group_name = dot == std::string_view::npos ? std::string_view{} : key.substr(0, dot);
  const auto group = std::ranges::find_if(groups_, [&](const auto& g) { return g.first == group_name; });
  if (group == groups_.end()) {
    std::string legal;
    for (const auto& g : groups_) {
      if (g.first.starts_with("link.") && group_name.substr(0, 4) != "link") continue;
      legal += (legal.empty() ? "" : ", ") + g.first;
    }
    throw user_error("{}: unknown key '{}'; groups: {}{}", where, key, legal, legal.find("link.") == std::string::npos ? ", link.*" : "");
  }
  hw::ParamBase* const param = group->second->find(key.substr(dot + 1));
  if (param == nullptr) {
    std::string legal;
    for (const hw::ParamBase* p : group->second->params()) legal += fmt::format("{}{}", legal.empty() ? "" : ", ", p->name());
    throw user_error("{}: unknown key '{}'; parameters of {}: {}", where, key, group_name, legal);
  }
  try {
    param->parse(value);
  } catch (const UserError& e) { throw user_error("{}: {}: {}", where, key, e.what()); }
}

void MachineConfig::check() const {
  const auto cache = [](std::string_view path, int lines, int ways) {
    if (lines < ways) throw user_error("machine: {0}.cache_lines ({1}) is smaller than {0}.cache_ways ({2})", path, lines, ways);
  };
  cache("vertex_fetch", vertex_fetch.cache_lines, vertex_fetch.cache_ways);
  cache("texture", texture.cache_lines, texture.cache_ways);
  cache("depth", depth.cache_lines, depth.cache_ways);
  cache("rop", rop.cache_lines, rop.cache_ways);
  cache("l2", l2.cache_lines, l2.cache_ways);
}

}  // namespace quadrille::pipeline
