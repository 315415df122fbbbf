#include "pipeline/machine/wave_file.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>

#include "models/base/error.h"

namespace quadrille::pipeline {

namespace {

/// SystemC adds this to the name that it is given.
constexpr std::string_view kEnding = ".vcd";

}  // namespace

WaveFile::WaveFile(const Machine& machine, hw::NativeDriver& driver, const std::string& path)
    : machine_(machine),
      path_(path),
      part_(fmt::format("{}.{}.part{}", path, getpid(), kEnding)),
      unfinished_(part_),
      tokens_(machine.links().size(), 0),
      acts_(std::make_unique<bool[]>(machine.units().size())) {
  // It would say on standard output which unit of time it takes.
  sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  file_ = sc_core::sc_create_vcd_trace_file(part_.substr(0, part_.size() - kEnding.size()).c_str());
  file_->set_time_unit(1, sc_core::SC_FS);
  for (std::size_t i = 0; i < tokens_.size(); ++i) {
    const auto bits =
        static_cast<int>(std::bit_width(static_cast<unsigned>(machine.links()[i]->spec().depth)));
    sc_core::sc_trace(file_, tokens_[i], "links." + machine.links()[i]->path(), bits);
  }
  for (std::size_t i = 0; i < machine.units().size(); ++i)
    sc_core::sc_trace(file_, acts_[i], fmt::format("units.{}", machine.units()[i]->name()));
  driver.observe([this](const hw::Unit& unit) { note(unit); });
}

WaveFile::~WaveFile() {
  close();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void WaveFile::note(const hw::Unit& unit) {
  Watched& watched = watched_[&unit];
  if (watched.acts == nullptr) {  // ports are bound once the run has begun
    const auto number = std::ranges::find(machine_.units(), &unit) - machine_.units().begin();
    watched.acts = &acts_[static_cast<std::size_t>(number)];
    for (const hw::PortBase* port : unit.ports()) {
      const auto link =
          std::ranges::find(machine_.links(), &port->fifo(), &std::unique_ptr<hw::FifoBase>::get);
      watched.links.emplace_back(&port->fifo(),
                                 &tokens_[static_cast<std::size_t>(link - machine_.links().begin())]);
    }
  }
  *watched.acts = !*watched.acts;
  for (const auto& link : watched.links) *link.second = link.first->occupancy();
}

void WaveFile::close() {
  if (file_ != nullptr) sc_core::sc_close_vcd_trace_file(file_);
  file_ = nullptr;
}

// SystemC writes what an instant left when time goes on, and does not say when it could not write. A disk
// that was full for it is full for the last line too.
void WaveFile::finish() {
  sc_core::sc_start(1, sc_core::SC_FS);
  close();
  std::ofstream file(part_, std::ios::app);
  file << "$comment the frame ended a femtosecond before $end\n" << std::flush;
  if (!file) throw user_error("{}: cannot be written whole", path_);
  file.close();
  std::error_code failure;
  std::filesystem::rename(part_, path_, failure);
  if (failure) throw user_error("{}: {}", path_, failure.message());
}

}  // namespace quadrille::pipeline
