#include "models/model/rbf/rbf_evaluate.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "engine/base/parallel.h"

namespace palpate {
PointArrays::PointArrays(const Eigen::MatrixXd& points) : count_(points.cols()) {
  assert(points.rows() >= 1 && points.rows() <= static_cast<Eigen::Index>(kMaxFeatures));
  view_.dimension = static_cast<int>(points.rows());
  const auto count = static_cast<std::size_t>(points.cols());
  view_.padded = simd::whole_vectors(count, simd::kSimdPad);
  // An odd number of cache lines between rows, so that the same index of
  // different rows does not fall into the same cache set.
  view_.stride = view_.padded + (view_.padded / simd::kSimdPad % 2 == 0 ? simd::kSimdPad : 0);
  Eigen::MatrixXd memory = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(view_.stride), points.rows());
  memory.topRows(points.cols()) = points.transpose().unaryExpr(&simd::without_denormals);
  memory_ = std::make_shared<const Eigen::MatrixXd>(std::move(memory));
  view_.coordinates = memory_->data();
}

RbfCorrection::RbfCorrection(RbfFunction function)
    : function_(std::move(function)),
      centres_(function_.centres),
      evaluate_(simd::kernel_loops(function_.kernel, function_.dimension()).evaluate) {
  assert(function_.weights.size() == function_.centre_count());
  assert(function_.tail.size() == tail_size(tail_degree(function_.kernel), function_.dimension()));
  weights_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(centres_.view().padded));
  weights_.head(function_.weights.size()) = function_.weights.unaryExpr(&simd::without_denormals);
}

void RbfCorrection::evaluate_many(const Eigen::MatrixXd& points, Eigen::VectorXd& out) const {
  assert(points.rows() == function_.dimension());
  out.resize(points.cols());
  // A part of about 1e6 kernels takes half a millisecond, enough for a thread.
  const Eigen::Index chunk = std::max<Eigen::Index>(1, 1000000 / std::max<Eigen::Index>(1, function_.centre_count()));
  const auto parts = static_cast<int>((points.cols() + chunk - 1) / chunk);
  parallel_for(parts, [&](int part) {
    const Eigen::Index end = std::min(points.cols(), (part + 1) * chunk);
    for (Eigen::Index i = part * chunk; i < end; ++i) out[i] = evaluate(points.col(i).data());
  });
}

const RbfFunction* rbf_of(const CorrectionPtr& correction) {
  const auto* rbf = dynamic_cast<const RbfCorrection*>(correction.get());
  return rbf == nullptr ? nullptr : &rbf->function();
}

void kernel_matrix(KernelKind kind, const PointArrays& points, const Eigen::Ref<const Eigen::MatrixXd>& centres,
                   Eigen::Ref<Eigen::MatrixXd> out, Eigen::Index first_row) {
  assert(first_row % static_cast<Eigen::Index>(simd::kSimdPad) == 0);
  assert(first_row + out.rows() <= points.count() && out.cols() == centres.cols());
  const simd::ColumnFunction column = simd::kernel_loops(kind, points.view().dimension).column;
  simd::Points rows = points.view();
  rows.coordinates += first_row;
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    column(rows, static_cast<std::size_t>(out.rows()), centres.col(j).data(), out.col(j).data());
}

Eigen::VectorXd kernel_product(KernelKind kind, const Eigen::MatrixXd& points, const Eigen::VectorXd& v) {
  const auto tail = tail_size(tail_degree(kind), static_cast<int>(points.rows()));
  Eigen::VectorXd product;
  RbfCorrection({kind, points, v, Eigen::VectorXd::Zero(tail)}).evaluate_many(points, product);
  return product;
}

}  // namespace palpate
