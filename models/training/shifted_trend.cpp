#include "models/training/shifted_trend.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/jnd.h"
#include "models/model/trend.h"
#include "models/training/fit_trend.h"

namespace palpate {
namespace {

constexpr int kActivePasses = 4;
// Longer strokes are cut into pieces, so that a single press has folds too.
constexpr std::size_t kPiecesOfARecording = 24;

// The columns of active rows, gathered into blocks.
class SumBlock {
 public:
  explicit SumBlock(RowSums& sums) : sums_(sums), block_(sums.gram.rows() + 1, kBlock) {}

  void add(const double* row, double scale, double force_N) {
    const Eigen::Index n = sums_.gram.rows();
    block_.col(filled_).head(n) = scale * Eigen::Map<const Eigen::VectorXd>(row, n);
    block_(n, filled_) = scale * force_N;
    if (++filled_ == kBlock) flush();
  }

  void flush() {
    const Eigen::Index n = sums_.gram.rows();
    const auto basis = block_.topLeftCorner(n, filled_);
    const auto force = block_.row(n).head(filled_);
    sums_.gram.noalias() += basis * basis.transpose();
    sums_.right_side.noalias() += basis * force.transpose();
    sums_.squares += force.squaredNorm();
    sums_.count += static_cast<double>(filled_);
    filled_ = 0;
  }

 private:
  static constexpr Eigen::Index kBlock = 256;
  RowSums& sums_;
  Eigen::MatrixXd block_;
  Eigen::Index filled_ = 0;
};

RowSums sums_of(const TrendRows& rows, const std::vector<double>& scale, const std::vector<char>& active,
                std::size_t begin, std::size_t end) {
  RowSums sums(static_cast<Eigen::Index>(rows.columns()));
  SumBlock block(sums);
  double idle_squares = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    if (active[i]) {
      block.add(rows.row(i), scale[i], rows.force_N(i));
    } else {
      idle_squares += scale[i] * scale[i] * rows.force_N(i) * rows.force_N(i);
    }
  }
  block.flush();
  sums.squares += idle_squares;
  return sums;
}

double predicted_N(const TrendRows& rows, std::size_t index, const Eigen::VectorXd& x) {
  return Eigen::Map<const Eigen::VectorXd>(rows.row(index), x.size()).dot(x);
}

}  // namespace

RowSums::RowSums(Eigen::Index columns)
    : gram(Eigen::MatrixXd::Zero(columns, columns)), right_side(Eigen::VectorXd::Zero(columns)) {}

RowSums& RowSums::operator+=(const RowSums& other) {
  gram += other.gram;
  right_side += other.right_side;
  squares += other.squares;
  count += other.count;
  return *this;
}

RowSums& RowSums::operator-=(const RowSums& other) {
  gram -= other.gram;
  right_side -= other.right_side;
  squares -= other.squares;
  count -= other.count;
  return *this;
}

double RowSums::residual(const Eigen::VectorXd& x) const {
  return squares - 2.0 * right_side.dot(x) + x.dot(gram * x);
}

double RowSums::least() const { return residual(solve_non_negative(gram, right_side)); }

Eigen::Index TrendForm::columns() const {
  const std::size_t viscous = thinning_velocity_m_per_s > 0.0 ? 2 * kViscosityCoefficients : 0;
  return static_cast<Eigen::Index>(kElasticCoefficients + viscous + kBranchTerms * relaxation_times_s.size());
}

TrendRows shifted_rows(const std::vector<SurfaceRow>& rows, double offset_m, double step_m, const TrendForm& form,
                       double* air_squares) {
  TrendRows basis(form.reference_depth_m, form.thinning_velocity_m_per_s, form.relaxation_times_s);
  basis.begin_recording();
  const JndLine jnd;
  int stroke = 0;
  bool was_in_contact = false;
  double air = 0.0;
  for (const SurfaceRow& row : rows) {
    ToolSample sample = row.sample;
    MotionEstimate motion = row.motion;
    sample.position_m -= offset_m;
    motion.position_m -= offset_m + step_m;
    const bool in_contact = sample.position_m > 0.0;
    if (in_contact && !was_in_contact) ++stroke;
    was_in_contact = in_contact;
    if (in_contact && row.sample.position_m < form.deepest_m) {
      basis.add(sample, motion, row.force_N, stroke);
      continue;
    }
    basis.advance(sample, motion);
    if (!in_contact && row.sample.position_m > form.farthest_m) {
      const double scaled = row.force_N / jnd.at(row.force_N);
      air += scaled * scaled;
    }
  }
  if (air_squares != nullptr) *air_squares = air;
  return basis;
}

ShiftedTrend fit_shifted_trend(const std::vector<SurfaceRow>& rows, double offset_m, const TrendForm& form,
                               bool with_folds) {
  double air_squares = 0.0;
  const TrendRows basis = shifted_rows(rows, offset_m, 0.0, form, &air_squares);
  const JndLine jnd;
  std::vector<double> scale(basis.count());
  for (std::size_t i = 0; i < basis.count(); ++i) scale[i] = 1.0 / jnd.at(basis.force_N(i));
  std::vector<char> active(basis.count(), 1);
  ShiftedTrend fitted;
  for (int pass = 0; pass < kActivePasses; ++pass) {
    const RowSums sums = sums_of(basis, scale, active, 0, basis.count());
    fitted.x = solve_non_negative(sums.gram, sums.right_side);
    fitted.cost = air_squares + std::max(0.0, sums.residual(fitted.x));
    bool changed = false;
    for (std::size_t i = 0; i < basis.count(); ++i) {
      if (basis.force_N(i) > form.no_force_N) continue;
      const char counts = predicted_N(basis, i, fitted.x) > 0.0 ? 1 : 0;
      changed = changed || counts != active[i];
      active[i] = counts;
    }
    if (!changed) break;
  }
  if (!with_folds) return fitted;
  fitted.folds.assign(kSurfaceFolds, RowSums(form.columns()));
  const std::size_t longest = basis.count() / kPiecesOfARecording + 1;
  std::size_t piece = 0;
  for (std::size_t begin = 0; begin < basis.count();) {
    std::size_t end = begin;
    while (end < basis.count() && basis.stroke(end) == basis.stroke(begin) && end - begin < longest) ++end;
    fitted.folds[piece++ % kSurfaceFolds] += sums_of(basis, scale, active, begin, end);
    begin = end;
  }
  // Air says the same of every coefficient, but not of every offset.
  for (RowSums& fold : fitted.folds) fold.squares += air_squares / static_cast<double>(kSurfaceFolds);
  return fitted;
}

}  // namespace palpate
