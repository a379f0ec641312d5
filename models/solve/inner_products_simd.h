// Inner products of a few columns with many, the loop of the forward selection: a library's
// matrix product would copy all operands first, and take the columns that lack the most
// for the measure of all. One variant per instruction set as in models/model/rbf/rbf_simd.h.
#pragma once

#include <cstddef>

namespace palpate::simd {

inline constexpr std::size_t kProductColumns = 4;

// shares[4 j + c] += sum_i directions[j * direction_stride + i] columns[c * column_stride + i]
// for i < rows, j < count, c < 4. All sums are double, in an order that depends on the
// instruction set and `rows` alone.
using InnerProductsFunction = void (*)(const double* directions, std::size_t direction_stride, std::size_t count,
                                       const double* columns, std::size_t column_stride, std::size_t rows,
                                       double* shares) noexcept;

// column[i] *= scale[i] for i < rows; `squared` grows by the sum of their squares.
using ScaleColumnFunction = void (*)(double* column, const double* scale, std::size_t rows, double* squared) noexcept;

InnerProductsFunction inner_products_function();
ScaleColumnFunction scale_column_function();

}  // namespace palpate::simd
