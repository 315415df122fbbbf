/// Random structured programs in GLSL: nested loops of every form, switches, early exits and called
/// functions, over four integers.
///
/// Every program ends: a loop counts, and its counter is written by the loop alone. All arithmetic is of
/// small integers, so two executors that follow the language agree to the bit. A program is a tree of
/// statements, each of them text around blocks, which is what lets `shrink` make a failing one small.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quadrille::pipeline {

struct RandomStatement;
using RandomBlock = std::vector<RandomStatement>;
/// `text[0] blocks[0] text[1] blocks[1] ... text[n]`.
struct RandomStatement {
  std::vector<std::string> text;
  std::vector<RandomBlock> blocks;
};

struct RandomFunction {
  std::string head, tail;
  RandomBlock body;
};

struct RandomShader {
  traces::ShaderStage stage = traces::ShaderStage::kFragment;
  std::vector<RandomFunction> functions;  ///< callees first; the last one is main
  /// GLSL. A fragment shader reads gl_FragCoord (x modulo 16, y modulo 2) and writes `color`, whole numbers
  /// of 255ths; a vertex shader reads gl_VertexIndex modulo 32 and writes the same to location 0. Nothing
  /// else enters, so 16 x 2 pixels or 32 vertices are all there is to know of a program.
  [[nodiscard]] std::string source() const;
  [[nodiscard]] std::size_t statements() const;
};

struct Seeds {
  std::uint32_t first, count;
};
/// Those of QUADRILLE_SHADER_SEEDS ("FIRST COUNT"), or the usual ones.
[[nodiscard]] Seeds seeds_or(Seeds usual);

/// The program of a seed, the same everywhere.
[[nodiscard]] RandomShader random_shader(std::uint32_t seed, traces::ShaderStage stage);

/// The smallest program found, by leaving out statements and by putting a statement's block in its place, for
/// which `fails` still holds. `fails` must answer false for a program that does not compile: what is left out
/// may leave a name or a `break` without its place.
[[nodiscard]] RandomShader shrink(RandomShader shader, const std::function<bool(const RandomShader&)>& fails);

}  // namespace quadrille::pipeline
