#include "pipeline/machine/machine.h"

#include "hw/base/dispatcher.h"
#include "hw/base/native_driver.h"
#include "pipeline/machine/machine_units.h"
#include "pipeline/machine/machine_wiring.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>

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
      left_out_(frame.left_out),
      stores_(config) {
  config.check();
  check_registers();
  if (options.external_driver == nullptr) own_driver_ = make_driver(options);
  driver_ = options.external_driver != nullptr ? options.external_driver : own_driver_.get();
  make_faster(options.faster);
  leave_out(options.leave_out);
  list_clients();
  create_units(options.module_order);
  Wiring(*this).wire();
  // No draw in flight makes the drawing units idle; scan-out and memory may still have work.
  for (hw::Unit* unit : driver_->units()) unit->set_quiet_log(quiet_);
}

// Beside a faster unit all clocks have cycles of equal length: then nothing has to wait for an edge.
void Machine::make_faster(const std::vector<std::pair<std::string, double>>& faster) {
  if (faster.empty()) return;
  clock_ = clock_.faster(1);
  memory_clock_ = memory_clock_.faster(1);
  for (const auto& [kind, times] : faster)
    faster_.insert_or_assign(
        kind, (kind == UnitKind<hw::MemoryChannel>::name ? memory_clock_ : clock_).faster(times));
}

const hw::Clock& Machine::clock_of_kind(std::string_view kind, const hw::Clock& domain) const {
  const auto found = faster_.find(kind);
  return found == faster_.end() ? domain : found->second;
}

// SystemC searches for what is destroyed: for a port from the latest to the first, for a link from the first
// object on, and puts the last one in its place. In other orders than these (ports backwards; two links, in
// whose places come SystemC's process and the last link, then backwards from that) the search takes longer
// than the run of a wide machine.
Machine::~Machine() {
  const auto destroy_last_first = [](auto& made) {
    while (!made.empty()) made.pop_back();
  };
  if (links_.size() > 2) std::rotate(links_.begin(), links_.begin() + 2, links_.end());
  destroy_last_first(links_);
  destroy_last_first(owned_);
}

// One piece being written and one being read beyond what the link holds.
Machine::Stores::Stores(const MachineConfig& config)
    : batches(static_cast<std::size_t>(config.vertex_fetch.batch_slots.value() * config.gpu.front_ends)) {
  for (int e = 0; e < config.gpu.engines; ++e) {
    for (int f = 0; f < config.gpu.front_ends; ++f)
      pieces.push_back(std::make_unique<hw::Store<hw::ClippedPiece>>(
          static_cast<std::size_t>(config.link.clipper_to_setup.depth.value()) + 2));
    triangles.push_back(std::make_unique<hw::TriangleStore>(
        static_cast<std::size_t>(config.triangle_setup.triangle_slots.value()) + 1));
    walked.push_back(std::make_unique<hw::WalkedStore>(
        static_cast<std::size_t>(config.link.coarse_to_fine.depth.value())));
  }
  for (int p = 0; p < config.gpu.partitions; ++p)
    warps.push_back(
        std::make_unique<hw::WarpStore>(static_cast<std::size_t>(config.warp_packer.warp_slots.value())));
  for (int c = 0; c < config.gpu.cores; ++c)
    cores.push_back(
        std::make_unique<hw::Store<hw::CoreSlot>>(static_cast<std::size_t>(config.core.warp_slots.value())));
}

void Machine::check_registers() const {
  int vertex = 0, fragment = 0;
  for (const hw::DrawState& draw : frame_.frame.draws) {
    vertex = std::max(vertex, draw.vertex.program->num_regs);
    fragment = std::max(fragment, draw.fragment.program->num_regs);
  }
  if (vertex + fragment > config_.core.register_rows) {
    throw user_error(
        "machine: core.register_rows ({}) cannot hold one vertex warp ({} registers) and one fragment warp "
        "({}); at least {} are needed",
        config_.core.register_rows.value(), vertex, fragment, vertex + fragment);
  }
}

void Machine::leave_out(bool wanted) {
  const int cores = config_.gpu.cores, partitions = config_.gpu.partitions, channels = config_.gpu.channels;
  textured_ = frame_.reads_textures() || !wanted;
  if (!textured_)
    left_out_.push_back({"texture units", "no program of a draw reads a texture",
                         fmt::format("{} units and their caches", cores)});
  stored_ = frame_.uses_storage() || !wanted;
  if (!stored_)
    left_out_.push_back({"load-store units", "no program of a draw has a storage buffer",
                         fmt::format("{} units and their caches", cores)});
  depth_memory_ = frame_.keeps_depth() || !wanted;
  if (!depth_memory_) {
    left_out_.push_back({"depth units' links to memory", "no draw tests depth",
                         fmt::format("{} links, and their places in the arbiters of {} L2 slices",
                                     2 * partitions * channels, channels)});
  }
  if (!frame_.blends())
    left_out_.push_back({"blending", "no draw combines with the old colour", "reading colours back"});
}

void Machine::list_clients() {
  struct ClientKind {
    std::string_view name;
    Stands stands;
    Needed needed;
    hw::MemoryClient client;
  };
  std::vector<ClientKind> kinds;
  visit_client_kinds([&]<class Unit>(Needed needed) {
    static_assert(MemoryClientUnit<Unit>);
    kinds.push_back({UnitKind<Unit>::name, UnitKind<Unit>::stands, needed, Unit::kMemoryClient});
  });
  for (auto first = kinds.begin(), last = first; first != kinds.end(); first = last) {
    last = std::find_if(first, kinds.end(), [&](const ClientKind& k) { return k.stands != first->stands; });
    for (int i = 0; i < count(first->stands); ++i)
      for (auto k = first; k != last; ++k)
        if (builds(k->needed)) clients_.push_back({name_of(k->name, k->stands, i), k->client});
  }
}

int Machine::count(Stands stands) const {
  switch (stands) {
    case Stands::kOnce: return 1;
    case Stands::kFrontEnd: return config_.gpu.front_ends;
    case Stands::kEngine: return config_.gpu.engines;
    case Stands::kPartition: return config_.gpu.partitions;
    case Stands::kCore: return config_.gpu.cores;
    case Stands::kChannel: return config_.gpu.channels;
  }
  return 0;
}

std::string Machine::name_of(std::string_view kind, Stands stands, int i) const {
  const bool alone = stands == Stands::kOnce || (stands == Stands::kEngine && config_.gpu.engines == 1) ||
                     (stands == Stands::kFrontEnd && config_.gpu.front_ends == 1);
  return alone ? std::string(kind) : fmt::format("{}_{}", kind, i);
}

bool Machine::builds(Needed needed) const {
  switch (needed) {
    case Needed::kByAllFrames: return true;
    case Needed::kByFramesThatReadTextures: return textured_;
    case Needed::kByFramesWithStorage: return stored_;
    case Needed::kByFramesThatKeepDepths: return depth_memory_;
  }
  return true;
}

void Machine::create_units(std::uint64_t order) {
  const Maker maker(*this);
  std::vector<std::function<std::unique_ptr<hw::Unit>()>> makers;
  for (const Stands stands : {Stands::kOnce, Stands::kFrontEnd, Stands::kEngine, Stands::kPartition,
                              Stands::kCore, Stands::kChannel}) {
    for (int i = 0; i < count(stands); ++i) {
      visit_unit_kinds([&]<class Unit>() {
        if (UnitKind<Unit>::stands != stands || !builds(UnitKind<Unit>::needed)) return;
        std::vector<Unit*>& of_kind = std::get<std::vector<Unit*>>(by_kind_);
        of_kind.push_back(nullptr);
        makers.emplace_back([this, &maker, &of_kind, i, stands] {
          std::unique_ptr<Unit> made =
              maker.make(std::type_identity<Unit>(), name_of(UnitKind<Unit>::name, stands, i).c_str(), i);
          of_kind[static_cast<std::size_t>(i)] = made.get();
          return made;
        });
      });
    }
  }
  if (order != 0) std::shuffle(makers.begin(), makers.end(), std::mt19937_64(order));
  for (const auto& make : makers) {
    owned_.push_back(make());
    driver_->add(*owned_.back());
  }
}

void Machine::run(const hw::RunLimits& limits) {
  const hw::RunEnd reason = driver_->run(limits);
  if (!one<hw::CommandProcessor>().finished()) {
    if (reason == hw::RunEnd::kTimeLimit) {
      throw UserError(fmt::format("the limit of {} cycles was reached before the frame was done; {}",
                                  clock_.edges_before(limits.max_time),
                                  hw::waiting_report(driver_->units(), limits.max_time)));
    }
    // Tables of who waits for whom are the only errors of many lines.
    throw UserError("the machine cannot progress: " + hw::deadlock_report(driver_->units(), quiet_end()));
  }
  hw::close_accounts(driver_->units(), end());
}

hw::Tick Machine::quiet_end() const {
  hw::Tick last = std::max<hw::Tick>(0, end());
  for (const auto& link : links_) last = std::max({last, link->last_push(), link->last_pop()});
  return last;
}

}  // namespace quadrille::pipeline
