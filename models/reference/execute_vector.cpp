/// Float operations of the interpreter that take vectors and matrices as a whole, and derivatives, which take
/// the quad as a whole.
#include <spirv/unified1/GLSL.std.450.h>

#include <cmath>
#include <spirv/unified1/spirv.hpp>

#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

double dot_of(const Operation& o, Lanes& lanes, Slot a, Slot b, int lane) {
  double sum = 0;
  for (std::uint32_t i = 0; i < o.n; ++i) sum += lanes.cells[a + i].f(lane) * lanes.cells[b + i].f(lane);
  return sum;
}

void dot(const Operation& o, Lanes& lanes) {
  Cell r;
  for (int l = 0; l < kLanes; ++l) r.set_f(l, dot_of(o, lanes, o.src[0], o.src[1], l));
  write(lanes, *lanes.at(o.dst), r);
}

void length(const Operation& o, Lanes& lanes) {
  Cell r;
  for (int l = 0; l < kLanes; ++l) r.set_f(l, std::sqrt(dot_of(o, lanes, o.src[0], o.src[0], l)));
  write(lanes, *lanes.at(o.dst), r);
}

void distance(const Operation& o, Lanes& lanes) {
  Cell r;
  for (int l = 0; l < kLanes; ++l) {
    double sum = 0;
    for (std::uint32_t i = 0; i < o.n; ++i) {
      const double d = lanes.cells[o.src[0] + i].f(l) - lanes.cells[o.src[1] + i].f(l);
      sum += d * d;
    }
    r.set_f(l, std::sqrt(sum));
  }
  write(lanes, *lanes.at(o.dst), r);
}

void normalize(const Operation& o, Lanes& lanes) {
  std::array<double, kLanes> size{};
  for (std::size_t l = 0; l < kLanes; ++l)
    size[l] = std::sqrt(dot_of(o, lanes, o.src[0], o.src[0], static_cast<int>(l)));
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    return lanes.cells[o.src[0] + i].f(l) / size[static_cast<std::size_t>(l)];
  });
}

void cross(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, 3, [&](std::uint32_t i, int l) {
    const std::uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
    return lanes.cells[o.src[0] + j].f(l) * lanes.cells[o.src[1] + k].f(l) -
           lanes.cells[o.src[0] + k].f(l) * lanes.cells[o.src[1] + j].f(l);
  });
}

void face_forward(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    const double n = lanes.cells[o.src[0] + i].f(l);
    return dot_of(o, lanes, o.src[2], o.src[1], l) < 0 ? n : -n;
  });
}

void reflect(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    return lanes.cells[o.src[0] + i].f(l) -
           2.0 * dot_of(o, lanes, o.src[1], o.src[0], l) * lanes.cells[o.src[1] + i].f(l);
  });
}

void refract(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    const double eta = lanes.cells[o.src[2]].f(l), cosine = dot_of(o, lanes, o.src[1], o.src[0], l);
    const double k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    return k < 0 ? 0.0
                 : eta * lanes.cells[o.src[0] + i].f(l) -
                       (eta * cosine + std::sqrt(k)) * lanes.cells[o.src[1] + i].f(l);
  });
}

// Matrices are column-major: element (column, row) is cell column * rows + row.

void matrix_times_vector(const Operation& o, Lanes& lanes) {
  const std::uint32_t rows = o.imm[1], columns = o.n / rows;
  vector_result(o, lanes, rows, [&](std::uint32_t row, int l) {
    double sum = 0;
    for (std::uint32_t c = 0; c < columns; ++c)
      sum += lanes.cells[o.src[0] + c * rows + row].f(l) * lanes.cells[o.src[1] + c].f(l);
    return sum;
  });
}

void vector_times_matrix(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.imm[0], [&](std::uint32_t column, int l) {
    return dot_of(o, lanes, o.src[0], o.src[1] + column * o.n, l);
  });
}

void matrix_times_matrix(const Operation& o, Lanes& lanes) {
  const std::uint32_t rows = o.imm[1], inner = o.n / rows;
  vector_result(o, lanes, o.imm[0], [&](std::uint32_t i, int l) {
    const std::uint32_t column = i / rows, row = i % rows;
    double sum = 0;
    for (std::uint32_t k = 0; k < inner; ++k)
      sum += lanes.cells[o.src[0] + k * rows + row].f(l) * lanes.cells[o.src[1] + column * inner + k].f(l);
    return sum;
  });
}

void outer_product(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.imm[0], [&](std::uint32_t i, int l) {
    return lanes.cells[o.src[0] + i % o.n].f(l) * lanes.cells[o.src[1] + i / o.n].f(l);
  });
}

void transpose(const Operation& o, Lanes& lanes) {
  const std::uint32_t rows = o.imm[1], columns = o.n / rows;
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    return lanes.cells[o.src[0] + (i % columns) * rows + i / columns].f(l);
  });
}

/// Determinant of the matrix without the rows and columns whose bits are clear in the masks, by expansion
/// along its first remaining column.
double minor_of(const Operation& o, Lanes& lanes, unsigned rows_left, unsigned columns_left, int lane) {
  if (columns_left == 0) return 1.0;
  const auto size = o.imm[1];
  const auto column = static_cast<std::uint32_t>(std::countr_zero(columns_left));
  double sum = 0, sign_of_term = 1;
  for (std::uint32_t row = 0; row < size; ++row) {
    if ((rows_left >> row & 1u) == 0) continue;
    sum += sign_of_term * lanes.cells[o.src[0] + column * size + row].f(lane) *
           minor_of(o, lanes, rows_left & ~(1u << row), columns_left & (columns_left - 1), lane);
    sign_of_term = -sign_of_term;
  }
  return sum;
}

void determinant(const Operation& o, Lanes& lanes) {
  const unsigned all = (1u << o.imm[1]) - 1;
  vector_result(o, lanes, 1, [&](std::uint32_t, int l) { return minor_of(o, lanes, all, all, l); });
}

void matrix_inverse(const Operation& o, Lanes& lanes) {
  const std::uint32_t size = o.imm[1];
  const unsigned all = (1u << size) - 1;
  std::array<double, kLanes> whole{};
  for (std::size_t l = 0; l < kLanes; ++l) whole[l] = minor_of(o, lanes, all, all, static_cast<int>(l));
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    const std::uint32_t column = i / size, row = i % size;
    const double cofactor = minor_of(o, lanes, all & ~(1u << column), all & ~(1u << row), l);
    return ((column + row) % 2 == 0 ? cofactor : -cofactor) / whole[static_cast<std::size_t>(l)];
  });
}

// Derivatives: lanes are (0,0) (1,0) (0,1) (1,1). Fine ones are those of a lane's own row or column, coarse
// ones are lane 0's; the plain ones may be either and are fine here. [VK1.3 #shaders-derivative-operations]

template <int kAxis, bool kFine>
double derivative(const Cell& c, int lane) {
  const int step = kAxis == 0 ? 1 : 2;
  const int base = kFine ? lane & ~step : 0;
  return c.f(base + step) - c.f(base);
}

template <int kAxis, bool kFine>
void derive(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    return derivative<kAxis, kFine>(lanes.cells[o.src[0] + i], l);
  });
}

template <bool kFine>
void width(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    const Cell& c = lanes.cells[o.src[0] + i];
    return std::abs(derivative<0, kFine>(c, l)) + std::abs(derivative<1, kFine>(c, l));
  });
}

}  // namespace

Handler vector_handler(std::uint32_t op) {
  switch (op) {
    case spv::OpDot: return dot;
    case spv::OpMatrixTimesVector: return matrix_times_vector;
    case spv::OpVectorTimesMatrix: return vector_times_matrix;
    case spv::OpMatrixTimesMatrix: return matrix_times_matrix;
    case spv::OpOuterProduct: return outer_product;
    case spv::OpTranspose: return transpose;
    case spv::OpDPdx:
    case spv::OpDPdxFine: return derive<0, true>;
    case spv::OpDPdy:
    case spv::OpDPdyFine: return derive<1, true>;
    case spv::OpDPdxCoarse: return derive<0, false>;
    case spv::OpDPdyCoarse: return derive<1, false>;
    case spv::OpFwidth:
    case spv::OpFwidthFine: return width<true>;
    case spv::OpFwidthCoarse: return width<false>;
    default: return nullptr;
  }
}

Handler glsl_vector_handler(std::uint32_t instruction) {
  switch (instruction) {
    case GLSLstd450Determinant: return determinant;
    case GLSLstd450MatrixInverse: return matrix_inverse;
    case GLSLstd450Length: return length;
    case GLSLstd450Distance: return distance;
    case GLSLstd450Cross: return cross;
    case GLSLstd450Normalize: return normalize;
    case GLSLstd450FaceForward: return face_forward;
    case GLSLstd450Reflect: return reflect;
    case GLSLstd450Refract: return refract;
    default: return nullptr;
  }
}

}  // namespace quadrille::models::reference
