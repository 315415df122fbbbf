#include "pipeline/machine/machine_wiring.h"

#include <algorithm>

namespace quadrille::pipeline {

template <class Token>
void Machine::Wiring::link(hw::FifoOut<Token>& from, hw::FifoIn<Token>& to, const LinkParams& of,
                           const std::string& path, int path_clk) {
  hw::LinkSpec spec = of.spec();
  // A longer way holds as many tokens more as are on it.
  spec.latency += path_clk;
  spec.depth += spec.width * path_clk;
  auto made = std::make_unique<hw::Fifo<Token>>(path.c_str(), spec);
  from.bind(*made);
  to.bind(*made);
  m_.links_.push_back(std::move(made));
  m_.link_keys_.push_back(fmt::format("link.{}", of.name));
}

void Machine::Wiring::wire() {
  geometry();
  for (std::size_t p = 0; p < m_.all<hw::Rop>().size(); ++p) partition(p);
  for (std::size_t c = 0; c < m_.all<hw::ShaderCore>().size(); ++c) core(c);
  memory();
}

void Machine::Wiring::geometry() {
  auto& command = m_.one<hw::CommandProcessor>();
  auto& fetch = m_.one<hw::VertexFetch>();
  auto& assembly = m_.one<hw::PrimitiveAssembly>();
  auto& clipper = m_.one<hw::Clipper>();
  auto& setup = m_.one<hw::TriangleSetupUnit>();
  auto& coarse = m_.one<hw::CoarseRaster>();
  auto& distributor = m_.one<hw::WorkDistributor>();
  auto& scan_out = m_.one<hw::ScanOut>();
  link(command.draw_out, fetch.draw_in, l_.command_to_fetch);
  link(fetch.warp_out, distributor.vertex_in, l_.fetch_to_distributor);
  link(fetch.batch_out, assembly.batch_in, l_.fetch_to_assembly);
  link(assembly.primitive_out, clipper.primitive_in, l_.assembly_to_clipper);
  link(clipper.clipped_out, setup.clipped_in, l_.clipper_to_setup);
  link(assembly.load_out, distributor.load_in[m_.all<hw::Rop>().size()], l_.assembly_to_distributor);
  link(setup.release_out, fetch.release_in, l_.setup_to_fetch);
  link(setup.triangle_out, coarse.triangle_in, l_.setup_to_coarse);
  link(coarse.tile_out, m_.one<hw::FineRaster>().tile_in, l_.coarse_to_fine);
  link(command.scan_out, scan_out.scan_in, l_.command_to_scan);
  link(scan_out.done_out, command.scan_done_in, l_.scan_to_command);
}

void Machine::Wiring::partition(std::size_t p) {
  auto& depth = *m_.all<hw::DepthUnit>()[p];
  auto& packer = *m_.all<hw::WarpPacker>()[p];
  auto& rop = *m_.all<hw::Rop>()[p];
  auto& distributor = m_.one<hw::WorkDistributor>();
  link(*m_.one<hw::FineRaster>().coverage_out[p], depth.coverage_in, l_.fine_to_depth, p);
  link(depth.hiz_out, m_.one<hw::CoarseRaster>().hiz_in[p], l_.depth_to_coarse, p);
  link(depth.coverage_out, packer.coverage_in, l_.depth_to_packer, p);
  link(packer.warp_out, distributor.fragment_in[p], l_.packer_to_distributor, p);
  link(packer.order_out, rop.order_in, l_.packer_to_rop, p);
  link(rop.release_out, packer.release_in, l_.rop_to_packer, p);
  link(rop.load_out, distributor.load_in[p], l_.rop_to_distributor, p);
  link(rop.late_out, depth.late_in, l_.rop_to_depth, p);
  link(depth.late_out, rop.late_in, l_.depth_to_rop, p);
  link(rop.sync_out, m_.one<hw::TriangleSetupUnit>().sync_in[p], l_.rop_to_setup, p);
  link(rop.retire_out, m_.one<hw::CommandProcessor>().retire_in[p], l_.rop_to_command, p);
}

void Machine::Wiring::core(std::size_t c) {
  auto& core = *m_.all<hw::ShaderCore>()[c];
  auto& distributor = m_.one<hw::WorkDistributor>();
  link(*distributor.vertex_out[c], core.vertex_in, l_.distributor_to_core,
       fmt::format("distributor_to_core_vertex_{}", c));
  link(*distributor.fragment_out[c], core.fragment_in, l_.distributor_to_core,
       fmt::format("distributor_to_core_fragment_{}", c));
  link(core.vertex_out, m_.one<hw::PrimitiveAssembly>().done_in[c], l_.core_to_assembly, c);
  for (std::size_t p = 0; p < m_.all<hw::Rop>().size(); ++p)
    link(*core.fragment_out[p], m_.all<hw::Rop>()[p]->done_in[c], l_.core_to_rop,
         fmt::format("core_to_rop_{}_{}", c, p));
  if (m_.all<hw::TextureUnit>().empty()) return;
  auto& texture = *m_.all<hw::TextureUnit>()[c];
  link(*core.texture_out, texture.request_in, l_.core_to_texture, c);
  link(texture.response_out, *core.texture_in, l_.texture_to_core, c);
}

void Machine::Wiring::client(const hw::Unit& unit, hw::MemoryPort& port) {
  const auto found =
      std::ranges::find(m_.clients_, std::string_view(unit.name()), &hw::L2Slice::Client::name);
  QUADRILLE_CHECK(found != m_.clients_.end(), "{} is no client of the L2 cache", unit.name());
  const auto number = static_cast<std::size_t>(found - m_.clients_.begin());
  const std::vector<hw::L2Slice*>& slices = m_.all<hw::L2Slice>();
  for (std::size_t i = 0; i < slices.size(); ++i) {
    link(*port.request_out[i], slices[i]->request_in[number], l_.client_to_l2,
         fmt::format("{}_to_l2_{}", unit.name(), i));
    link(*slices[i]->response_out[number], port.response_in[i], l_.l2_to_client,
         fmt::format("l2_{}_to_{}", i, unit.name()));
  }
}

void Machine::Wiring::memory() {
  client(m_.one<hw::VertexFetch>(), m_.one<hw::VertexFetch>().memory_port());
  for (hw::TextureUnit* texture : m_.all<hw::TextureUnit>()) client(*texture, texture->memory_port());
  for (std::size_t p = 0; p < m_.all<hw::Rop>().size(); ++p) {
    hw::DepthUnit& depth = *m_.all<hw::DepthUnit>()[p];
    if (depth.memory_port().slices() > 0) client(depth, depth.memory_port());
    client(*m_.all<hw::Rop>()[p], m_.all<hw::Rop>()[p]->memory_port());
  }
  client(m_.one<hw::ScanOut>(), m_.one<hw::ScanOut>().memory_port());
  for (std::size_t i = 0; i < m_.all<hw::L2Slice>().size(); ++i) {
    hw::L2Slice& slice = *m_.all<hw::L2Slice>()[i];
    hw::MemoryChannel& channel = *m_.all<hw::MemoryChannel>()[i];
    link(slice.memory_out, channel.request_in, l_.l2_to_memory, i);
    link(channel.response_out, slice.fill_in, l_.memory_to_l2, fmt::format("memory_to_l2_{}", i),
         m_.config_.memory.path_clk);
  }
}

}  // namespace quadrille::pipeline
