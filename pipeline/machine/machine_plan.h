/// What a machine is made of: every kind of unit and every class of links, declared once.
///
/// The configuration, the elaboration, the catalogue of counters and the figures walk these lists. A new kind
/// of unit is its files, its test, its line here, how it is made (machine_units.cpp) and its links' lines
/// here and in machine_wiring.cpp.
#pragma once

#include "hw/command/command_processor.h"
#include "hw/display/scan_out.h"
#include "hw/geometry/clipper.h"
#include "hw/geometry/primitive_assembly.h"
#include "hw/geometry/triangle_setup.h"
#include "hw/geometry/vertex_fetch.h"
#include "hw/memory/l2_slice.h"
#include "hw/memory/memory_channel.h"
#include "hw/raster/coarse_raster.h"
#include "hw/raster/fine_raster.h"
#include "hw/raster/warp_packer.h"
#include "hw/rop/depth_unit.h"
#include "hw/rop/rop.h"
#include "hw/shader/shader_core.h"
#include "hw/shader/work_distributor.h"
#include "hw/texture/texture_unit.h"

#include <string_view>

// Units in the order of the pipeline: name (of the parameter group too), class, how often it stands.
#define QUADRILLE_UNITS(unit)                                                                              \
  unit(command_processor, hw::CommandProcessor, kOnce) unit(vertex_fetch, hw::VertexFetch, kOnce)          \
      unit(primitive_assembly, hw::PrimitiveAssembly, kOnce) unit(clipper, hw::Clipper, kOnce)             \
          unit(triangle_setup, hw::TriangleSetupUnit, kOnce) unit(coarse_raster, hw::CoarseRaster, kOnce)  \
              unit(fine_raster, hw::FineRaster, kOnce) unit(depth, hw::DepthUnit, kPartition)              \
                  unit(warp_packer, hw::WarpPacker, kPartition)                                            \
                      unit(work_distributor, hw::WorkDistributor, kOnce) unit(core, hw::ShaderCore, kCore) \
                          unit(texture, hw::TextureUnit, kCore) unit(rop, hw::Rop, kPartition)             \
                              unit(l2, hw::L2Slice, kChannel) unit(memory, hw::MemoryChannel, kChannel)    \
                                  unit(scan_out, hw::ScanOut, kOnce)

// Links: name, default depth, width and latency, and how many tokens their producer can have for them. The
// types of their ports say what they carry.
#define QUADRILLE_LINKS(link)                                                                                \
  link(command_to_fetch, 4, 1, 1, kOneACycle) link(fetch_to_distributor, 8, 1, 1, kOneACycle) link(          \
      fetch_to_assembly, 64, 1, 1,                                                                           \
      kSeveralACycle) link(setup_to_fetch, 4, 1, 1, kOneACycle) link(core_to_assembly, 8, 1, 1, kOneACycle)  \
      link(assembly_to_distributor, 8, 4, 1, kSeveralACycle) link(                                           \
          assembly_to_clipper, 8, 1, 1, kSeveralACycle) link(clipper_to_setup, 8, 1, 4, kSeveralACycle)      \
          link(setup_to_coarse, 16, 1, 4, kSeveralACycle) link(                                              \
              coarse_to_fine, 32, 1, 2, kSeveralACycle) link(fine_to_depth, 32, 1, 2, kSeveralACycle)        \
              link(depth_to_coarse, 16, 1, 4, kOneACycle) link(depth_to_packer, 16, 1, 2, kOneACycle) link(  \
                  packer_to_distributor, 8,                                                                  \
                  1, 1, kOneACycle) link(packer_to_rop, 64, 1, 1, kOneACycle)                                \
                  link(rop_to_distributor, 8, 4, 1, kSeveralACycle) link(rop_to_packer, 8, 1, 1, kOneACycle) \
                      link(distributor_to_core, 4, 1, 2, kOneACycle)                                         \
                          link(core_to_rop, 8, 1, 2, kSeveralACycle) link(rop_to_depth, 8, 1, 2, kOneACycle) \
                              link(depth_to_rop, 8, 1, 2, kOneACycle)                                        \
                                  link(rop_to_setup, 8, 1, 2, kOneACycle)                                    \
                                      link(rop_to_command, 8, 1, 2, kOneACycle)                              \
                                          link(core_to_texture, 8, 1, 2, kOneACycle)                         \
                                              link(texture_to_core, 8, 1, 2, kOneACycle)                     \
                                                  link(client_to_l2, 16, 1, 8, kSeveralACycle)               \
                                                      link(l2_to_client, 16, 1, 8, kSeveralACycle)           \
                                                          link(l2_to_memory, 16, 1, 2, kSeveralACycle) link( \
                                                              memory_to_l2, 16, 1, 2, kSeveralACycle)        \
                                                              link(command_to_scan, 2, 1, 1, kOneAPass)      \
                                                                  link(scan_to_command, 2, 1, 1, kOneAPass)

namespace quadrille::pipeline {

/// How often a kind of unit stands in a machine: once, or once a core, partition or channel. Of several, each
/// carries its number in its name.
enum class Stands : std::uint8_t { kOnce, kPartition, kCore, kChannel };

template <class Unit>
struct UnitKind;
#define QUADRILLE_KIND(path, type, how_often)           \
  template <>                                           \
  struct UnitKind<type> {                               \
    static constexpr std::string_view name = #path;     \
    static constexpr Stands stands = Stands::how_often; \
  };
QUADRILLE_UNITS(QUADRILLE_KIND)
#undef QUADRILLE_KIND

/// Calls `visit.operator()<Unit>()` for each kind of unit, in the order of the pipeline.
template <class Visit>
void visit_unit_kinds(const Visit& visit) {
#define QUADRILLE_VISIT(path, type, how_often) visit.template operator()<type>();
  QUADRILLE_UNITS(QUADRILLE_VISIT)
#undef QUADRILLE_VISIT
}

}  // namespace quadrille::pipeline
