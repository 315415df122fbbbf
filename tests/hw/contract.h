/// The contract every unit and every machine keeps, as one harness: give it a callable that builds the
/// machine, and it runs that machine in forked processes (SystemC allows one simulation a process) in many
/// variations that must not change anything, and says in words what did change.
///
///   attribution  busy + starved + blocked + idle = cycles, for every unit, in every variation
///   same cycles  both drivers, any host order: equal digest, end, actions, charges of every unit and port,
///                traffic of every link, own counters
///   depth one    every link one token deep: the machine still finishes, with an equal digest (its cycles may
///                differ)
#pragma once

#include "hw/base/driver.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace quadrille::hw::contract {

/// How one run of a machine differs from the plain one. The harness chooses the driver and shuffles the
/// units' order itself; the builder asks `link` for every FIFO it creates and may create its modules in
/// another order when `creation_seed` is not 0.
struct Variation {
  bool native = false;           ///< the native driver instead of the dispatcher
  std::uint64_t order_seed = 0;  ///< host order of the units; 0 as added
  /// order of creating modules, for builders that can vary it; 0 as written
  std::uint64_t creation_seed = 0;
  bool depth_one = false;  ///< every link holds one token
  /// of the dispatcher; with one, cycles are approximate and everything else holds
  Tick window = 0;
  [[nodiscard]] LinkSpec link(LinkSpec spec) const {
    if (depth_one) spec.depth = 1;
    return spec;
  }
  [[nodiscard]] std::string text() const;
};

/// A machine that a builder made. It owns modules, links and stores until the run is over.
class Specimen {
 public:
  virtual ~Specimen() = default;
  /// What the machine computed (an image, a checksum of memory): equal in every variation.
  [[nodiscard]] virtual std::uint64_t digest() const = 0;
  /// Did the machine do all its work? If not, the deadlock report is the violation.
  [[nodiscard]] virtual bool finished() const { return true; }
  /// Tick at which the accounts close; kNever: the clock edge after the last action of any unit.
  [[nodiscard]] virtual Tick end() const { return kNever; }
  /// Further figures that must be equal in all variations of equal depth.
  virtual void add_figures(std::map<std::string, std::int64_t>& figures) const { (void)figures; }
};

/// Builds the machine and adds its units to the driver (`Driver::add`). Called in a fresh process each time.
using Builder = std::function<std::unique_ptr<Specimen>(Driver& driver, const Variation& variation)>;

/// What one run gave. `figures` has `<unit>.busy|starved|blocked|idle|cycles|actions`,
/// `<unit>.<port>.waited`, `<link>.pushes` and every unit's counters.
struct Outcome {
  /// empty when the run ended well: else the abort's message, an exception's text or the deadlock report
  std::string failure;
  std::uint64_t digest = 0;
  Tick end = 0;
  std::map<std::string, std::int64_t> figures;
};

struct Options {
  /// random host orders with the dispatcher (and one with the native driver)
  int shuffles = 4;
  int creations = 1;                ///< random orders of creating modules
  bool depth_one = true;            ///< also with all links one deep, in both drivers
  bool digest_at_depth_one = true;  ///< the digest at depth one equals the plain one
  unsigned timeout_s = 600;         ///< of one run, in seconds of the host, against a hang
};

/// Runs one variation in a forked process.
[[nodiscard]] Outcome run_forked(const Builder& build, const Variation& variation, unsigned timeout_s = 600);
/// Runs all variations. One line a violation (at most a few a variation); empty when the contract is kept.
[[nodiscard]] std::vector<std::string> violations(const Builder& build, const Options& options = {});
/// The differences between two outcomes, at most `limit` of them.
[[nodiscard]] std::vector<std::string> differences(const Outcome& a, const Outcome& b, std::size_t limit = 5);

/// Runs `body` in a forked process and returns what it returned; text that starts with "failed:" when it
/// threw, aborted or ran out of time.
[[nodiscard]] std::string in_child(const std::function<std::string()>& body, unsigned timeout_s = 600);

}  // namespace quadrille::hw::contract
