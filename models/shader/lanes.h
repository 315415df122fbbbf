/// Eight lanes of a warp in one AVX2 register, as floats or as 32-bit words: the thinnest wrapper that lets
/// operations read like arithmetic.
///
/// A 128-bit half holds one quad, so shuffles inside a half are exchanges between the pixels of a quad.
#pragma once

#include "models/shader/isa.h"

#include <immintrin.h>

#include <cstdint>

namespace quadrille::models {

inline constexpr int kGroupLanes = 8;
inline constexpr int kWarpGroups = kWarpLanes / kGroupLanes;

struct Floats {
  __m256 v;
};
struct Words {
  __m256i v;
};

/// Bits that have not been given a type yet.
struct Lanes {
  __m256i bits;
  Lanes(Floats f) : bits(_mm256_castps_si256(f.v)) {}              // NOLINT(google-explicit-constructor)
  Lanes(Words w) : bits(w.v) {}                                    // NOLINT(google-explicit-constructor)
  operator Floats() const { return {_mm256_castsi256_ps(bits)}; }  // NOLINT(google-explicit-constructor)
  operator Words() const { return {bits}; }                        // NOLINT(google-explicit-constructor)
};

inline Floats as_floats(Words w) { return {_mm256_castsi256_ps(w.v)}; }
inline Words as_words(Floats f) { return {_mm256_castps_si256(f.v)}; }
inline Floats splat(float x) { return {_mm256_set1_ps(x)}; }
inline Words splat_word(std::uint32_t x) { return {_mm256_set1_epi32(static_cast<int>(x))}; }

inline Words load_words(const void* p) { return {_mm256_loadu_si256(static_cast<const __m256i*>(p))}; }
inline Floats load_floats(const void* p) { return as_floats(load_words(p)); }
inline void store(void* p, Lanes x) { _mm256_storeu_si256(static_cast<__m256i*>(p), x.bits); }

inline Floats operator+(Floats a, Floats b) { return {_mm256_add_ps(a.v, b.v)}; }
inline Floats operator-(Floats a, Floats b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline Floats operator*(Floats a, Floats b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline Floats operator/(Floats a, Floats b) { return {_mm256_div_ps(a.v, b.v)}; }
/// a * b + c, rounded once.
inline Floats fused(Floats a, Floats b, Floats c) { return {_mm256_fmadd_ps(a.v, b.v, c.v)}; }

// The same with the order of operands kept: when several are NaN, the first one's bits go on. Compilers swap
// the operands of + and * as they like, differently in each instance of a kernel, and the bits of a NaN are
// visible to integer operations; the value of a lane must not depend on who shares its warp.
inline Floats ordered_add(Floats a, Floats b) {
  asm("vaddps %1, %0, %0" : "+x"(a.v) : "x"(b.v));
  return a;
}
inline Floats ordered_multiply(Floats a, Floats b) {
  asm("vmulps %1, %0, %0" : "+x"(a.v) : "x"(b.v));
  return a;
}
inline Floats ordered_fused(Floats a, Floats b, Floats c) {
  asm("vfmadd213ps %2, %1, %0" : "+x"(a.v) : "x"(b.v), "x"(c.v));
  return a;
}

inline Floats square_root(Floats a) { return {_mm256_sqrt_ps(a.v)}; }
template <int kRounding>
Floats round_to(Floats a) {
  return {_mm256_round_ps(a.v, kRounding | _MM_FROUND_NO_EXC)};
}
template <int kPredicate>
Words compare(Floats a, Floats b) {
  return as_words({_mm256_cmp_ps(a.v, b.v, kPredicate)});
}

inline Words operator+(Words a, Words b) { return {_mm256_add_epi32(a.v, b.v)}; }
inline Words operator-(Words a, Words b) { return {_mm256_sub_epi32(a.v, b.v)}; }
inline Words operator&(Words a, Words b) { return {_mm256_and_si256(a.v, b.v)}; }
inline Words operator|(Words a, Words b) { return {_mm256_or_si256(a.v, b.v)}; }
inline Words operator^(Words a, Words b) { return {_mm256_xor_si256(a.v, b.v)}; }
inline Words operator~(Words a) { return a ^ splat_word(~0u); }
inline Words equal(Words a, Words b) { return {_mm256_cmpeq_epi32(a.v, b.v)}; }
inline Words greater_signed(Words a, Words b) { return {_mm256_cmpgt_epi32(a.v, b.v)}; }
template <int kCount>
Words shift_left(Words a) {
  return {_mm256_slli_epi32(a.v, kCount)};
}
template <int kCount>
Words shift_right(Words a) {
  return {_mm256_srli_epi32(a.v, kCount)};
}
/// truncates; 0x80000000 outside the range
inline Words to_integers(Floats a) { return {_mm256_cvttps_epi32(a.v)}; }
/// signed, rounded to nearest even
inline Floats to_floats(Words a) { return {_mm256_cvtepi32_ps(a.v)}; }

/// mask ? a : b; each lane of `mask` is all ones or zero.
inline Lanes choose(Words mask, Lanes a, Lanes b) {
  return Words{_mm256_blendv_epi8(b.bits, a.bits, mask.v)};
}

/// Bit i = lane i of the group has a bit set.
inline std::uint32_t nonzero_bits(Words a) {
  const Words zero = equal(a, splat_word(0));
  return ~static_cast<std::uint32_t>(_mm256_movemask_ps(as_floats(zero).v)) & 0xffu;
}

/// All ones in the lanes of group `group` whose bit is set in a warp's mask.
inline Words expand_mask(std::uint32_t mask, int group) {
  const Words bit{_mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128)};
  const Words bits = splat_word(mask >> (group * kGroupLanes)) & bit;
  return equal(bits, bit);
}

}  // namespace quadrille::models
