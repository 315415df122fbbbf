#include "tests/pipeline/machine_specimen.h"

#include "pipeline/driver/draw_culling.h"
#include "pipeline/functional/functional.h"
#include "pipeline/report/figures.h"
#include "tests/pipeline/random_machine.h"

namespace quadrille::pipeline::test {

namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) { return (hash ^ value) * 0x100000001b3u; }

class MachineSpecimen final : public hw::contract::Specimen {
 public:
  MachineSpecimen(const traces::CommandStream& stream, std::uint64_t machine_seed, bool leave_out,
                  hw::Driver& driver, const hw::contract::Variation& variation)
      : frame_(std::uint64_t{1} << 30) {
    if (machine_seed != 0) randomize(config_, machine_seed);
    if (variation.depth_one) {
      for (const auto& [path, group] : config_.groups()) {
        if (path.starts_with("link.")) group->find("depth")->parse("1");
      }
    }
    build_frame(stream, config_.precision(), frame_, true, {{}, config_.texture.layout});
    if (config_.command_processor.cull_draws) find_draws_outside(frame_.frame, frame_.memory);
    MachineOptions options;
    options.external_driver = &driver;
    options.leave_out = leave_out;
    options.module_order = variation.creation_seed;
    machine_ = std::make_unique<Machine>(config_, frame_, options);
  }
  [[nodiscard]] std::uint64_t digest() const override { return image_digest(frame_); }
  [[nodiscard]] bool finished() const override { return machine_->one<hw::CommandProcessor>().finished(); }
  [[nodiscard]] hw::Tick end() const override { return machine_->end(); }
  void add_figures(std::map<std::string, std::int64_t>& figures) const override {
    const Figures f = collect_figures(*machine_, frame_);
    for (const Check& c : f.checks) figures["law broken: " + c.law] = c.holds() ? 0 : 1;
  }

 private:
  MachineConfig config_;
  DeviceFrame frame_;
  std::unique_ptr<Machine> machine_;
};

}  // namespace

std::uint64_t image_digest(const DeviceFrame& frame) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const hw::PassState& pass : frame.frame.passes) {
    for (std::size_t c = 0; c < pass.colors; ++c) {
      for (const models::PixelCode& pixel : models::detile_codes(frame.memory, pass.color[c].surface))
        for (const std::uint32_t word : pixel.word) hash = mix(hash, word);
    }
    if (!pass.has_depth) continue;
    for (const models::PixelCode& depth : models::detile_codes(frame.memory, pass.depth.surface))
      for (const std::uint32_t word : depth.word) hash = mix(hash, word);
  }
  for (const WrittenBuffer& written : frame.written_buffers)
    for (const std::byte byte : frame.memory.read(written.address, written.bytes))
      hash = mix(hash, static_cast<std::uint64_t>(byte));
  return hash;
}

std::uint64_t functional_digest(const traces::CommandStream& stream, const models::Precision& precision) {
  DeviceFrame frame(std::uint64_t{1} << 30);
  build_frame(stream, precision, frame);
  (void)render_functional(frame.frame, frame.memory);
  return image_digest(frame);
}

hw::contract::Builder machine_builder(const traces::CommandStream& stream, std::uint64_t machine_seed,
                                      bool leave_out) {
  return [&stream, machine_seed, leave_out](hw::Driver& driver, const hw::contract::Variation& variation) {
    return std::make_unique<MachineSpecimen>(stream, machine_seed, leave_out, driver, variation);
  };
}

std::string faults_of(const hw::contract::Outcome& outcome, std::uint64_t digest) {
  if (!outcome.failure.empty()) return outcome.failure;
  std::string faults = outcome.digest == digest ? "" : "other pixels; ";
  for (const auto& [name, value] : outcome.figures)
    if (name.starts_with("law broken") && value != 0) faults += name + "; ";
  return faults;
}

std::string machine_faults(const traces::CommandStream& stream, std::uint64_t machine_seed,
                           const hw::contract::Variation& variation) {
  MachineConfig machine;
  if (machine_seed != 0) randomize(machine, machine_seed);
  return faults_of(hw::contract::run_forked(machine_builder(stream, machine_seed), variation),
                   functional_digest(stream, machine.precision()));
}

std::string refusal(const traces::CommandStream& stream) {
  try {
    traces::validate(stream);
    (void)functional_digest(stream);
    return "";
  } catch (const UserError& error) { return error.what(); }
}

}  // namespace quadrille::pipeline::test
