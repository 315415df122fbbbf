/// What a frame's figures say that a person may not expect.
#pragma once

#include "pipeline/report/figures.h"

#include <string>
#include <vector>

namespace quadrille::pipeline {

/// A line each. Empty for most frames; one without a written fragment says why.
[[nodiscard]] std::vector<std::string> notes_on(const Figures& figures);

}  // namespace quadrille::pipeline
