#include "models/solve/inner_products_simd.h"
#include "models/model/simd_targets.h"  // before the headers of Highway

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/solve/inner_products_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpate::simd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using ProductDoubles = hn::CappedTag<double, 8>;
using ProductVector = hn::Vec<ProductDoubles>;

// Directions at a time: their sums with four columns fill the registers.
constexpr size_t kProductDirections = HWY_TARGET == HWY_AVX3 ? 6 : 3;

template <size_t kDirections>
void inner_products_tile(const double* directions, size_t direction_stride, const double* columns, size_t column_stride,
                         size_t rows, double* shares) {
  const ProductDoubles d;
  const size_t lanes = hn::Lanes(d);
  ProductVector sums[kDirections][kProductColumns];
  for (size_t j = 0; j < kDirections; ++j) {
    for (size_t c = 0; c < kProductColumns; ++c) sums[j][c] = hn::Zero(d);
  }
  size_t i = 0;
  for (; i + lanes <= rows; i += lanes) {
    ProductVector direction[kDirections];
    for (size_t j = 0; j < kDirections; ++j) direction[j] = hn::LoadU(d, directions + j * direction_stride + i);
    for (size_t c = 0; c < kProductColumns; ++c) {
      const ProductVector column = hn::LoadU(d, columns + c * column_stride + i);
      for (size_t j = 0; j < kDirections; ++j) sums[j][c] = hn::MulAdd(direction[j], column, sums[j][c]);
    }
  }
  for (size_t j = 0; j < kDirections; ++j) {
    for (size_t c = 0; c < kProductColumns; ++c) {
      double sum = hn::GetLane(hn::SumOfLanes(d, sums[j][c]));
      for (size_t k = i; k < rows; ++k) sum += directions[j * direction_stride + k] * columns[c * column_stride + k];
      shares[j * kProductColumns + c] += sum;
    }
  }
}

void inner_products(const double* directions, size_t direction_stride, size_t count, const double* columns,
                    size_t column_stride, size_t rows, double* shares) noexcept {
  size_t j = 0;
  for (; j + kProductDirections <= count; j += kProductDirections) {
    inner_products_tile<kProductDirections>(directions + j * direction_stride, direction_stride, columns, column_stride,
                                            rows, shares + j * kProductColumns);
  }
  const double* rest = directions + j * direction_stride;
  double* rest_shares = shares + j * kProductColumns;
  switch (count - j) {
    case 5:
      return inner_products_tile<5>(rest, direction_stride, columns, column_stride, rows, rest_shares);
    case 4:
      return inner_products_tile<4>(rest, direction_stride, columns, column_stride, rows, rest_shares);
    case 3:
      return inner_products_tile<3>(rest, direction_stride, columns, column_stride, rows, rest_shares);
    case 2:
      return inner_products_tile<2>(rest, direction_stride, columns, column_stride, rows, rest_shares);
    case 1:
      return inner_products_tile<1>(rest, direction_stride, columns, column_stride, rows, rest_shares);
    default:
      return;
  }
}

void scale_column(double* column, const double* scale, size_t rows, double* squared) noexcept {
  const ProductDoubles d;
  const size_t lanes = hn::Lanes(d);
  ProductVector sum = hn::Zero(d);
  size_t i = 0;
  for (; i + lanes <= rows; i += lanes) {
    const ProductVector value = hn::Mul(hn::LoadU(d, column + i), hn::LoadU(d, scale + i));
    hn::StoreU(value, d, column + i);
    sum = hn::MulAdd(value, value, sum);
  }
  double rest = 0.0;
  for (; i < rows; ++i) {
    column[i] *= scale[i];
    rest += column[i] * column[i];
  }
  *squared += hn::GetLane(hn::SumOfLanes(d, sum)) + rest;
}

InnerProductsFunction get_inner_products() { return &inner_products; }
ScaleColumnFunction get_scale_column() { return &scale_column; }

}  // namespace HWY_NAMESPACE
}  // namespace palpate::simd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate::simd {

HWY_EXPORT(get_inner_products);
HWY_EXPORT(get_scale_column);

InnerProductsFunction inner_products_function() { return HWY_DYNAMIC_DISPATCH(get_inner_products)(); }
ScaleColumnFunction scale_column_function() { return HWY_DYNAMIC_DISPATCH(get_scale_column)(); }

}  // namespace palpate::simd
#endif
