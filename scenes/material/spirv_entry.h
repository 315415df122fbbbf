/// The entry point of a user's SPIR-V module: command streams call it main.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::scenes {

/// Sees to it that the entry point of the stage is called main. Where none is, the only one of the stage is
/// renamed, and `note` says so in one line. Throws `UserError` naming `path` and what entry points there are
/// if the stage has none or several. A module that is not well formed is left as it is beyond its damage; it
/// is refused later, with a reason. [SPV #OpEntryPoint]
void call_entry_point_main(std::vector<std::uint32_t>& spirv, traces::ShaderStage stage,
                           const std::string& path, std::string& note);

}  // namespace quadrille::scenes
