/// Float operations at special-function rate: division, roots and the transcendental functions.
#include "models/shader/kernels.h"
#include "models/shader/vector_math.h"

namespace quadrille::models {
namespace {

struct FDiv : FloatOperation<2> {
  static Floats apply(Floats a, Floats b) { return a / b; }
};
struct FRcp : FloatOperation<1> {
  static Floats apply(Floats a) { return splat(1.0f) / a; }
};
struct FRsq : FloatOperation<1> {
  static Floats apply(Floats a) { return splat(1.0f) / square_root(a); }
};
struct FSqrt : FloatOperation<1> {
  static Floats apply(Floats a) { return square_root(a); }
};
struct FExp2 : FloatOperation<1> {
  static Floats apply(Floats a) { return exp2(a); }
};
struct FLog2 : FloatOperation<1> {
  static Floats apply(Floats a) { return log2(a); }
};
struct FSin : FloatOperation<1> {
  static Floats apply(Floats a) { return sin(a); }
};
struct FCos : FloatOperation<1> {
  static Floats apply(Floats a) { return cos(a); }
};

}  // namespace

Kernel special_kernel(Op op, const KernelShape& shape) {
  if (op == Op::kFDiv) return kernel_of<FDiv>(shape);
  if (op == Op::kFRcp) return kernel_of<FRcp>(shape);
  if (op == Op::kFRsq) return kernel_of<FRsq>(shape);
  if (op == Op::kFSqrt) return kernel_of<FSqrt>(shape);
  if (op == Op::kFExp2) return kernel_of<FExp2>(shape);
  if (op == Op::kFLog2) return kernel_of<FLog2>(shape);
  if (op == Op::kFSin) return kernel_of<FSin>(shape);
  if (op == Op::kFCos) return kernel_of<FCos>(shape);
  return {};
}

}  // namespace quadrille::models
