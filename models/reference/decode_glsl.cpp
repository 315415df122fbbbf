/// Decoding the extended instructions of GLSL.std.450. [SPIR-V GLSL.std.450]
#include <spirv/unified1/GLSL.std.450.h>

#include "models/base/error.h"
#include "models/reference/decode.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {

void Decoder::glsl_instruction(Frame& frame, const SpirvInstruction& in) {
  if (in.words[0] != module_.glsl_import || module_.glsl_import == 0)
    unsupported("extended instructions other than GLSL.std.450");
  const std::uint32_t which = in.words[1];
  if (const Handler handler = glsl_two_result_handler(which); handler != nullptr)
    return two_results(frame, in, handler);
  Handler handler = glsl_float_handler(which);
  if (handler == nullptr) handler = glsl_vector_handler(which);
  if (handler == nullptr) handler = glsl_integer_handler(which);
  if (handler == nullptr)
    throw user_error("shader '{}': the reference renderer does not support GLSL.std.450 instruction {}",
                     module_.name, which);
  arithmetic(frame, in, handler, std::span(in.words).subspan(2), false);
}

/// Modf and Frexp: the struct forms return both results, the plain ones store the second through a pointer.
void Decoder::two_results(Frame& frame, const SpirvInstruction& in, Handler handler) {
  const Value operand = value(frame, in.words[2]);
  const std::uint32_t n = cells(operand.type);
  const bool is_struct = in.words[1] == GLSLstd450ModfStruct || in.words[1] == GLSLstd450FrexpStruct;
  const Slot both = is_struct ? define(frame, in).slot : allocate(2 * n);
  emit(handler, n, both, {operand.slot});
  if (is_struct) return;
  const Value pointer = value(frame, in.words[3]);
  frame.values[in.result] = {Value::Kind::kCells, in.type, both, kNoSlot, false};
  store(pointer, {Value::Kind::kCells, pointer.type, both + n, kNoSlot, false});
}

}  // namespace quadrille::models::reference
