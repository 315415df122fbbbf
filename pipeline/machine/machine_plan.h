/// What a machine is made of: every kind of unit and every class of links, declared once.
///
/// The configuration, the elaboration, the wiring, the catalogue of counters, the figures, the block diagram
/// and the contract tests walk these lists. A new kind of unit is its files, its test, its line here and how
/// it is made (machine_units.cpp); a new link is its line here.
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
#include "hw/shader/load_store_unit.h"
#include "hw/shader/shader_core.h"
#include "hw/shader/work_distributor.h"
#include "hw/texture/texture_unit.h"

#include <array>
#include <string_view>
#include <type_traits>

// One entry a line.
// clang-format off

// Units in the order of the pipeline: name (of the parameter group too), class, how often it stands, which
// frames need it.
#define QUADRILLE_UNITS(unit)                                                            \
  unit(command_processor,  hw::CommandProcessor,  kOnce,      kByAllFrames)              \
  unit(vertex_fetch,       hw::VertexFetch,       kFrontEnd,  kByAllFrames)              \
  unit(primitive_assembly, hw::PrimitiveAssembly, kFrontEnd,  kByAllFrames)              \
  unit(clipper,            hw::Clipper,           kFrontEnd,  kByAllFrames)              \
  unit(triangle_setup,     hw::TriangleSetupUnit, kEngine,    kByAllFrames)              \
  unit(coarse_raster,      hw::CoarseRaster,      kEngine,    kByAllFrames)              \
  unit(fine_raster,        hw::FineRaster,        kEngine,    kByAllFrames)              \
  unit(depth,              hw::DepthUnit,         kPartition, kByAllFrames)              \
  unit(warp_packer,        hw::WarpPacker,        kPartition, kByAllFrames)              \
  unit(work_distributor,   hw::WorkDistributor,   kOnce,      kByAllFrames)              \
  unit(core,               hw::ShaderCore,        kCore,      kByAllFrames)              \
  unit(texture,            hw::TextureUnit,       kCore,      kByFramesThatReadTextures) \
  unit(load_store,         hw::LoadStoreUnit,     kCore,      kByFramesWithStorage)      \
  unit(rop,                hw::Rop,               kPartition, kByAllFrames)              \
  unit(l2,                 hw::L2Slice,           kChannel,   kByAllFrames)              \
  unit(memory,             hw::MemoryChannel,     kChannel,   kByAllFrames)              \
  unit(scan_out,           hw::ScanOut,           kOnce,      kByAllFrames)

// Who asks the L2 slices, in the order of their ports, and in which frames. Neighbours that stand equally
// often take turns: the first of each, then the second of each.
#define QUADRILLE_CLIENTS(client)                    \
  client(VertexFetch, kByAllFrames)                  \
  client(TextureUnit, kByFramesThatReadTextures)     \
  client(LoadStoreUnit, kByFramesWithStorage)        \
  client(DepthUnit,   kByFramesThatKeepDepths)       \
  client(Rop,         kByAllFrames)                  \
  client(ScanOut,     kByAllFrames)

// Links: name, default depth, width and latency, how many tokens their producer can have for them, what they
// do for the flow of work, and which ports they join. Cores finish fragment warps at the rate at which they
// get them: one a cycle over all. The types of the ports say what they carry; how often
// their units stand says how many links there are.
#define QUADRILLE_LINKS(link)                                                                      \
  link(command_to_fetch,         4, 1, 1, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(CommandProcessor, draw_out, VertexFetch, draw_in))                           \
  link(fetch_to_distributor,     8, 1, 1, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(VertexFetch, warp_out, WorkDistributor, vertex_in))                          \
  link(fetch_to_assembly,       64, 1, 1, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(VertexFetch, batch_out, PrimitiveAssembly, batch_in))                        \
  link(assembly_to_clipper,      8, 1, 1, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(PrimitiveAssembly, primitive_out, Clipper, primitive_in))                    \
  link(clipper_to_setup,         8, 1, 4, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(Clipper, clipped_out, TriangleSetupUnit, clipped_in))                        \
  link(assembly_to_distributor,  8, 4, 1, kSeveralACycle, kBack,                                   \
       QUADRILLE_WIRE(PrimitiveAssembly, load_out, WorkDistributor, load_in))                      \
  link(setup_to_fetch,           4, 1, 1, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(TriangleSetupUnit, release_out, VertexFetch, release_in))                    \
  link(setup_to_coarse,         16, 1, 4, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(TriangleSetupUnit, triangle_out, CoarseRaster, triangle_in))                 \
  link(coarse_to_fine,          32, 1, 2, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(CoarseRaster, tile_out, FineRaster, tile_in))                                \
  link(command_to_scan,          2, 1, 1, kOneAPass,      kOnward,                                 \
       QUADRILLE_WIRE(CommandProcessor, scan_out, ScanOut, scan_in))                               \
  link(scan_to_command,          2, 1, 1, kOneAPass,      kBack,                                   \
       QUADRILLE_WIRE(ScanOut, done_out, CommandProcessor, scan_done_in))                          \
  link(fine_to_depth,           32, 1, 2, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(FineRaster, coverage_out, DepthUnit, coverage_in))                           \
  link(depth_to_coarse,         16, 1, 4, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(DepthUnit, hiz_out, CoarseRaster, hiz_in))                                   \
  link(depth_to_packer,         16, 1, 2, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(DepthUnit, coverage_out, WarpPacker, coverage_in))                           \
  link(packer_to_distributor,    8, 1, 1, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(WarpPacker, warp_out, WorkDistributor, fragment_in))                         \
  link(packer_to_rop,           64, 1, 1, kOneACycle,     kAhead,                                  \
       QUADRILLE_WIRE(WarpPacker, order_out, Rop, order_in))                                       \
  link(rop_to_packer,            8, 1, 1, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(Rop, release_out, WarpPacker, release_in))                                   \
  link(rop_to_distributor,       8, 4, 1, kSeveralACycle, kBack,                                   \
       QUADRILLE_WIRE(Rop, load_out, WorkDistributor, load_in))                                    \
  link(rop_to_depth,             8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(Rop, late_out, DepthUnit, late_in))                                          \
  link(depth_to_rop,             8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(DepthUnit, late_out, Rop, late_in))                                          \
  link(rop_to_setup,             8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(Rop, sync_out, TriangleSetupUnit, sync_in))                                  \
  link(rop_to_command,           8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(Rop, retire_out, CommandProcessor, retire_in))                               \
  link(distributor_to_core,      4, 1, 2, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(WorkDistributor, vertex_out, ShaderCore, vertex_in),                         \
       QUADRILLE_WIRE(WorkDistributor, fragment_out, ShaderCore, fragment_in))                     \
  link(core_to_assembly,         8, 1, 1, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(ShaderCore, vertex_out, PrimitiveAssembly, done_in))                         \
  link(core_to_rop,              8, 1, 2, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(ShaderCore, fragment_out, Rop, done_in))                                     \
  link(core_to_texture,          8, 1, 2, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(ShaderCore, texture_out, TextureUnit, request_in))                           \
  link(texture_to_core,          8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(TextureUnit, response_out, ShaderCore, texture_in))                          \
  link(core_to_load_store,       8, 1, 2, kOneACycle,     kOnward,                                 \
       QUADRILLE_WIRE(ShaderCore, storage_out, LoadStoreUnit, request_in))                         \
  link(load_store_to_core,       8, 1, 2, kOneACycle,     kBack,                                   \
       QUADRILLE_WIRE(LoadStoreUnit, response_out, ShaderCore, storage_in))                        \
  link(client_to_l2,            16, 1, 8, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(MemoryPort, request_out, L2Slice, request_in))                               \
  link(l2_to_client,            16, 1, 8, kSeveralACycle, kBack,                                   \
       QUADRILLE_WIRE(L2Slice, response_out, MemoryPort, response_in))                             \
  link(l2_to_memory,            16, 1, 2, kSeveralACycle, kOnward,                                 \
       QUADRILLE_WIRE(L2Slice, memory_out, MemoryChannel, request_in))                             \
  link(memory_to_l2,            16, 1, 2, kSeveralACycle, kBack,                                   \
       QUADRILLE_WIRE(MemoryChannel, response_out, L2Slice, fill_in))
#define QUADRILLE_WIRE(from, output, to, input) \
  ::quadrille::pipeline::Wire<&hw::from::output, &hw::to::input>
// clang-format on

namespace quadrille::pipeline {

/// How often a kind of unit stands in a machine: once, or once a geometry front end, raster engine,
/// partition, core or channel. Of several, each carries its number in its name.
enum class Stands : std::uint8_t { kOnce, kFrontEnd, kEngine, kPartition, kCore, kChannel };
/// Which frames need a kind of unit, or its links to memory; a machine leaves out what its frame does not
/// need.
enum class Needed : std::uint8_t {
  kByAllFrames,
  kByFramesThatReadTextures,
  kByFramesWithStorage,
  kByFramesThatKeepDepths
};
/// What the tokens of a link do: carry work onward, tell of work that comes another way, or bring answers,
/// releases and reports back.
enum class LinkWay : std::uint8_t { kOnward, kAhead, kBack };

template <class Unit>
struct UnitKind;
#define QUADRILLE_KIND(path, type, how_often, frames)   \
  template <>                                           \
  struct UnitKind<type> {                               \
    static constexpr std::string_view name = #path;     \
    static constexpr Stands stands = Stands::how_often; \
    static constexpr Needed needed = Needed::frames;    \
  };
QUADRILLE_UNITS(QUADRILLE_KIND)
#undef QUADRILLE_KIND

/// The names of all kinds of units, in the order of the pipeline.
[[nodiscard]] constexpr auto unit_kind_names() {
#define QUADRILLE_NAME(path, type, how_often, frames) std::string_view(#path),
  return std::to_array({QUADRILLE_UNITS(QUADRILLE_NAME)});
#undef QUADRILLE_NAME
}

/// Calls `visit.operator()<Unit>()` for each kind of unit, in the order of the pipeline.
template <class Visit>
void visit_unit_kinds(const Visit& visit) {
#define QUADRILLE_VISIT(path, type, how_often, frames) visit.template operator()<type>();
  QUADRILLE_UNITS(QUADRILLE_VISIT)
#undef QUADRILLE_VISIT
}

/// Calls `visit.operator()<Unit>(needed)` for each kind of client of the L2 slices, in their ports' order.
template <class Visit>
void visit_client_kinds(const Visit& visit) {
#define QUADRILLE_VISIT(type, frames) visit.template operator()<hw::type>(Needed::frames);
  QUADRILLE_CLIENTS(QUADRILLE_VISIT)
#undef QUADRILLE_VISIT
}

/// Does this kind of unit ask the L2 cache? It then has a `hw::MemoryPort`, whose links are those of the
/// class `client_to_l2` and back.
template <class Unit>
concept MemoryClientUnit = requires(Unit& unit) {
  { unit.memory_port() } -> std::same_as<hw::MemoryPort&>;
  { Unit::kMemoryClient } -> std::convertible_to<hw::MemoryClient>;
};

/// A port as a member of its unit: alone, absent in some machines, or one of a group with a port for each
/// unit of another kind.
template <class Port>
struct PortOf;
template <class T>
struct PortOf<hw::FifoOut<T>> {
  using Token = T;
};
template <class T>
struct PortOf<hw::FifoIn<T>> {
  using Token = T;
};
template <class T>
struct PortOf<hw::FifoInGroup<T>> {
  using Token = T;
};
template <class Port>
struct PortOf<std::unique_ptr<Port>> : PortOf<Port> {};
template <class Port>
struct PortOf<std::vector<Port>> : PortOf<Port> {};

template <class Member>
struct MemberPort;
template <class Owner, class Port>
struct MemberPort<Port Owner::*> {
  using Unit = Owner;
  using Token = typename PortOf<Port>::Token;
};

/// An output of a kind of unit and the input of another one that a link joins it to.
template <auto kOutput, auto kInput>
struct Wire {
  static constexpr auto output = kOutput;
  static constexpr auto input = kInput;
  using From = typename MemberPort<decltype(kOutput)>::Unit;
  using To = typename MemberPort<decltype(kInput)>::Unit;
  using Token = typename MemberPort<decltype(kOutput)>::Token;
  static_assert(std::is_same_v<Token, typename MemberPort<decltype(kInput)>::Token>,
                "both ends of a link carry the same tokens");
};

}  // namespace quadrille::pipeline
