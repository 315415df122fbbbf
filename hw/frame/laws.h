/// The laws between the units of the graphics pipeline, in its order (hw/base/audit.h).
#pragma once

#include "hw/base/audit.h"

#include <array>

namespace quadrille::hw::laws {

inline constexpr Law kDrawsOfFrame{"draws issued = draws of the frame", "command_processor.draws",
                                   "frame.draws"};
inline constexpr Law kDraws{"draws issued = draws retired", "command_processor.draws * partitions",
                            "rop.draws"};
inline constexpr Law kVerticesFetched{"vertices fetched = vertices shaded", "vertex_fetch.vertices",
                                      "core.vertices"};
inline constexpr Law kVerticesShaded{"vertices shaded = vertices assembled", "core.vertices",
                                     "primitive_assembly.vertices"};
inline constexpr Law kTrianglesFetched{"triangles fetched = triangles assembled", "vertex_fetch.triangles",
                                       "primitive_assembly.triangles"};
inline constexpr Law kTrianglesAssembled{"triangles assembled = triangles to clip",
                                         "primitive_assembly.triangles", "clipper.triangles"};
inline constexpr Law kTrianglesClipped{"triangles to clip = passed + cut + dropped", "clipper.triangles",
                                       "clipper.passed + clipped + rejected + not_finite"};
inline constexpr Law kPieces{"triangles and pieces passed = triangles set up", "clipper.passed + pieces",
                             "triangle_setup.triangles"};
inline constexpr Law kTrianglesSetUp{"triangles set up = kept + dropped", "triangle_setup.triangles",
                                     "triangle_setup.kept + culled + zero_area + offscreen + no_sample"};
inline constexpr Law kTrianglesWalked{"triangles kept = triangles walked", "triangle_setup.kept",
                                      "coarse_raster.triangles"};
inline constexpr Law kTiles{"tiles kept = tiles rasterised", "coarse_raster.tiles_kept", "fine_raster.tiles"};
inline constexpr Law kFragmentsCovered{"fragments covered = fragments to test", "fine_raster.fragments",
                                       "depth.fragments_in"};
inline constexpr Law kFragmentsTested{"fragments to test = killed + passed", "depth.fragments_in",
                                      "depth.early_killed + fragments_out"};
inline constexpr Law kFragmentsDeferredOrNot{"fragments covered = tested early + deferred + untested",
                                             "fine_raster.fragments",
                                             "depth.early_tested + deferred + untested"};
inline constexpr Law kFragmentsDeferred{"fragments deferred = tested late + discarded before that",
                                        "depth.deferred", "depth.late_tested + rop.late_discarded"};
inline constexpr Law kFragmentsPassed{"fragments passed = fragments packed", "depth.fragments_out",
                                      "warp_packer.fragments"};
inline constexpr Law kFragmentsPacked{"fragments packed = fragments shaded", "warp_packer.fragments",
                                      "core.fragments"};
inline constexpr Law kWarpsPacked{"warps packed = warps distributed", "warp_packer.warps",
                                  "work_distributor.fragment_warps"};
inline constexpr Law kWarpsDistributed{"warps distributed = warps retired", "work_distributor.fragment_warps",
                                       "rop.warps"};
inline constexpr Law kFragmentsShaded{"fragments shaded = fragments at the ROP", "core.fragments",
                                      "rop.fragments_in"};
inline constexpr Law kFragmentsRetired{"fragments at the ROP = discarded + killed late + written",
                                       "rop.fragments_in", "rop.discarded + late_killed + written"};
inline constexpr Law kKilledLate{"killed late, seen by ROP = seen by depth", "rop.late_killed",
                                 "depth.late_killed"};
inline constexpr Law kVertexCache{"vertex_fetch.cache: requests = hits + merged + misses",
                                  "vertex_fetch.cache.requests", "vertex_fetch.cache.hits + merged + misses"};
inline constexpr Law kTextureRequests{"texture requests sent = answered", "core.texture_instructions",
                                      "texture.requests"};
inline constexpr Law kTextureGroups{"texture groups taken = answered", "texture.groups",
                                    "texture.groups_answered"};
inline constexpr Law kTextureCache{"texture.cache: requests = hits + merged + misses",
                                   "texture.cache.requests", "texture.cache.hits + merged + misses"};
inline constexpr Law kDepthCache{"depth.cache: requests = hits + merged + misses", "depth.cache.requests",
                                 "depth.cache.hits + merged + misses"};
inline constexpr Law kColorCache{"rop.cache: requests = hits + merged + misses", "rop.cache.requests",
                                 "rop.cache.hits + merged + misses"};
inline constexpr Law kL2{"l2: requests = hits + merged + misses", "l2.requests", "l2.hits + merged + misses"};
inline constexpr Law kClientRequests{"requests of clients = requests looked up in L2",
                                     "clients.memory_reads + memory_writes", "l2.requests"};
inline constexpr Law kClientReads{"bytes asked by clients = bytes answered by L2", "clients.read_bytes",
                                  "l2.read_bytes"};
inline constexpr Law kClientWrites{"bytes written by clients = bytes taken by L2", "clients.write_bytes",
                                   "l2.write_bytes"};
inline constexpr Law kFills{"bytes filled into L2 = bytes read from memory", "l2.fill_bytes",
                            "memory.read_bytes"};
inline constexpr Law kWriteBacks{"bytes written back by L2 = bytes written to memory", "l2.writeback_bytes",
                                 "memory.write_bytes"};
inline constexpr Law kRows{"rows hit + missed + in conflict = accesses",
                           "memory.row_hits + row_misses + row_conflicts", "memory.reads + writes"};
inline constexpr Law kDataBus{"data bus: every cycle has a use",
                              "memory.bus_read + write + refresh + turnaround + activation + spacing + idle",
                              "memory.cycles"};
inline constexpr Law kScanOut{"bytes scanned out = bytes of the target", "scan_out.read_bytes",
                              "target.bytes"};
inline constexpr Law kDirtyLines{"dirty lines left in first-level caches = 0", "device_memory.dirty_lines",
                                 "none"};

inline constexpr std::array kAll{&kDrawsOfFrame,
                                 &kDraws,
                                 &kVerticesFetched,
                                 &kVerticesShaded,
                                 &kTrianglesFetched,
                                 &kTrianglesAssembled,
                                 &kTrianglesClipped,
                                 &kPieces,
                                 &kTrianglesSetUp,
                                 &kTrianglesWalked,
                                 &kTiles,
                                 &kFragmentsCovered,
                                 &kFragmentsTested,
                                 &kFragmentsDeferredOrNot,
                                 &kFragmentsDeferred,
                                 &kFragmentsPassed,
                                 &kFragmentsPacked,
                                 &kWarpsPacked,
                                 &kWarpsDistributed,
                                 &kFragmentsShaded,
                                 &kFragmentsRetired,
                                 &kKilledLate,
                                 &kVertexCache,
                                 &kTextureRequests,
                                 &kTextureGroups,
                                 &kTextureCache,
                                 &kDepthCache,
                                 &kColorCache,
                                 &kL2,
                                 &kClientRequests,
                                 &kClientReads,
                                 &kClientWrites,
                                 &kFills,
                                 &kWriteBacks,
                                 &kRows,
                                 &kDataBus,
                                 &kScanOut,
                                 &kDirtyLines};

}  // namespace quadrille::hw::laws
