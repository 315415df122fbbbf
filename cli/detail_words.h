/// The words of --detail.
#pragma once

#include <string>

#include "pipeline/report/detail.h"

namespace quadrille::cli {

inline constexpr const char* kDetailNames = "draws,tiles,timeline,path,misses,textures";

/// Sets what the words, between commas, name. Throws `UserError` for any other.
void choose_details(const std::string& words, pipeline::DetailOptions& chosen);

}  // namespace quadrille::cli
