/// Which requests a controller considers, one class a policy. It names requests; what each needs next (its
/// row closed, opened, a burst moved) and when the rules allow it is the controller's: among what can be done
/// now the oldest request comes first.
#pragma once

#include "models/memory/dram/device.h"
#include "models/memory/dram/request_queue.h"

#include <array>
#include <memory>

namespace quadrille::models {

enum class DramSchedulerKind { kInOrder, kFirstReady };

struct DramView {
  const DramQueue& queue;
  const DramDevice& device;
  bool reads = true, writes = true;  ///< kinds that may be served
  /// The oldest request of each kind (reads, writes) if it waits longer than the age cap, else kNone.
  std::array<std::uint32_t, 2> starving{DramQueue::kNone, DramQueue::kNone};
};

class DramScheduler {
 public:
  virtual ~DramScheduler() = default;
  /// The request of a bank to consider; kNone for none.
  [[nodiscard]] virtual std::uint32_t pick(const DramView& view, std::uint32_t bank) const = 0;
  /// May the bursts of the picked request be moved, or only its row be prepared?
  [[nodiscard]] virtual bool moves(const DramView& /*view*/, std::uint32_t /*request*/) const { return true; }
  /// Does a bank's pick depend on the requests of other banks?
  [[nodiscard]] virtual bool looks_beyond_bank() const = 0;
};

/// Bursts move in the order of arrival. With `ahead` of 0 what waits behind the oldest request waits for all
/// of it [P: Rixner et al., Memory Access Scheduling, ISCA 2000: in order]; else the rows of that many
/// requests behind it are closed and opened meanwhile, in banks that no older one needs.
class InOrderScheduler final : public DramScheduler {
 public:
  explicit InOrderScheduler(int ahead) : ahead_(ahead) {}
  [[nodiscard]] std::uint32_t pick(const DramView& view, std::uint32_t bank) const override;
  [[nodiscard]] bool moves(const DramView& view, std::uint32_t request) const override {
    return request == oldest(view);
  }
  [[nodiscard]] bool looks_beyond_bank() const override { return true; }

 private:
  [[nodiscard]] static std::uint32_t oldest(const DramView& view);
  int ahead_;
};

/// One request a bank: the oldest that hits the open row, else the oldest of all. Rows of other banks are
/// prepared meanwhile. When the oldest request waits longer than the age cap, younger hits to its bank no
/// longer go before it. [P: Rixner et al. 2000: first-ready]
class FirstReadyScheduler final : public DramScheduler {
 public:
  [[nodiscard]] std::uint32_t pick(const DramView& view, std::uint32_t bank) const override;
  [[nodiscard]] bool looks_beyond_bank() const override { return false; }

 private:
  [[nodiscard]] static std::uint32_t of_kind(const DramView& view, std::uint32_t bank, bool write);
};

[[nodiscard]] std::unique_ptr<DramScheduler> make_dram_scheduler(DramSchedulerKind kind, int in_order_ahead);

}  // namespace quadrille::models
