/// A memory channel of Quadrille in a SystemC model of your own: a client reads lines in an order of its
/// choice, and a thread of SystemC watches the clock.
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "hw/base/native_driver.h"
#include "hw/memory/memory_channel.h"

namespace {

using namespace quadrille;

/// Reads whole lines in the order given, as fast as the channel takes them.
class Client final : public hw::Unit {
 public:
  Client(sc_core::sc_module_name name, const hw::Clock& clock, std::vector<std::uint32_t> lines)
      : Unit(name, Kind::kChooser, clock), lines_(std::move(lines)) {}
  hw::FifoOut<hw::MemoryRequest> request_out{*this, "request_out"};
  hw::FifoIn<hw::MemoryResponse> response_in{*this, "response_in", hw::LinkRole::kReply};

  [[nodiscard]] hw::Wake next() const override {
    const hw::Wake answer = hw::Wake().input(response_in);
    return sent_ == lines_.size() ? answer : hw::Wake::sooner(answer, hw::Wake(free_).output(request_out));
  }
  void act(hw::Tick now) override {
    if (response_in.ready_at(now)) {
      (void)response_in.pop(now);
      ++answered_;
    }
    if (sent_ == lines_.size() || free_ > now || !request_out.room_at(now)) return;
    request_out.push(now, {.line = lines_[sent_], .tag = static_cast<std::uint32_t>(sent_), .sectors = 0xf});
    ++sent_;
    free_ = after(now, 1);
  }
  [[nodiscard]] std::size_t answered() const { return answered_; }

 private:
  std::vector<std::uint32_t> lines_;
  std::size_t sent_ = 0, answered_ = 0;
  hw::Tick free_ = 0;
};

/// A module that owes nothing to Quadrille.
class Watch final : public sc_core::sc_module {
 public:
  explicit Watch(sc_core::sc_module_name name) : sc_module(name) {
    sc_core::sc_spawn([this] {
      for (int i = 0; i < 4; ++i) {
        sc_core::wait(1, sc_core::SC_US);
        ++ticks;
      }
    });
  }
  int ticks = 0;
};

struct Result {
  std::int64_t cycles = 0;
  double row_hits = 0;
};

constexpr std::size_t kLines = 2000;
constexpr double kBytes = 128.0 * kLines;

}  // namespace

int sc_main(int /*count*/, char** /*arguments*/) {
  hw::NativeDriver driver("driver");  // first: it sets SystemC's resolution of time
  const hw::Clock clock(1'000'000'000);
  const hw::Frame frame;
  models::DeviceMemory memory;
  const hw::UnitContext context{clock, frame, memory, {}};
  hw::MemoryChannel::Params params;  // as of the default machine; params.t_rcd.set(20) changes one

  // Two channels, since SystemC simulates once a process: one is read in order, the other in steps of 64 KiB.
  std::vector<std::uint32_t> in_order, far_apart;
  for (std::uint32_t i = 0; i < kLines; ++i) {
    in_order.push_back(i);
    far_apart.push_back(512 * i);
  }
  struct Side {
    std::unique_ptr<hw::MemoryChannel> channel;
    std::unique_ptr<Client> client;
    std::unique_ptr<hw::Fifo<hw::MemoryRequest>> requests;
    std::unique_ptr<hw::Fifo<hw::MemoryResponse>> answers;
  };
  std::vector<Side> sides;
  for (const auto& [name, lines] : {std::pair{"in_order", in_order}, {"far_apart", far_apart}}) {
    Side side;
    side.channel =
        std::make_unique<hw::MemoryChannel>(fmt::format("{}_channel", name).c_str(), context, params);
    side.client = std::make_unique<Client>(fmt::format("{}_client", name).c_str(), clock, lines);
    side.requests = std::make_unique<hw::Fifo<hw::MemoryRequest>>(fmt::format("{}_requests", name).c_str(),
                                                                  hw::LinkSpec{.depth = 16});
    side.answers = std::make_unique<hw::Fifo<hw::MemoryResponse>>(fmt::format("{}_answers", name).c_str(),
                                                                  hw::LinkSpec{.depth = 16});
    side.client->request_out.bind(*side.requests);
    side.channel->request_in.bind(*side.requests);
    side.channel->response_out.bind(*side.answers);
    side.client->response_in.bind(*side.answers);
    driver.add(*side.channel);
    driver.add(*side.client);
    sides.push_back(std::move(side));
  }
  Watch watch("watch");

  driver.run({});
  std::vector<Result> results;
  for (const Side& side : sides) {
    if (side.client->answered() != kLines) return 1;
    const hw::Tick end = side.client->last_action();
    side.channel->finish_stats(end);
    Result result{clock.edges_before(end), 0};
    std::uint64_t accesses = 0;
    for (const hw::Counter* counter : side.channel->stats()->counters()) {
      if (counter->name() == "row_hits") result.row_hits = static_cast<double>(counter->value());
      if (counter->name().starts_with("row_")) accesses += counter->value();
    }
    result.row_hits /= static_cast<double>(accesses);
    fmt::print("{}: {} cycles, {:.1f} bytes a cycle, row hits {:.1f} %\n", side.client->name(), result.cycles,
               kBytes / static_cast<double>(result.cycles), 100 * result.row_hits);
    results.push_back(result);
  }
  // A row that stays open serves many lines; one that changes at each line serves one.
  const bool right = results[0].row_hits > 0.8 && results[1].row_hits < 0.2 &&
                     results[1].cycles > results[0].cycles && watch.ticks == 4;
  return right ? 0 : 1;
}
