/// The machine: elaborates the units and links that a configuration and a frame ask for, runs them, and keeps
/// them for the figures.
///
/// One machine per process: SystemC elaborates once. Names of units are their paths in figures
/// (`gpu.core_0.texture`).
#pragma once

#include "hw/base/driver.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/machine/machine_config.h"

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

namespace quadrille::pipeline {

enum class DriverKind : std::uint8_t { kDispatcher, kNative };

struct MachineOptions {
  DriverKind driver = DriverKind::kDispatcher;
  hw::Tick window = 0;  ///< extra look-ahead of the dispatcher; 0 is exact
  /// seed: in which order modules are created and handed to the driver; figures must not depend on it
  std::uint64_t module_order = 0;
  bool leave_out = true;  ///< do not build what the frame does not need
  /// kinds of units ("texture"), and how many times as fast as the machine has them they do all that they do:
  /// a clock of their own, without synchronisers (docs/why.md)
  std::vector<std::pair<std::string, double>> faster = {};
  /// add the units to this driver instead of an own one; its owner runs it
  hw::Driver* external_driver = nullptr;
};

class Machine {
 public:
  Machine(const MachineConfig& config, DeviceFrame& frame, const MachineOptions& options);
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// Runs the frame to its end. Throws `UserError` with the deadlock report when it cannot progress.
  void run(const hw::RunLimits& limits);

  [[nodiscard]] const std::vector<hw::Unit*>& units() const { return driver_->units(); }
  [[nodiscard]] const std::vector<std::unique_ptr<hw::FifoBase>>& links() const { return links_; }
  /// By link: its key in a machine file ("link.coarse_to_fine").
  [[nodiscard]] const std::vector<std::string>& link_keys() const { return link_keys_; }
  /// The units of a kind, by their numbers; none where they were left out.
  template <class Unit>
  [[nodiscard]] const std::vector<Unit*>& all() const {
    return std::get<std::vector<Unit*>>(by_kind_);
  }
  /// Of a kind that stands once.
  template <class Unit>
  [[nodiscard]] Unit& one() const {
    static_assert(UnitKind<Unit>::stands == Stands::kOnce);
    return *all<Unit>().front();
  }
  [[nodiscard]] const hw::Driver& driver() const { return *driver_; }
  [[nodiscard]] const hw::Clock& clock() const { return clock_; }
  [[nodiscard]] const MachineConfig& config() const { return config_; }
  [[nodiscard]] const std::vector<LeftOut>& left_out() const { return left_out_; }
  /// Tick at which the last image was read: the end of the frame.
  [[nodiscard]] hw::Tick end() const { return one<hw::CommandProcessor>().end(); }
  /// Last tick at which anything moved: write-backs go on behind the frame's end.
  [[nodiscard]] hw::Tick quiet_end() const;

 private:
  /// What tokens name: the bulk behind them.
  struct Stores {
    explicit Stores(const MachineConfig& config);
    hw::Store<hw::BatchSlot> batches;
    std::vector<std::unique_ptr<hw::Store<hw::ClippedPiece>>>
        pieces;                                                 ///< by raster engine, and of it by front end
    std::vector<std::unique_ptr<hw::TriangleStore>> triangles;  ///< by raster engine
    std::vector<std::unique_ptr<hw::WalkedStore>> walked;       ///< by raster engine
    std::vector<std::unique_ptr<hw::WarpStore>> warps;          ///< by partition
    std::vector<std::unique_ptr<hw::Store<hw::CoreSlot>>> cores;  ///< by core
  };
  class Maker;
  class Wiring;

  void check_registers() const;
  void make_faster(const std::vector<std::pair<std::string, double>>& faster);
  /// The clock of a kind of units: that of its domain, or a faster one.
  [[nodiscard]] const hw::Clock& clock_of_kind(std::string_view kind, const hw::Clock& domain) const;
  void leave_out(bool wanted);
  void list_clients();
  void create_units(std::uint64_t order);
  [[nodiscard]] int count(Stands stands) const;
  /// Name of unit number `i` of a kind.
  [[nodiscard]] std::string name_of(std::string_view kind, Stands stands, int i) const;
  /// Units of such a kind are built for this frame.
  [[nodiscard]] bool builds(Needed needed) const;

  const MachineConfig& config_;
  DeviceFrame& frame_;
  hw::Clock clock_, memory_clock_;
  std::map<std::string, hw::Clock, std::less<>> faster_;  ///< by kind of unit
  hw::QuietLog quiet_;
  std::vector<LeftOut> left_out_;
  /// texture and load-store units are built; depth units are linked to memory
  bool textured_ = true, stored_ = true, depth_memory_ = true;
  /// of the L2 slices: names of units, in the order of their ports
  std::vector<hw::L2Slice::Client> clients_;
  std::unique_ptr<hw::Driver> own_driver_;
  hw::Driver* driver_ = nullptr;
  Stores stores_;
#define QUADRILLE_UNITS_OF(name, type, how_often, frames) std::vector<type*>,
  std::tuple<QUADRILLE_UNITS(QUADRILLE_UNITS_OF) std::monostate> by_kind_;
#undef QUADRILLE_UNITS_OF
  std::vector<std::unique_ptr<hw::Unit>> owned_;  ///< in the order in which they were made
  std::vector<std::unique_ptr<hw::FifoBase>> links_;
  std::vector<std::string> link_keys_;
};

}  // namespace quadrille::pipeline
