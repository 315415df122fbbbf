#include "cli/counter_catalogue.h"

#include "pipeline/machine.h"

namespace quadrille::cli {
namespace {

/// The counters that a unit declares, and those of the parts it is made of, which register with its group.
template <class Stats, class... Parts>
struct Declared : Stats, Parts... {
  Declared() : Parts(static_cast<Stats&>(*this))... {}
};

template <class Stats, class... Parts>
UnitCounters unit(std::string_view kind) {
  return {kind, std::make_shared<Declared<Stats, Parts...>>()};
}

}  // namespace

std::vector<UnitCounters> counter_catalogue() {
  using hw::L1CacheStats, hw::MemoryPortStats, hw::SurfaceCacheStats;
  return {unit<hw::CommandProcessor::Stats>("command_processor"),
          unit<hw::VertexFetch::Stats, MemoryPortStats, L1CacheStats>("vertex_fetch"),
          unit<hw::PrimitiveAssembly::Stats>("primitive_assembly"),
          unit<hw::Clipper::Stats>("clipper"),
          unit<hw::TriangleSetupUnit::Stats>("triangle_setup"),
          unit<hw::CoarseRaster::Stats>("coarse_raster"),
          unit<hw::FineRaster::Stats>("fine_raster"),
          unit<hw::DepthUnit::Stats, MemoryPortStats, L1CacheStats, SurfaceCacheStats>("depth"),
          unit<hw::WarpPacker::Stats>("warp_packer"),
          unit<hw::WorkDistributor::Stats>("work_distributor"),
          unit<hw::ShaderCore::Stats>("core"),
          unit<hw::TextureUnit::Stats, MemoryPortStats, L1CacheStats>("texture"),
          unit<hw::Rop::Stats, MemoryPortStats, L1CacheStats, SurfaceCacheStats>("rop"),
          unit<hw::L2Slice::Stats>("l2"),
          unit<hw::MemoryChannel::Stats>("memory"),
          unit<hw::ScanOut::Stats, MemoryPortStats>("scan_out")};
}

}  // namespace quadrille::cli
