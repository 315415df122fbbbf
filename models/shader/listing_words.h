/// The words of a listing that are the same for printing and reading: names of stages, flags, interpolation
/// modes, system values and slots.
#pragma once

#include "models/shader/op_table.h"

#include <array>
#include <string_view>

namespace quadrille::models {

struct NamedFlag {
  std::string_view name;
  bool Program::*member;
};
inline constexpr std::array<NamedFlag, 8> kProgramFlags{
    {{"discard", &Program::uses_discard},
     {"depth", &Program::writes_depth},
     {"sample-mask", &Program::writes_sample_mask},
     {"by-sample", &Program::by_sample},
     {"early-tests", &Program::early_fragment_tests},
     {"second-source", &Program::second_source},
     {"derivatives", &Program::uses_derivatives},
     {"atomic-outputs", &Program::outputs_follow_atomics}}};

/// By value of the enumeration.
inline constexpr std::array<std::string_view, 5> kInterpolationNames{
    "perspective", "linear", "flat", "perspective-centroid", "linear-centroid"};
inline constexpr std::array<std::string_view, 14> kSystemValueNames{
    "vertex_index", "instance_index", "frag_coord_x", "frag_coord_y",  "frag_coord_z",
    "frag_coord_w", "front_facing",   "primitive_id", "point_coord_x", "point_coord_y",
    "sample_id",    "sample_x",       "sample_y",     "sample_mask"};

inline constexpr std::array<std::string_view, 3> kNumberKindNames{"float", "uint", "sint"};
inline constexpr std::array<std::string_view, 4> kTextureAskNames{"sample", "fetch", "gather", "lod"};
inline constexpr std::array<std::string_view, 4> kLevelFromNames{"quad", "bias", "level", "gradients"};

/// Prefix of the slot number of an immediate.
constexpr std::string_view slot_prefix(Immediate immediate) {
  switch (immediate) {
    case Immediate::kUnused: return "";
    case Immediate::kInputSlot: return "in";
    case Immediate::kVaryingSlot: return "vary";
    case Immediate::kOutputSlot: return "out";
    case Immediate::kConstantWord: return "c";
    case Immediate::kTextureBinding: return "t";
    case Immediate::kTextureOperation: return "op";
    case Immediate::kBufferBinding: return "b";
  }
  return "";
}

}  // namespace quadrille::models
