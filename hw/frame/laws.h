/// The laws between the units of the graphics pipeline, in its order (hw/base/audit.h).
#pragma once

#include "hw/base/audit.h"

#include <array>

// Each law once, a law a line: name, text, and the counters of its two sides.
// clang-format off
#define QUADRILLE_LAWS(law) \
  law(kDrawsOfFrame, "draws issued + dropped = draws of the frame", \
      "command_processor.draws + draws_culled", "frame.draws") \
  law(kDraws, "draws issued = draws retired", "command_processor.draws * partitions", "rop.draws") \
  law(kVerticesFetched, "vertices fetched = vertices shaded", "vertex_fetch.vertices", "core.vertices") \
  law(kVerticesShaded, "vertices shaded = vertices assembled", \
      "core.vertices", "primitive_assembly.vertices") \
  law(kTrianglesFetched, "triangles fetched = triangles assembled", \
      "vertex_fetch.triangles", "primitive_assembly.triangles") \
  law(kTrianglesAssembled, "triangles assembled = triangles to clip", \
      "primitive_assembly.triangles", "clipper.triangles") \
  law(kTrianglesClipped, "triangles to clip = passed + cut + outlined + dropped", \
      "clipper.triangles", "clipper.passed + clipped + outlined + culled + rejected + not_finite") \
  law(kPieces, "triangles and pieces passed, to each engine = triangles set up", \
      "clipper.passed + pieces + copies", "triangle_setup.triangles") \
  law(kTrianglesSetUp, "triangles set up = kept + dropped", \
      "triangle_setup.triangles", "triangle_setup.kept + culled + zero_area + offscreen + no_sample") \
  law(kTrianglesWalked, "triangles kept = triangles walked", \
      "triangle_setup.kept", "coarse_raster.triangles") \
  law(kTiles, "tiles kept = tiles rasterised", "coarse_raster.tiles_kept", "fine_raster.tiles") \
  law(kFragmentsCovered, "fragments covered = fragments to test", \
      "fine_raster.fragments", "depth.fragments_in") \
  law(kFragmentsTested, "fragments to test = killed + passed", \
      "depth.fragments_in", "depth.early_killed + fragments_out") \
  law(kFragmentsDeferredOrNot, "fragments covered = tested early + deferred + untested", \
      "fine_raster.fragments", "depth.early_tested + deferred + untested") \
  law(kFragmentsDeferred, "fragments deferred = tested late + discarded before that", \
      "depth.deferred", "depth.late_tested + rop.late_discarded") \
  law(kFragmentsPassed, "fragments passed = samples packed", \
      "depth.fragments_out", "warp_packer.samples") \
  law(kFragmentsPacked, "fragments packed = fragments shaded", "warp_packer.fragments", "core.fragments") \
  law(kWarpsPacked, "warps packed = warps distributed", \
      "warp_packer.warps", "work_distributor.fragment_warps") \
  law(kWarpsDistributed, "warps distributed = warps retired", \
      "work_distributor.fragment_warps", "rop.warps") \
  law(kFragmentsShaded, "fragments shaded = fragments at the ROP", "core.fragments", "rop.fragments_in") \
  law(kColorsExported, "bytes of colours exported = bytes of colours at the ROP", \
      "core.exported_bytes", "rop.bytes_in") \
  law(kFragmentsRetired, "fragments at the ROP = discarded + killed late + written", \
      "rop.fragments_in", "rop.discarded + late_killed + written") \
  law(kSamplesRetired, "samples packed = discarded + killed late + written", \
      "warp_packer.samples", "rop.samples_discarded + samples_written + depth.late_killed_samples") \
  law(kNodes, "nodes of order-independent fragments = merged + lost + composed", \
      "rop.nodes", "rop.nodes_merged + nodes_lost + nodes_composed") \
  law(kKilledLate, "killed late, seen by ROP = seen by depth", "rop.late_killed", "depth.late_killed") \
  law(kVertexCache, "vertex_fetch.cache: requests = hits + merged + misses", \
      "vertex_fetch.cache.requests", "vertex_fetch.cache.hits + merged + misses") \
  law(kTextureRequests, "texture requests sent = answered", \
      "core.texture_instructions", "texture.requests") \
  law(kTextureGroups, "texture groups taken = answered", "texture.groups", "texture.groups_answered") \
  law(kTextureCache, "texture.cache: requests = hits + merged + misses", \
      "texture.cache.requests", "texture.cache.hits + merged + misses") \
  law(kStorageRequests, "storage requests sent = answered", \
      "core.storage_instructions", "load_store.requests") \
  law(kStorageGroups, "storage groups taken = answered", "load_store.groups", "load_store.groups_answered") \
  law(kStorageCache, "load_store.cache: requests = hits + merged + misses", \
      "load_store.cache.requests", "load_store.cache.hits + merged + misses") \
  law(kDepthCache, "depth.cache: requests = hits + merged + misses", \
      "depth.cache.requests", "depth.cache.hits + merged + misses") \
  law(kColorCache, "rop.cache: requests = hits + merged + misses", \
      "rop.cache.requests", "rop.cache.hits + merged + misses") \
  law(kL2, "l2: requests = hits + merged + misses", "l2.requests", "l2.hits + merged + misses") \
  law(kClientRequests, "requests of clients = requests looked up in L2", \
      "clients.memory_reads + memory_writes", "l2.requests") \
  law(kClientReads, "bytes asked by clients = bytes answered by L2", "clients.read_bytes", "l2.read_bytes") \
  law(kClientWrites, "bytes written by clients = bytes taken by L2", \
      "clients.write_bytes", "l2.write_bytes") \
  law(kSurfaceBytes, "bytes of depths and colours as they are stored = bytes of them taken by L2", \
      "depth, rop: encoded_write_bytes, or write_bytes where nothing is encoded", "l2.surface_write_bytes") \
  law(kFills, "bytes filled into L2 = bytes read from memory", "l2.fill_bytes", "memory.read_bytes") \
  law(kWriteBacks, "bytes written back by L2 = bytes written to memory", \
      "l2.writeback_bytes", "memory.write_bytes") \
  law(kRows, "rows hit + missed + in conflict = accesses", \
      "memory.row_hits + row_misses + row_conflicts", "memory.reads + writes") \
  law(kDataBus, "data bus: every cycle has a use", \
      "memory.bus_read + write + refresh + turnaround + activation + spacing + idle", "memory.cycles") \
  law(kScanOut, "bytes scanned out = bytes of the target", "scan_out.read_bytes", "target.bytes") \
  law(kDirtyLines, "dirty lines left in first-level caches = 0", "device_memory.dirty_lines", "none")
// clang-format on

namespace quadrille::hw::laws {

#define QUADRILLE_LAW(name, text, left, right) inline constexpr Law name{text, left, right};
QUADRILLE_LAWS(QUADRILLE_LAW)
#undef QUADRILLE_LAW

/// In the order of the pipeline.
#define QUADRILLE_LAW(name, text, left, right) &name,
inline constexpr std::array kAll{QUADRILLE_LAWS(QUADRILLE_LAW)};
#undef QUADRILLE_LAW

}  // namespace quadrille::hw::laws
