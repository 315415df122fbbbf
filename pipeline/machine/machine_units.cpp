#include "pipeline/machine/machine_units.h"

namespace quadrille::pipeline {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Machine::Maker::Made<hw::CommandProcessor> Machine::Maker::make(Kind<hw::CommandProcessor> kind,
                                                                const char* name, int i) const {
  return std::make_unique<hw::CommandProcessor>(name, context(kind, i), c_.command_processor, m_.quiet_);
}

Machine::Maker::Made<hw::VertexFetch> Machine::Maker::make(Kind<hw::VertexFetch> kind, const char* name,
                                                           int i) const {
  return std::make_unique<hw::VertexFetch>(name, context(kind, i), c_.vertex_fetch, s_.batches);
}

Machine::Maker::Made<hw::PrimitiveAssembly> Machine::Maker::make(Kind<hw::PrimitiveAssembly> kind,
                                                                 const char* name, int i) const {
  return std::make_unique<hw::PrimitiveAssembly>(name, context(kind, i), c_.primitive_assembly, s_.batches);
}

Machine::Maker::Made<hw::Clipper> Machine::Maker::make(Kind<hw::Clipper> kind, const char* name,
                                                       int i) const {
  std::vector<hw::Store<hw::ClippedPiece>*> pieces;
  pieces.reserve(at(c_.gpu.engines));
  for (int e = 0; e < c_.gpu.engines; ++e) pieces.push_back(&pieces_between(i, e));
  return std::make_unique<hw::Clipper>(name, context(kind, i), c_.clipper, s_.batches, std::move(pieces));
}

Machine::Maker::Made<hw::TriangleSetupUnit> Machine::Maker::make(Kind<hw::TriangleSetupUnit> kind,
                                                                 const char* name, int i) const {
  std::vector<const hw::Store<hw::ClippedPiece>*> pieces;
  pieces.reserve(at(c_.gpu.front_ends));
  for (int f = 0; f < c_.gpu.front_ends; ++f) pieces.push_back(&pieces_between(f, i));
  return std::make_unique<hw::TriangleSetupUnit>(
      name, context(kind, i), c_.triangle_setup,
      hw::TriangleSetupUnit::Stores{s_.batches, std::move(pieces), *s_.triangles[at(i)]});
}

Machine::Maker::Made<hw::CoarseRaster> Machine::Maker::make(Kind<hw::CoarseRaster> kind, const char* name,
                                                            int i) const {
  return std::make_unique<hw::CoarseRaster>(name, context(kind, i), c_.coarse_raster, *s_.triangles[at(i)],
                                            *s_.walked[at(i)]);
}

Machine::Maker::Made<hw::FineRaster> Machine::Maker::make(Kind<hw::FineRaster> kind, const char* name,
                                                          int i) const {
  return std::make_unique<hw::FineRaster>(name, context(kind, i), c_.fine_raster, *s_.triangles[at(i)],
                                          *s_.walked[at(i)]);
}

Machine::Maker::Made<hw::DepthUnit> Machine::Maker::make(Kind<hw::DepthUnit> kind, const char* name,
                                                         int i) const {
  return std::make_unique<hw::DepthUnit>(
      name, m_.depth_memory_ ? context(kind, i) : context(kind, i).without_memory(), c_.depth,
      triangles_of_partition(hw::PartitionId(i)), *s_.warps[at(i)]);
}

Machine::Maker::Made<hw::WarpPacker> Machine::Maker::make(Kind<hw::WarpPacker> kind, const char* name,
                                                          int i) const {
  return std::make_unique<hw::WarpPacker>(name, context(kind, i), c_.warp_packer, *s_.warps[at(i)]);
}

Machine::Maker::Made<hw::WorkDistributor> Machine::Maker::make(Kind<hw::WorkDistributor> kind,
                                                               const char* name, int i) const {
  return std::make_unique<hw::WorkDistributor>(name, context(kind, i), c_.work_distributor);
}

Machine::Maker::Made<hw::ShaderCore> Machine::Maker::make(Kind<hw::ShaderCore> kind, const char* name,
                                                          int i) const {
  std::vector<hw::WarpStore*> warps;
  for (const auto& of_partition : s_.warps) warps.push_back(of_partition.get());
  std::vector<const hw::TriangleStore*> triangles;
  for (const auto& of_engine : s_.triangles) triangles.push_back(of_engine.get());
  const hw::ShaderCore::Stores stores{*s_.cores[at(i)], s_.batches, std::move(warps), std::move(triangles)};
  return std::make_unique<hw::ShaderCore>(name, context(kind, i), c_.core, stores,
                                          hw::ShaderCore::Neighbours{m_.textured_, m_.stored_});
}

Machine::Maker::Made<hw::TextureUnit> Machine::Maker::make(Kind<hw::TextureUnit> kind, const char* name,
                                                           int i) const {
  return std::make_unique<hw::TextureUnit>(name, context(kind, i), c_.texture, *s_.cores[at(i)]);
}

Machine::Maker::Made<hw::LoadStoreUnit> Machine::Maker::make(Kind<hw::LoadStoreUnit> kind, const char* name,
                                                             int i) const {
  return std::make_unique<hw::LoadStoreUnit>(name, context(kind, i), c_.load_store, *s_.cores[at(i)]);
}

Machine::Maker::Made<hw::Rop> Machine::Maker::make(Kind<hw::Rop> kind, const char* name, int i) const {
  return std::make_unique<hw::Rop>(name, context(kind, i), c_.rop, *s_.warps[at(i)]);
}

Machine::Maker::Made<hw::L2Slice> Machine::Maker::make(Kind<hw::L2Slice> kind, const char* name,
                                                       int i) const {
  return std::make_unique<hw::L2Slice>(name, context(kind, i), c_.l2, m_.clients_);
}

Machine::Maker::Made<hw::MemoryChannel> Machine::Maker::make(Kind<hw::MemoryChannel> kind, const char* name,
                                                             int i) const {
  return std::make_unique<hw::MemoryChannel>(name, context(kind, i, m_.memory_clock_), c_.memory);
}

Machine::Maker::Made<hw::ScanOut> Machine::Maker::make(Kind<hw::ScanOut> kind, const char* name,
                                                       int i) const {
  return std::make_unique<hw::ScanOut>(name, context(kind, i), c_.scan_out);
}

}  // namespace quadrille::pipeline
