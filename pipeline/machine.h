/// The machine: elaborates the units and links that a configuration and a frame ask for, runs them, and keeps them for the figures.
///
/// One machine per process: SystemC elaborates once. Names of units are their paths in figures (`gpu.core_0.texture`).
#pragma once

#include "hw/base/driver.h"
#include "pipeline/frame_builder.h"
#include "pipeline/machine_config.h"

#include <memory>
#include <string>
#include <vector>

namespace quadrille::pipeline {

enum class DriverKind : std::uint8_t { kDispatcher, kNative };

struct MachineOptions {
  DriverKind driver = DriverKind::kDispatcher;
  hw::Tick window = 0;             ///< extra look-ahead of the dispatcher; 0 is exact
  std::uint64_t module_order = 0;  ///< seed: in which order modules are created and handed to the driver; figures must not depend on it
  bool leave_out = true;           ///< do not build what the frame does not need
  hw::Driver* external_driver = nullptr;  ///< add the units to this driver instead of an own one; its owner runs it
};

class Machine {
 public:
  Machine(const MachineConfig& config, DeviceFrame& frame, const MachineOptions& options);
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// Runs the frame to its end. Throws `UserError` with the deadlock report when it cannot progress.
  void run(const hw::RunLimits& limits);

  struct Partition {
    std::unique_ptr<hw::DepthUnit> depth;
    std::unique_ptr<hw::WarpPacker> packer;
    std::unique_ptr<hw::Rop> rop;
    std::unique_ptr<hw::Store<hw::WarpSlot>> warps;
  };
  struct Core {
    std::unique_ptr<hw::ShaderCore> core;
    std::unique_ptr<hw::TextureUnit> texture;  ///< null when left out
    std::unique_ptr<hw::Store<hw::CoreSlot>> slots;
  };
  [[nodiscard]] const std::vector<hw::Unit*>& units() const { return driver_->units(); }
  [[nodiscard]] const std::vector<std::unique_ptr<hw::FifoBase>>& links() const { return links_; }
  /// By link: its key in a machine file ("link.coarse_to_fine").
  [[nodiscard]] const std::vector<std::string>& link_keys() const { return link_keys_; }
  [[nodiscard]] const hw::CommandProcessor& command_processor() const { return *command_processor_; }
  [[nodiscard]] const hw::VertexFetch& vertex_fetch() const { return *vertex_fetch_; }
  [[nodiscard]] const hw::PrimitiveAssembly& assembly() const { return *assembly_; }
  [[nodiscard]] const hw::Clipper& clipper() const { return *clipper_; }
  [[nodiscard]] const hw::TriangleSetupUnit& setup() const { return *setup_; }
  [[nodiscard]] const hw::CoarseRaster& coarse() const { return *coarse_; }
  [[nodiscard]] const hw::FineRaster& fine() const { return *fine_; }
  [[nodiscard]] const hw::WorkDistributor& distributor() const { return *distributor_; }
  [[nodiscard]] const hw::ScanOut& scan_out() const { return *scan_out_; }
  [[nodiscard]] const std::vector<Partition>& partitions() const { return partitions_; }
  [[nodiscard]] const std::vector<Core>& cores() const { return cores_; }
  [[nodiscard]] const std::vector<std::unique_ptr<hw::L2Slice>>& slices() const { return slices_; }
  [[nodiscard]] const std::vector<std::unique_ptr<hw::MemoryChannel>>& channels() const { return channels_; }
  [[nodiscard]] const hw::Driver& driver() const { return *driver_; }
  [[nodiscard]] const hw::Clock& clock() const { return clock_; }
  [[nodiscard]] const MachineConfig& config() const { return config_; }
  [[nodiscard]] const std::vector<LeftOut>& left_out() const { return left_out_; }
  /// Tick at which the last image was read: the end of the frame.
  [[nodiscard]] hw::Tick end() const { return command_processor_->end(); }

 private:
  void check_registers() const;
  /// Last tick at which anything moved.
  [[nodiscard]] hw::Tick quiet_end() const;
  void create_units(const MachineOptions& options);
  void wire();
  void wire_geometry();
  void wire_partition(std::size_t p);
  void wire_core(std::size_t c);
  void wire_memory();
  void attach_client(const hw::Unit& client_unit, hw::MemoryPort& port);
  template <class T, class Out, class In>
  void connect(Out& out, In& in, const LinkParams& params, const std::string& name, int path_clk = 0);

  const MachineConfig& config_;
  DeviceFrame& frame_;
  hw::Clock clock_, memory_clock_;
  hw::QuietLog quiet_;
  std::vector<LeftOut> left_out_;
  std::vector<hw::L2Slice::Client> clients_;  ///< of the L2 slices: names of units, in the order of their ports
  std::unique_ptr<hw::Driver> own_driver_;
  hw::Driver* driver_ = nullptr;
  std::unique_ptr<hw::Store<hw::BatchSlot>> batches_;
  std::unique_ptr<hw::Store<hw::ClippedPiece>> pieces_;
  std::unique_ptr<hw::TriangleStore> triangles_;
  std::unique_ptr<hw::CommandProcessor> command_processor_;
  std::unique_ptr<hw::VertexFetch> vertex_fetch_;
  std::unique_ptr<hw::PrimitiveAssembly> assembly_;
  std::unique_ptr<hw::Clipper> clipper_;
  std::unique_ptr<hw::TriangleSetupUnit> setup_;
  std::unique_ptr<hw::CoarseRaster> coarse_;
  std::unique_ptr<hw::FineRaster> fine_;
  std::unique_ptr<hw::WorkDistributor> distributor_;
  std::unique_ptr<hw::ScanOut> scan_out_;
  std::vector<Partition> partitions_;
  std::vector<Core> cores_;
  std::vector<std::unique_ptr<hw::L2Slice>> slices_;
  std::vector<std::unique_ptr<hw::MemoryChannel>> channels_;
  std::vector<std::unique_ptr<hw::FifoBase>> links_;
  std::vector<std::string> link_keys_;
};

}  // namespace quadrille::pipeline
