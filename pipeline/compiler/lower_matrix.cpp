/// Matrices, stored by column. The order of the sums is the one that Mesa's SPIR-V reader uses, so that
/// results agree bit by bit (docs/shader_compiler.md).
#include "pipeline/compiler/lowering.h"

#include <algorithm>
#include <utility>

namespace quadrille::pipeline {
namespace {

struct Matrix {
  std::uint32_t rows = 0, columns = 0;
  Values elements;
  [[nodiscard]] Value at(std::uint32_t row, std::uint32_t column) const {
    return elements.at(column * rows + row);
  }
};

Matrix transpose(const Matrix& m) {
  Matrix result{m.columns, m.rows, {}};
  for (std::uint32_t row = 0; row < m.rows; ++row)
    for (std::uint32_t column = 0; column < m.columns; ++column) result.elements.push_back(m.at(row, column));
  return result;
}

/// Element (row, column) as a sum that starts with the last column and adds the others down to the first.
Value last_column_first(ScalarBuilder& build, const Matrix& a, const Matrix& b, std::uint32_t row,
                        std::uint32_t column) {
  Value sum = build.fmul(a.at(row, a.columns - 1), b.at(b.rows - 1, column));
  for (std::uint32_t k = a.columns - 1; k-- > 0;)
    sum = build.fadd(build.fmul(a.at(row, k), b.at(k, column)), sum);
  return sum;
}

}  // namespace

bool Lowering::matrix(const spirv::Instruction& i) {
  const auto as_matrix = [&](Id id) {
    const spirv::Type& type = type_of(id);
    const auto size = static_cast<std::uint32_t>(value(id).size());
    return type.kind == spirv::Type::Kind::kMatrix ? Matrix{size / type.count, type.count, value(id)}
                                                   : Matrix{size, 1, value(id)};
  };
  switch (static_cast<std::uint32_t>(i.op)) {
    case spv::OpMatrixTimesScalar: {
      Values result;
      for (const Value v : value(i.operands[0])) result.push_back(build_.fmul(v, scalar(i.operands[1])));
      define(i, std::move(result));
      return true;
    }
    case spv::OpOuterProduct: {
      const Values a = value(i.operands[0]), b = value(i.operands[1]);
      Values result;
      for (const Value column : b)
        for (const Value row : a) result.push_back(build_.fmul(row, column));
      define(i, std::move(result));
      return true;
    }
    case spv::OpTranspose:
      define(i, transpose(as_matrix(i.operands[0])).elements);
      if (!transposed_.contains(i.operands[0])) transposed_.insert(i.result);
      return true;
    case spv::OpVectorTimesMatrix:
    case spv::OpMatrixTimesVector:
    case spv::OpMatrixTimesMatrix: multiply(i); return true;
    default: return false;
  }
}

/// A matrix that came as rows is multiplied by dot products of its rows; otherwise columns are scaled and
/// added. Vector times matrix is the transpose times the vector. Two matrices that came as rows are
/// multiplied as the transpose of the product of their transposes.
void Lowering::multiply(const spirv::Instruction& i) {
  const Id left = i.operands[0], right = i.operands[1];
  const auto load = [&](Id id) {
    const spirv::Type& type = type_of(id);
    const auto size = static_cast<std::uint32_t>(value(id).size());
    return type.kind == spirv::Type::Kind::kMatrix ? Matrix{size / type.count, type.count, value(id)}
                                                   : Matrix{size, 1, value(id)};
  };
  Matrix a = load(left), b = load(right);
  bool a_rows = transposed_.contains(left), b_rows = transposed_.contains(right);
  bool transpose_result = false;
  if (i.op == spv::OpVectorTimesMatrix) {
    std::swap(a, b);
    a = transpose(a);
    a_rows = !b_rows;
    b_rows = false;
  } else if (a_rows && b_rows) {
    std::swap(a, b);
    a = transpose(a);
    b = transpose(b);
    a_rows = b_rows = false;
    transpose_result = true;
  }
  Matrix product{a.rows, b.columns, {}};
  for (std::uint32_t column = 0; column < b.columns; ++column)
    for (std::uint32_t row = 0; row < a.rows; ++row) {
      if (!a_rows || b_rows) {
        product.elements.push_back(last_column_first(build_, a, b, row, column));
        continue;
      }
      Values row_values, column_values;
      for (std::uint32_t k = 0; k < a.columns; ++k) {
        row_values.push_back(a.at(row, k));
        column_values.push_back(b.at(k, column));
      }
      product.elements.push_back(dot(row_values, column_values));
    }
  if (transpose_result) {
    product = transpose(product);
    transposed_.insert(i.result);
  }
  define(i, std::move(product.elements));
}

/// Determinant of a square matrix by cofactors of the first column, with the groupings of the reference
/// implementation.
Value Lowering::determinant(const Values& m, int size) {
  const auto at = [&](int column, int row) { return m[static_cast<std::size_t>(column * size + row)]; };
  if (size == 2) return build_.fsub(build_.fmul(at(0, 0), at(1, 1)), build_.fmul(at(0, 1), at(1, 0)));
  if (size == 3) {
    Value term[3];
    for (int r = 0; r < 3; ++r) {
      const int y = (r + 1) % 3, z = (r + 2) % 3;
      term[r] = build_.fsub(build_.fmul(at(0, r), build_.fmul(at(1, y), at(2, z))),
                            build_.fmul(at(0, r), build_.fmul(at(1, z), at(2, y))));
    }
    return build_.fadd(term[0], build_.fadd(term[1], term[2]));
  }
  Value product[4];
  for (int r = 0; r < 4; ++r) {
    Values minor;
    for (int c = 1; c < 4; ++c)
      for (int k = 0; k < 4; ++k)
        if (k != r) minor.push_back(at(c, k));
    product[r] = build_.fmul(at(0, r), determinant(minor, 3));
  }
  return build_.fadd(build_.fsub(product[0], product[1]), build_.fsub(product[2], product[3]));
}

/// Adjugate times the reciprocal of the determinant.
Values Lowering::inverse(const Values& m, int size) {
  const Value reciprocal = build_.emit(models::Op::kFRcp, determinant(m, size));
  Values result;
  for (int column = 0; column < size; ++column)
    for (int row = 0; row < size; ++row) {
      Values minor;
      for (int c = 0; c < size; ++c)
        for (int r = 0; r < size; ++r)
          if (c != row && r != column) minor.push_back(m[static_cast<std::size_t>(c * size + r)]);
      Value cofactor = size == 2 ? minor[0] : determinant(minor, size - 1);
      if ((row + column) % 2 != 0) cofactor = build_.fneg(cofactor);
      result.push_back(build_.fmul(cofactor, reciprocal));
    }
  return result;
}

}  // namespace quadrille::pipeline
