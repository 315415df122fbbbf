/// Arrays of textures, samplers and buffers: each element becomes a variable of its own.
///
/// SPIRV-Tools does it: an index that is known names one element, and one that is not becomes a switch over
/// all of them. It numbers the elements from the array's binding on, where other bindings may lie. So
/// bindings are moved apart first, and then become those of models/base/descriptor_binding.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace spvtools {
class Optimizer;
}

namespace quadrille::pipeline {

/// Of more than one element. Throws `UserError` for arrays without a size, and of too many elements.
[[nodiscard]] bool has_descriptor_arrays(std::span<const std::uint32_t> words, std::string_view shader);

/// Before the passes: binding b becomes b * 65536, and entry points name no resources.
/// Throws `UserError` for a binding above 65535.
void spread_bindings(std::vector<std::uint32_t>& words, std::string_view shader);
void register_descriptor_array_passes(spvtools::Optimizer& optimizer);
/// After them: what is now binding b * 65536 + k is element k of binding b.
void name_elements(std::vector<std::uint32_t>& words);

}  // namespace quadrille::pipeline
