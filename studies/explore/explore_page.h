/// A sweep as a page that a browser shows (pipeline/report/page.h).
#pragma once

#include <string>

#include "studies/explore/exploration.h"
#include "studies/explore/results.h"

namespace quadrille::studies::explore {

/// What a page is of. Everything must outlive it.
struct PageSubject {
  const Sweep& sweep;
  const Space& space;
  const Plan& plan;
  const Exploration& exploration;
  const Results& results;
};

/// What the page shows: machines with their objectives, the front, Sobol indices, pictures, failures.
/// Throws `UserError`.
[[nodiscard]] std::string sweep_json(const PageSubject& subject);
/// The page, one file that needs nothing else. Throws `UserError`.
[[nodiscard]] std::string sweep_page(const PageSubject& subject);

}  // namespace quadrille::studies::explore
