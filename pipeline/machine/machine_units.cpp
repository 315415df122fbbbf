#include "pipeline/machine/machine_units.h"

namespace quadrille::pipeline {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Who may write a line while it is dirty: a depth and a colour cache for each partition.
models::DeviceMemory::Owner depth_owner(int partition) { return static_cast<models::DeviceMemory::Owner>(1 + 2 * partition); }
models::DeviceMemory::Owner color_owner(int partition) { return static_cast<models::DeviceMemory::Owner>(2 + 2 * partition); }

}  // namespace

Machine::Maker::Made<hw::CommandProcessor> Machine::Maker::make(Kind<hw::CommandProcessor> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::CommandProcessor>(name, c_.command_processor, m_.clock_, frame(), c_.gpu.partitions, m_.quiet_);
}

Machine::Maker::Made<hw::VertexFetch> Machine::Maker::make(Kind<hw::VertexFetch> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::VertexFetch>(name, c_.vertex_fetch, m_.clock_, frame(), memory(), s_.batches, c_.gpu.channels);
}

Machine::Maker::Made<hw::PrimitiveAssembly> Machine::Maker::make(Kind<hw::PrimitiveAssembly> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::PrimitiveAssembly>(name, c_.primitive_assembly, m_.clock_, s_.batches, c_.gpu.cores);
}

Machine::Maker::Made<hw::Clipper> Machine::Maker::make(Kind<hw::Clipper> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::Clipper>(name, c_.clipper, m_.clock_, frame(), s_.batches, s_.pieces);
}

Machine::Maker::Made<hw::TriangleSetupUnit> Machine::Maker::make(Kind<hw::TriangleSetupUnit> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::TriangleSetupUnit>(name, c_.triangle_setup, m_.clock_, frame(), s_.batches, s_.pieces, s_.triangles,
                                                 c_.gpu.partitions);
}

Machine::Maker::Made<hw::CoarseRaster> Machine::Maker::make(Kind<hw::CoarseRaster> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::CoarseRaster>(name, c_.coarse_raster, m_.clock_, frame(), s_.triangles, c_.gpu.partitions);
}

Machine::Maker::Made<hw::FineRaster> Machine::Maker::make(Kind<hw::FineRaster> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::FineRaster>(name, c_.fine_raster, m_.clock_, s_.triangles, c_.gpu.partitions);
}

Machine::Maker::Made<hw::DepthUnit> Machine::Maker::make(Kind<hw::DepthUnit> /*kind*/, const char* name, int i) const {
  return std::make_unique<hw::DepthUnit>(name, c_.depth, m_.clock_, frame(), memory(), depth_owner(i), s_.triangles, *s_.warps[at(i)], i,
                                         c_.gpu.partitions, m_.depth_memory_ ? c_.gpu.channels : 0);
}

Machine::Maker::Made<hw::WarpPacker> Machine::Maker::make(Kind<hw::WarpPacker> /*kind*/, const char* name, int i) const {
  return std::make_unique<hw::WarpPacker>(name, c_.warp_packer, m_.clock_, *s_.warps[at(i)], i);
}

Machine::Maker::Made<hw::WorkDistributor> Machine::Maker::make(Kind<hw::WorkDistributor> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::WorkDistributor>(name, c_.work_distributor, m_.clock_, c_.gpu.partitions, c_.gpu.cores);
}

Machine::Maker::Made<hw::ShaderCore> Machine::Maker::make(Kind<hw::ShaderCore> /*kind*/, const char* name, int i) const {
  std::vector<hw::Store<hw::WarpSlot>*> warps;
  for (const auto& of_partition : s_.warps) warps.push_back(of_partition.get());
  return std::make_unique<hw::ShaderCore>(name, c_.core, m_.clock_, frame(), *s_.cores[at(i)], s_.batches, warps, s_.triangles,
                                          m_.textured_);
}

Machine::Maker::Made<hw::TextureUnit> Machine::Maker::make(Kind<hw::TextureUnit> /*kind*/, const char* name, int i) const {
  return std::make_unique<hw::TextureUnit>(name, c_.texture, m_.clock_, frame(), memory(), *s_.cores[at(i)], c_.gpu.channels);
}

Machine::Maker::Made<hw::Rop> Machine::Maker::make(Kind<hw::Rop> /*kind*/, const char* name, int i) const {
  return std::make_unique<hw::Rop>(name, c_.rop, m_.clock_, frame(), memory(), color_owner(i), *s_.warps[at(i)], i, c_.gpu.partitions,
                                   c_.gpu.cores, c_.gpu.channels);
}

Machine::Maker::Made<hw::L2Slice> Machine::Maker::make(Kind<hw::L2Slice> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::L2Slice>(name, c_.l2, m_.clock_, m_.clients_, c_.gpu.channels);
}

Machine::Maker::Made<hw::MemoryChannel> Machine::Maker::make(Kind<hw::MemoryChannel> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::MemoryChannel>(name, c_.memory, m_.memory_clock_, c_.gpu.channels);
}

Machine::Maker::Made<hw::ScanOut> Machine::Maker::make(Kind<hw::ScanOut> /*kind*/, const char* name, int /*i*/) const {
  return std::make_unique<hw::ScanOut>(name, c_.scan_out, m_.clock_, frame(), memory(), c_.gpu.channels);
}

}  // namespace quadrille::pipeline
