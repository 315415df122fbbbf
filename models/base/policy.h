/// Policies: the ways of doing one thing that a machine file chooses between by name.
///
/// A policy is one small file: what it does, what it is called, and why one would choose it. A line in the
/// list of its kind makes it known to the loader, to `quadrille describe` and to the tests that run over all
/// of a kind. A program may add policies of its own to a list before it makes a machine.
#pragma once

#include "models/base/error.h"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <vector>

namespace quadrille {

/// How to make one that does `Does`, from what a machine says of it.
template <class Does, class... Setup>
struct Policy {
  std::string_view name;    ///< in a machine file
  std::string_view reason;  ///< what it does, and what for
  std::unique_ptr<Does> (*make)(Setup...) = nullptr;
};

/// All policies of a kind, in the order in which they are described.
template <class P>
class PolicyList {
 public:
  PolicyList(std::initializer_list<const P*> policies) {
    for (const P* policy : policies) add(*policy);
  }
  /// The policy outlives the list. No other has its name.
  void add(const P& policy) {
    QUADRILLE_CHECK(find(policy.name) == nullptr, "there is a policy '{}' already", policy.name);
    all_.push_back(&policy);
  }
  /// Null if there is none of that name.
  [[nodiscard]] const P* find(std::string_view name) const {
    const auto found = std::ranges::find(all_, name, &P::name);
    return found == all_.end() ? nullptr : *found;
  }
  [[nodiscard]] const std::vector<const P*>& all() const { return all_; }

 private:
  std::vector<const P*> all_;
};

}  // namespace quadrille
