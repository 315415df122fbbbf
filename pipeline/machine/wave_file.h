/// A run as waves: how many tokens each link holds and when each unit acts, by SystemC's own tracing, as a
/// VCD file [IEEE 1364], which GTKWave shows.
///
/// Tracing samples what it is given whenever simulated time goes on, so it needs the driver that gives each
/// unit a process of SystemC's own.
#pragma once

#include "hw/base/native_driver.h"
#include "pipeline/machine/machine.h"
#include "traces/unfinished.h"

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace quadrille::pipeline {

class WaveFile {
 public:
  /// Of a machine whose units `driver` runs. Before the run. Throws `UserError`.
  WaveFile(const Machine& machine, hw::NativeDriver& driver, const std::string& path);
  /// Removes what was written, unless it is finished.
  ~WaveFile();
  WaveFile(const WaveFile&) = delete;
  WaveFile& operator=(const WaveFile&) = delete;

  /// After the run: the file appears under its name. Throws `UserError` where it could not be written whole.
  void finish();

 private:
  /// What an action of a unit may have changed.
  struct Watched {
    bool* acts = nullptr;
    std::vector<std::pair<const hw::FifoBase*, int*>> links;
  };
  void note(const hw::Unit& unit);
  void close();

  const Machine& machine_;
  std::string path_, part_;
  traces::Unfinished unfinished_;
  std::vector<int> tokens_;       ///< by link
  std::unique_ptr<bool[]> acts_;  ///< by unit: turns over with every action
  std::unordered_map<const hw::Unit*, Watched> watched_;
  sc_core::sc_trace_file* file_ = nullptr;
};

}  // namespace quadrille::pipeline
