#include "pipeline/machine.h"

#include "hw/base/dispatcher.h"
#include "hw/base/native_driver.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace quadrille::pipeline {

namespace {

hw::Clock clock_of(double mhz) { return hw::Clock(std::max<std::int64_t>(1, std::llround(mhz * 1e6))); }

std::unique_ptr<hw::Driver> make_driver(const MachineOptions& options) {
  switch (options.driver) {
    case DriverKind::kDispatcher: return std::make_unique<hw::Dispatcher>("dispatcher", options.window);
    case DriverKind::kNative: return std::make_unique<hw::NativeDriver>("native_driver");
  }
  return nullptr;
}

}  // namespace

Machine::Machine(const MachineConfig& config, DeviceFrame& frame, const MachineOptions& options)
    : config_(config),
      frame_(frame),
      clock_(clock_of(config.gpu.clock_mhz)),
      memory_clock_(clock_of(config.gpu.memory_mhz)),
      left_out_(frame.left_out) {
  config.check();
  check_registers();
  if (options.external_driver == nullptr) own_driver_ = make_driver(options);
  driver_ = options.external_driver != nullptr ? options.external_driver : own_driver_.get();
  batches_ = std::make_unique<hw::Store<hw::BatchSlot>>(static_cast<std::size_t>(config.vertex_fetch.batch_slots.value()));
  // One piece being written and one being read beyond what the link holds.
  pieces_ = std::make_unique<hw::Store<hw::ClippedPiece>>(static_cast<std::size_t>(config.link.clipper_to_setup.depth.value()) + 2);
  triangles_ = std::make_unique<hw::TriangleStore>(static_cast<std::size_t>(config.triangle_setup.triangle_slots.value()) + 1);
  create_units(options);
  wire();
}

// SystemC searches for what is destroyed: for a port from the latest to the first, for a link from the first object on, and puts the last one in its place. In
// other orders than these (ports backwards; two links, in whose places come SystemC's process and the last link, then backwards from that) the search takes
// longer than the run of a wide machine.
Machine::~Machine() {
  const auto destroy_last_first = [](auto& made) {
    while (!made.empty()) made.pop_back();
  };
  if (links_.size() > 2) std::rotate(links_.begin(), links_.begin() + 2, links_.end());
  destroy_last_first(links_);
  destroy_last_first(channels_);
  destroy_last_first(slices_);
  destroy_last_first(cores_);
  destroy_last_first(partitions_);
}

void Machine::check_registers() const {
  int vertex = 0, fragment = 0;
  for (const hw::DrawState& draw : frame_.frame.draws) {
    vertex = std::max(vertex, draw.vertex_program->num_regs);
    fragment = std::max(fragment, draw.fragment_program->num_regs);
  }
  if (vertex + fragment > config_.core.register_rows) {
    throw user_error(
        "machine: core.register_rows ({}) cannot hold one vertex warp ({} registers) and one fragment warp ({}); at least {} are needed",
        config_.core.register_rows.value(), vertex, fragment, vertex + fragment);
  }
}

void Machine::create_units(const MachineOptions& options) {
  const hw::Frame& frame = frame_.frame;
  models::DeviceMemory& memory = frame_.memory;
  const int cores = config_.gpu.cores, partitions = config_.gpu.partitions, channels = config_.gpu.channels;
  const bool textured = frame_.reads_textures() || !options.leave_out;
  if (!textured)
    left_out_.push_back({"texture units", "no program of a draw reads a texture", fmt::format("{} units and their caches", cores)});
  const bool depth_memory = frame_.tests_depth() || !options.leave_out;
  if (!depth_memory) {
    left_out_.push_back({"depth units' links to memory", "no draw tests depth",
                         fmt::format("{} links, and their places in the arbiters of {} L2 slices", 2 * partitions * channels, channels)});
  }
  if (!frame_.blends()) left_out_.push_back({"blending", "no draw combines with the old colour", "reading colours back"});
  clients_ = {{"vertex_fetch", hw::MemoryClient::kVertexFetch}};
  for (int c = 0; textured && c < cores; ++c) clients_.push_back({fmt::format("texture_{}", c), hw::MemoryClient::kTexture});
  for (int p = 0; p < partitions; ++p) {
    if (depth_memory) clients_.push_back({fmt::format("depth_{}", p), hw::MemoryClient::kDepth});
    clients_.push_back({fmt::format("rop_{}", p), hw::MemoryClient::kColor});
  }
  clients_.push_back({"scan_out", hw::MemoryClient::kScanOut});
  partitions_.resize(static_cast<std::size_t>(partitions));
  cores_.resize(static_cast<std::size_t>(cores));
  slices_.resize(static_cast<std::size_t>(channels));
  channels_.resize(static_cast<std::size_t>(channels));
  std::vector<hw::Store<hw::WarpSlot>*> warp_stores;
  for (Partition& p : partitions_) {
    p.warps = std::make_unique<hw::Store<hw::WarpSlot>>(static_cast<std::size_t>(config_.warp_packer.warp_slots.value()));
    warp_stores.push_back(p.warps.get());
  }

  std::vector<std::function<hw::Unit*()>> makers;
  const auto make = [&makers](auto& place, auto build) {
    makers.push_back([&place, build] {
      place = build();
      return place.get();
    });
  };
  make(command_processor_, [&, partitions] {
    return std::make_unique<hw::CommandProcessor>("command_processor", config_.command_processor, clock_, frame, partitions, quiet_);
  });
  make(vertex_fetch_, [&, channels] {
    return std::make_unique<hw::VertexFetch>("vertex_fetch", config_.vertex_fetch, clock_, frame, memory, *batches_, channels);
  });
  make(assembly_, [&, cores] {
    return std::make_unique<hw::PrimitiveAssembly>("primitive_assembly", config_.primitive_assembly, clock_, *batches_, cores);
  });
  make(clipper_, [&] { return std::make_unique<hw::Clipper>("clipper", config_.clipper, clock_, frame, *batches_, *pieces_); });
  make(setup_, [&, partitions] {
    return std::make_unique<hw::TriangleSetupUnit>("triangle_setup", config_.triangle_setup, clock_, frame, *batches_, *pieces_,
                                                   *triangles_, partitions);
  });
  make(coarse_, [&, partitions] {
    return std::make_unique<hw::CoarseRaster>("coarse_raster", config_.coarse_raster, clock_, frame, *triangles_, partitions);
  });
  make(fine_,
       [&, partitions] { return std::make_unique<hw::FineRaster>("fine_raster", config_.fine_raster, clock_, *triangles_, partitions); });
  make(distributor_, [&, partitions, cores] {
    return std::make_unique<hw::WorkDistributor>("work_distributor", config_.work_distributor, clock_, partitions, cores);
  });
  make(scan_out_, [&, channels] { return std::make_unique<hw::ScanOut>("scan_out", config_.scan_out, clock_, frame, memory, channels); });
  for (int p = 0; p < partitions; ++p) {
    Partition& part = partitions_[static_cast<std::size_t>(p)];
    const auto depth_owner = static_cast<models::DeviceMemory::Owner>(1 + 2 * p);
    const auto color_owner = static_cast<models::DeviceMemory::Owner>(2 + 2 * p);
    make(part.depth, [&, p, depth_owner, partitions, slices = depth_memory ? channels : 0] {
      return std::make_unique<hw::DepthUnit>(fmt::format("depth_{}", p).c_str(), config_.depth, clock_, frame, memory, depth_owner,
                                             *triangles_, *part.warps, p, partitions, slices);
    });
    make(part.packer, [&, p] {
      return std::make_unique<hw::WarpPacker>(fmt::format("warp_packer_{}", p).c_str(), config_.warp_packer, clock_, *part.warps, p);
    });
    make(part.rop, [&, p, color_owner, partitions, cores, channels] {
      return std::make_unique<hw::Rop>(fmt::format("rop_{}", p).c_str(), config_.rop, clock_, frame, memory, color_owner, *part.warps, p,
                                       partitions, cores, channels);
    });
  }
  for (int c = 0; c < cores; ++c) {
    Core& core = cores_[static_cast<std::size_t>(c)];
    core.slots = std::make_unique<hw::Store<hw::CoreSlot>>(static_cast<std::size_t>(config_.core.warp_slots.value()));
    make(core.core, [&, c, textured, warp_stores] {
      return std::make_unique<hw::ShaderCore>(fmt::format("core_{}", c).c_str(), config_.core, clock_, frame, *core.slots, *batches_,
                                              warp_stores, *triangles_, textured);
    });
    if (textured) {
      make(core.texture, [&, c, channels] {
        return std::make_unique<hw::TextureUnit>(fmt::format("texture_{}", c).c_str(), config_.texture, clock_, frame, memory, *core.slots,
                                                 channels);
      });
    }
  }
  for (int i = 0; i < channels; ++i) {
    const auto k = static_cast<std::size_t>(i);
    make(slices_[k], [&, i, channels] {
      return std::make_unique<hw::L2Slice>(fmt::format("l2_{}", i).c_str(), config_.l2, clock_, clients_, channels);
    });
    make(channels_[k], [&, i, channels] {
      return std::make_unique<hw::MemoryChannel>(fmt::format("memory_{}", i).c_str(), config_.memory, memory_clock_, channels);
    });
  }
  if (options.module_order != 0) std::shuffle(makers.begin(), makers.end(), std::mt19937_64(options.module_order));
  for (const auto& maker : makers) driver_->add(*maker());
}

template <class T, class Out, class In>
void Machine::connect(Out& out, In& in, const LinkParams& params, const std::string& name, int path_clk) {
  hw::LinkSpec spec = params.spec();
  // A longer way holds as many tokens more as are on it.
  spec.latency += path_clk;
  spec.depth += spec.width * path_clk;
  auto link = std::make_unique<hw::Fifo<T>>(name.c_str(), spec);
  out.bind(*link);
  in.bind(*link);
  links_.push_back(std::move(link));
  const auto group = std::ranges::find_if(config_.groups(), [&](const auto& g) { return g.second == &params; });
  QUADRILLE_CHECK(group != config_.groups().end(), "link {} has parameters outside the machine", name);
  link_keys_.push_back(group->first);
}

void Machine::wire() {
  wire_geometry();
  for (std::size_t p = 0; p < partitions_.size(); ++p) wire_partition(p);
  for (std::size_t c = 0; c < cores_.size(); ++c) wire_core(c);
  wire_memory();
  // No draw in flight makes the drawing units idle; scan-out and memory may still have work.
  for (hw::Unit* unit : driver_->units()) unit->set_quiet_log(quiet_);
}

void Machine::wire_geometry() {
  const Links& l = config_.link;
  connect<hw::DrawToken>(command_processor_->draw_out, vertex_fetch_->draw_in, l.command_to_fetch, "command_to_fetch");
  connect<hw::WarpToken>(vertex_fetch_->warp_out, distributor_->vertex_in, l.fetch_to_distributor, "fetch_to_distributor");
  connect<hw::BatchToken>(vertex_fetch_->batch_out, assembly_->batch_in, l.fetch_to_assembly, "fetch_to_assembly");
  connect<hw::PrimitiveToken>(assembly_->primitive_out, clipper_->primitive_in, l.assembly_to_clipper, "assembly_to_clipper");
  connect<hw::ClippedToken>(clipper_->clipped_out, setup_->clipped_in, l.clipper_to_setup, "clipper_to_setup");
  connect<hw::ReleaseToken>(assembly_->load_out, distributor_->load_in[partitions_.size()], l.assembly_to_distributor,
                            "assembly_to_distributor");
  connect<hw::ReleaseToken>(setup_->release_out, vertex_fetch_->release_in, l.setup_to_fetch, "setup_to_fetch");
  connect<hw::TriangleToken>(setup_->triangle_out, coarse_->triangle_in, l.setup_to_coarse, "setup_to_coarse");
  connect<hw::TileToken>(coarse_->tile_out, fine_->tile_in, l.coarse_to_fine, "coarse_to_fine");
  connect<hw::ScanToken>(command_processor_->scan_out, scan_out_->scan_in, l.command_to_scan, "command_to_scan");
  connect<hw::ReleaseToken>(scan_out_->done_out, command_processor_->scan_done_in, l.scan_to_command, "scan_to_command");
}

void Machine::wire_partition(std::size_t p) {
  const Links& l = config_.link;
  Partition& part = partitions_[p];
  const auto name = [p](const char* link) { return fmt::format("{}_{}", link, p); };
  connect<hw::CoverageToken>(*fine_->coverage_out[p], part.depth->coverage_in, l.fine_to_depth, name("fine_to_depth"));
  connect<hw::HiZToken>(part.depth->hiz_out, coarse_->hiz_in[p], l.depth_to_coarse, name("depth_to_coarse"));
  connect<hw::CoverageToken>(part.depth->coverage_out, part.packer->coverage_in, l.depth_to_packer, name("depth_to_packer"));
  connect<hw::WarpToken>(part.packer->warp_out, distributor_->fragment_in[p], l.packer_to_distributor, name("packer_to_distributor"));
  connect<hw::OrderToken>(part.packer->order_out, part.rop->order_in, l.packer_to_rop, name("packer_to_rop"));
  connect<hw::ReleaseToken>(part.rop->release_out, part.packer->release_in, l.rop_to_packer, name("rop_to_packer"));
  connect<hw::ReleaseToken>(part.rop->load_out, distributor_->load_in[p], l.rop_to_distributor, name("rop_to_distributor"));
  connect<hw::LateToken>(part.rop->late_out, part.depth->late_in, l.rop_to_depth, name("rop_to_depth"));
  connect<hw::LateToken>(part.depth->late_out, part.rop->late_in, l.depth_to_rop, name("depth_to_rop"));
  connect<hw::ReleaseToken>(part.rop->sync_out, setup_->sync_in[p], l.rop_to_setup, name("rop_to_setup"));
  connect<hw::RetireToken>(part.rop->retire_out, command_processor_->retire_in[p], l.rop_to_command, name("rop_to_command"));
}

void Machine::wire_core(std::size_t c) {
  const Links& l = config_.link;
  Core& core = cores_[c];
  const auto name = [c](const char* link) { return fmt::format("{}_{}", link, c); };
  connect<hw::WarpToken>(*distributor_->vertex_out[c], core.core->vertex_in, l.distributor_to_core, name("distributor_to_core_vertex"));
  connect<hw::WarpToken>(*distributor_->fragment_out[c], core.core->fragment_in, l.distributor_to_core,
                         name("distributor_to_core_fragment"));
  connect<hw::VertexDoneToken>(core.core->vertex_out, assembly_->done_in[c], l.core_to_assembly, name("core_to_assembly"));
  for (std::size_t p = 0; p < partitions_.size(); ++p) {
    connect<hw::FragmentDoneToken>(*core.core->fragment_out[p], partitions_[p].rop->done_in[c], l.core_to_rop,
                                   fmt::format("core_to_rop_{}_{}", c, p));
  }
  if (!core.texture) return;
  connect<hw::TextureToken>(*core.core->texture_out, core.texture->request_in, l.core_to_texture, name("core_to_texture"));
  connect<hw::TextureToken>(core.texture->response_out, *core.core->texture_in, l.texture_to_core, name("texture_to_core"));
}

void Machine::attach_client(const hw::Unit& client_unit, hw::MemoryPort& port) {
  const auto found = std::ranges::find(clients_, std::string_view(client_unit.name()), &hw::L2Slice::Client::name);
  QUADRILLE_CHECK(found != clients_.end(), "{} is no client of the L2 cache", client_unit.name());
  const auto client = static_cast<std::size_t>(found - clients_.begin());
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    connect<hw::MemoryRequest>(*port.request_out[i], slices_[i]->request_in[client], config_.link.client_to_l2,
                               fmt::format("{}_to_l2_{}", client_unit.name(), i));
    connect<hw::MemoryResponse>(*slices_[i]->response_out[client], port.response_in[i], config_.link.l2_to_client,
                                fmt::format("l2_{}_to_{}", i, client_unit.name()));
  }
}

void Machine::wire_memory() {
  attach_client(*vertex_fetch_, vertex_fetch_->memory_port());
  for (Core& core : cores_) {
    if (core.texture) attach_client(*core.texture, core.texture->memory_port());
  }
  for (Partition& p : partitions_) {
    if (p.depth->memory_port().slices() > 0) attach_client(*p.depth, p.depth->memory_port());
    attach_client(*p.rop, p.rop->memory_port());
  }
  attach_client(*scan_out_, scan_out_->memory_port());
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    connect<hw::MemoryRequest>(slices_[i]->memory_out, channels_[i]->request_in, config_.link.l2_to_memory,
                               fmt::format("l2_to_memory_{}", i));
    connect<hw::MemoryResponse>(channels_[i]->response_out, slices_[i]->fill_in, config_.link.memory_to_l2,
                                fmt::format("memory_to_l2_{}", i), config_.memory.path_clk);
  }
}

void Machine::run(const hw::RunLimits& limits) {
  const hw::RunEnd reason = driver_->run(limits);
  if (!command_processor_->finished()) {
    if (reason == hw::RunEnd::kTimeLimit) {
      throw UserError(fmt::format("the limit of {} cycles was reached before the frame was done; {}", clock_.edges_before(limits.max_time),
                                  hw::waiting_report(driver_->units(), limits.max_time)));
    }
    // Tables of who waits for whom are the only errors of many lines.
    throw UserError("the machine cannot progress: " + hw::deadlock_report(driver_->units(), quiet_end()));
  }
  hw::close_accounts(driver_->units(), end());
}

hw::Tick Machine::quiet_end() const {
  hw::Tick last = 0;
  for (const auto& link : links_) last = std::max({last, link->last_push(), link->last_pop()});
  return last;
}

}  // namespace quadrille::pipeline
