/// The strict driver finds each way of breaking a unit's contract, and nothing in a unit that keeps it.
#include "tests/hw/base/strict_driver.h"

#include "tests/hw/contract.h"

#include <catch2/catch.hpp>

#include <fmt/ranges.h>

using namespace quadrille::hw;

namespace {

enum class Fault { kNone, kChangesItsMind, kNotPure, kInThePast, kDoesNothing };

constexpr Tick kCycle = 1'000'000;

/// Acts every second cycle, ten times, unless its fault is another.
class Ticker final : public Unit {
 public:
  Ticker(const char* name, const Clock& clock, Fault fault)
      : Unit(sc_core::sc_module_name(name), Kind::kFixedOrder, clock), fault_(fault) {}
  [[nodiscard]] Wake next() const override {
    ++asked_;
    if (left_ == 0) return Wake(kNever);
    if (fault_ == Fault::kNotPure) return Wake(at_ + (asked_ % 2) * kCycle);
    if (fault_ == Fault::kChangesItsMind) return Wake(at_ + asked_ / 4 * kCycle);
    if (fault_ == Fault::kInThePast && left_ < 10) return Wake(asked_ % 40 < 20 ? at_ : at_ - 3 * kCycle);
    return Wake(at_);
  }
  void act(Tick now) override {
    if (fault_ == Fault::kDoesNothing) return;
    at_ = now + 2 * kCycle;
    --left_;
  }

 private:
  Fault fault_;
  mutable int asked_ = 0;
  Tick at_ = 0;
  int left_ = 10;
};

std::string violations_of(Fault fault) {
  return contract::in_child([fault] {
    const Clock clock(1'000'000'000);
    StrictDriver driver("driver");
    Ticker good("good", clock, Fault::kNone), other("other", clock, fault);
    driver.add(good);
    driver.add(other);
    driver.run({});
    return fmt::format("{};", fmt::join(driver.violations(), ";"));
  });
}

}  // namespace

TEST_CASE("strict_driver: units that keep the contract are let pass") {
  CHECK(violations_of(Fault::kNone) == ";");
}

TEST_CASE("strict_driver: an answer that changes by itself is found") {
  const std::string found = violations_of(Fault::kChangesItsMind);
  CHECK(found.find("other answers") != std::string::npos);
  CHECK(found.find("good") == std::string::npos);
}

TEST_CASE("strict_driver: two answers in a row that differ are found") {
  CHECK(violations_of(Fault::kNotPure).find("when it is asked again") != std::string::npos);
}

TEST_CASE("strict_driver: an earlier answer than before is found") {
  CHECK(violations_of(Fault::kInThePast).find("other answers") != std::string::npos);
}

TEST_CASE("strict_driver: an action that does nothing is found") {
  CHECK(violations_of(Fault::kDoesNothing).find("other acts and acts") != std::string::npos);
}
