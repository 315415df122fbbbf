/// Integer, logical, bit and conversion operations of the interpreter. Integers are 32 bits and wrap.
#include <spirv/unified1/GLSL.std.450.h>

#include <bit>
#include <cmath>
#include <spirv/unified1/spirv.hpp>

#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

using U = std::uint32_t;
using S = std::int32_t;

const Cell& operand(const Operation& o, Lanes& lanes, std::size_t which, U i) {
  return lanes.cells[o.src[which] + i * o.step[which]];
}
S as_signed(U a) { return static_cast<S>(a); }
U as_unsigned(S a) { return static_cast<U>(a); }

/// dst[i] = formula(i, lane), an integer, for n components.
template <class Formula>
void integer_result(const Operation& o, Lanes& lanes, U n, const Formula& formula) {
  for (U i = 0; i < n; ++i) {
    Cell r;
    for (int lane = 0; lane < kLanes; ++lane) r.set_u(lane, formula(i, lane));
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

template <U (*kFunction)(U)>
void each1(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, o.n, [&](U i, int l) { return kFunction(operand(o, lanes, 0, i).u(l)); });
}
template <U (*kFunction)(U, U)>
void each2(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, o.n, [&](U i, int l) {
    return kFunction(operand(o, lanes, 0, i).u(l), operand(o, lanes, 1, i).u(l));
  });
}
template <U (*kFunction)(U, U, U)>
void each3(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, o.n, [&](U i, int l) {
    return kFunction(operand(o, lanes, 0, i).u(l), operand(o, lanes, 1, i).u(l),
                     operand(o, lanes, 2, i).u(l));
  });
}

U add(U a, U b) { return a + b; }
U sub(U a, U b) { return a - b; }
U mul(U a, U b) { return a * b; }
U neg(U a) { return 0u - a; }
// Division by zero is undefined; here it gives zero. The one quotient that overflows wraps.
U udiv(U a, U b) { return b == 0 ? 0 : a / b; }
U umod(U a, U b) { return b == 0 ? 0 : a % b; }
U sdiv(U a, U b) { return b == 0 ? 0 : b == ~0u ? neg(a) : as_unsigned(as_signed(a) / as_signed(b)); }
U srem(U a, U b) { return b == 0 || b == ~0u ? 0 : as_unsigned(as_signed(a) % as_signed(b)); }
U smod(U a, U b) {
  const U r = srem(a, b);
  return r != 0 && ((r ^ b) >> 31) != 0 ? r + b : r;
}
U shift_left(U a, U b) { return a << (b & 31u); }
U shift_right(U a, U b) { return a >> (b & 31u); }
U shift_arithmetic(U a, U b) { return as_unsigned(as_signed(a) >> (b & 31u)); }
U bit_and(U a, U b) { return a & b; }
U bit_or(U a, U b) { return a | b; }
U bit_xor(U a, U b) { return a ^ b; }
U bit_not(U a) { return ~a; }
U logical_not(U a) { return a ^ 1u; }
U eq(U a, U b) { return a == b; }
U ne(U a, U b) { return a != b; }
U ult(U a, U b) { return a < b; }
U ule(U a, U b) { return a <= b; }
U ugt(U a, U b) { return a > b; }
U uge(U a, U b) { return a >= b; }
U slt(U a, U b) { return as_signed(a) < as_signed(b); }
U sle(U a, U b) { return as_signed(a) <= as_signed(b); }
U sgt(U a, U b) { return as_signed(a) > as_signed(b); }
U sge(U a, U b) { return as_signed(a) >= as_signed(b); }
U umin(U a, U b) { return a < b ? a : b; }
U umax(U a, U b) { return a < b ? b : a; }
U smin(U a, U b) { return slt(a, b) != 0 ? a : b; }
U smax(U a, U b) { return slt(a, b) != 0 ? b : a; }
U uclamp(U a, U low, U high) { return umin(umax(a, low), high); }
U sclamp(U a, U low, U high) { return smin(smax(a, low), high); }
U sabs(U a) { return as_signed(a) < 0 ? neg(a) : a; }
U ssign(U a) { return as_signed(a) > 0 ? 1u : as_signed(a) < 0 ? ~0u : 0u; }
U reverse(U a) {
  U r = 0;
  for (unsigned bit = 0; bit < 32; ++bit) r |= (a >> bit & 1u) << (31 - bit);
  return r;
}
U count(U a) { return static_cast<U>(std::popcount(a)); }
U find_lsb(U a) { return a == 0 ? ~0u : static_cast<U>(std::countr_zero(a)); }
U find_umsb(U a) { return a == 0 ? ~0u : 31u - static_cast<U>(std::countl_zero(a)); }
U find_smsb(U a) { return find_umsb(as_signed(a) < 0 ? ~a : a); }
U low_bits(U n) { return n >= 32 ? ~0u : (1u << n) - 1; }
U extract_unsigned(U a, U offset, U n) { return n == 0 ? 0 : shift_right(a, offset) & low_bits(n); }
U extract_signed(U a, U offset, U n) {
  if (n == 0) return 0;
  const U field = extract_unsigned(a, offset, n), sign = 1u << ((n - 1) & 31u);
  return (field ^ sign) - sign;
}

void insert_bits(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, o.n, [&](U i, int l) {
    const U offset = operand(o, lanes, 2, i).u(l),
            mask = shift_left(low_bits(operand(o, lanes, 3, i).u(l)), offset);
    return (operand(o, lanes, 0, i).u(l) & ~mask) | (shift_left(operand(o, lanes, 1, i).u(l), offset) & mask);
  });
}

void any(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, 1, [&](U, int l) {
    U r = 0;
    for (U i = 0; i < o.n; ++i) r |= lanes.cells[o.src[0] + i].u(l);
    return r;
  });
}
void all(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, 1, [&](U, int l) {
    U r = 1;
    for (U i = 0; i < o.n; ++i) r &= lanes.cells[o.src[0] + i].u(l);
    return r;
  });
}

void select(const Operation& o, Lanes& lanes) {
  for (U i = 0; i < o.n; ++i) {
    Cell r;
    for (std::size_t l = 0; l < kLanes; ++l) {
      r.bits[l] = operand(o, lanes, operand(o, lanes, 0, i).u(static_cast<int>(l)) != 0 ? 1 : 2, i).bits[l];
    }
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

// Conversions to integers truncate; values outside the range saturate and NaN gives 0.
U to_signed(double a) {
  return std::isnan(a)        ? 0
         : a <= -2147483648.0 ? 0x80000000u
         : a >= 2147483647.0  ? 0x7fffffffu
                              : as_unsigned(static_cast<S>(a));
}
U to_unsigned(double a) { return std::isnan(a) || a <= 0 ? 0 : a >= 4294967295.0 ? ~0u : static_cast<U>(a); }

template <U (*kFunction)(double)>
void from_float(const Operation& o, Lanes& lanes) {
  integer_result(o, lanes, o.n, [&](U i, int l) { return kFunction(operand(o, lanes, 0, i).f(l)); });
}
void signed_to_float(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n,
                [&](U i, int l) { return static_cast<double>(as_signed(operand(o, lanes, 0, i).u(l))); });
}
void unsigned_to_float(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](U i, int l) { return static_cast<double>(operand(o, lanes, 0, i).u(l)); });
}
U float_bits(double a) { return std::bit_cast<U>(static_cast<float>(a)); }
void bits_to_float(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](U i, int l) {
    return static_cast<double>(std::bit_cast<float>(operand(o, lanes, 0, i).u(l)));
  });
}

/// Packs n components into one word of `bits` each, scaled by `scale` after clamping to [low, 1].
template <int kBits, bool kSigned>
void pack_norm(const Operation& o, Lanes& lanes) {
  const double scale = kSigned ? (1 << (kBits - 1)) - 1 : (1 << kBits) - 1;
  integer_result(o, lanes, 1, [&](U, int l) {
    U word = 0;
    for (U i = 0; i < o.n; ++i) {
      const double a = lanes.cells[o.src[0] + i].f(l),
                   clamped = std::fmin(std::fmax(a, kSigned ? -1.0 : 0.0), 1.0);
      word |= (static_cast<U>(static_cast<S>(std::nearbyint(clamped * scale))) & low_bits(kBits))
              << (static_cast<U>(kBits) * i);
    }
    return word;
  });
}
template <int kBits, bool kSigned>
void unpack_norm(const Operation& o, Lanes& lanes) {
  const double scale = kSigned ? (1 << (kBits - 1)) - 1 : (1 << kBits) - 1;
  vector_result(o, lanes, o.imm[0], [&](U i, int l) {
    const U word = lanes.cells[o.src[0]].u(l), offset = static_cast<U>(kBits) * i;
    if (!kSigned) return static_cast<double>(extract_unsigned(word, offset, kBits)) / scale;
    return std::fmax(static_cast<double>(as_signed(extract_signed(word, offset, kBits))) / scale, -1.0);
  });
}

}  // namespace

Handler integer_handler(std::uint32_t op) {
  switch (op) {
    case spv::OpIAdd: return each2<add>;
    case spv::OpISub: return each2<sub>;
    case spv::OpIMul: return each2<mul>;
    case spv::OpSNegate: return each1<neg>;
    case spv::OpUDiv: return each2<udiv>;
    case spv::OpSDiv: return each2<sdiv>;
    case spv::OpUMod: return each2<umod>;
    case spv::OpSRem: return each2<srem>;
    case spv::OpSMod: return each2<smod>;
    case spv::OpShiftLeftLogical: return each2<shift_left>;
    case spv::OpShiftRightLogical: return each2<shift_right>;
    case spv::OpShiftRightArithmetic: return each2<shift_arithmetic>;
    case spv::OpBitwiseAnd:
    case spv::OpLogicalAnd: return each2<bit_and>;
    case spv::OpBitwiseOr:
    case spv::OpLogicalOr: return each2<bit_or>;
    case spv::OpBitwiseXor: return each2<bit_xor>;
    case spv::OpNot: return each1<bit_not>;
    case spv::OpLogicalNot: return each1<logical_not>;
    case spv::OpBitReverse: return each1<reverse>;
    case spv::OpBitCount: return each1<count>;
    case spv::OpBitFieldInsert: return insert_bits;
    case spv::OpBitFieldUExtract: return each3<extract_unsigned>;
    case spv::OpBitFieldSExtract: return each3<extract_signed>;
    case spv::OpIEqual:
    case spv::OpLogicalEqual: return each2<eq>;
    case spv::OpINotEqual:
    case spv::OpLogicalNotEqual: return each2<ne>;
    case spv::OpULessThan: return each2<ult>;
    case spv::OpULessThanEqual: return each2<ule>;
    case spv::OpUGreaterThan: return each2<ugt>;
    case spv::OpUGreaterThanEqual: return each2<uge>;
    case spv::OpSLessThan: return each2<slt>;
    case spv::OpSLessThanEqual: return each2<sle>;
    case spv::OpSGreaterThan: return each2<sgt>;
    case spv::OpSGreaterThanEqual: return each2<sge>;
    case spv::OpAny: return any;
    case spv::OpAll: return all;
    case spv::OpSelect: return select;
    case spv::OpConvertFToS: return from_float<to_signed>;
    case spv::OpConvertFToU: return from_float<to_unsigned>;
    case spv::OpConvertSToF: return signed_to_float;
    case spv::OpConvertUToF: return unsigned_to_float;
    default: return nullptr;
  }
}

Handler bitcast_handler(bool float_source, bool float_result) {
  if (float_source == float_result) return copy_cells;
  return float_source ? from_float<float_bits> : bits_to_float;
}

Handler glsl_integer_handler(std::uint32_t instruction) {
  switch (instruction) {
    case GLSLstd450SAbs: return each1<sabs>;
    case GLSLstd450SSign: return each1<ssign>;
    case GLSLstd450UMin: return each2<umin>;
    case GLSLstd450SMin: return each2<smin>;
    case GLSLstd450UMax: return each2<umax>;
    case GLSLstd450SMax: return each2<smax>;
    case GLSLstd450UClamp: return each3<uclamp>;
    case GLSLstd450SClamp: return each3<sclamp>;
    case GLSLstd450FindILsb: return each1<find_lsb>;
    case GLSLstd450FindUMsb: return each1<find_umsb>;
    case GLSLstd450FindSMsb: return each1<find_smsb>;
    case GLSLstd450PackUnorm4x8: return pack_norm<8, false>;
    case GLSLstd450PackSnorm4x8: return pack_norm<8, true>;
    case GLSLstd450PackUnorm2x16: return pack_norm<16, false>;
    case GLSLstd450PackSnorm2x16: return pack_norm<16, true>;
    case GLSLstd450UnpackUnorm4x8: return unpack_norm<8, false>;
    case GLSLstd450UnpackSnorm4x8: return unpack_norm<8, true>;
    case GLSLstd450UnpackUnorm2x16: return unpack_norm<16, false>;
    case GLSLstd450UnpackSnorm2x16: return unpack_norm<16, true>;
    default: return nullptr;
  }
}

}  // namespace quadrille::models::reference
