#include "models/recordings/common_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tick/sensor_identification.h"
#include "models/linear/non_negative.h"

namespace palpate {
namespace {

constexpr int kElastic = 24;
constexpr int kBranch = 6;
constexpr int kViscous = 6;
constexpr std::array kTimes_s{0.03, 0.3, 3.0};
constexpr int kFirstBranch = 2 + 2 + kElastic;  // constants, beyond both ends, inside
constexpr int kFirstViscous = kFirstBranch + kBranch * static_cast<int>(kTimes_s.size());
constexpr int kColumns = kFirstViscous + kViscous;
constexpr double kForceShare = 0.03;
constexpr double kHuberLimit = 3.0;
constexpr int kPasses = 3;
constexpr double kIdleScale = 0.1;

// Integral of a hat: rises from 0 to 1 within one knot to either side.
double rise(double u) {
  if (u <= -1.0) return 0.0;
  if (u >= 1.0) return 1.0;
  return u < 0.0 ? 0.5 * (u + 1.0) * (u + 1.0) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

double hat(double u) { return std::max(0.0, 1.0 - std::abs(u)); }

// Position and velocity at any time, by cubic Hermite interpolation between the rows.
class MotionAt {
 public:
  explicit MotionAt(const std::vector<SurfaceRow>& rows) : rows_(rows) {}

  MotionEstimate operator()(double time_s) {
    while (at_ + 2 < rows_.size() && rows_[at_ + 1].sample.time_s <= time_s) ++at_;
    const SurfaceRow& a = rows_[at_];
    const SurfaceRow& b = rows_[at_ + 1];
    const double step_s = b.sample.time_s - a.sample.time_s;
    const double u = std::clamp((time_s - a.sample.time_s) / step_s, 0.0, 1.0);
    const double step_m = b.motion.position_m - a.motion.position_m;
    const double c = step_s * a.motion.velocity_m_per_s - step_m;
    const double d = -step_s * b.motion.velocity_m_per_s + step_m;
    return {a.motion.position_m + u * step_m + u * (1.0 - u) * (c * (1.0 - u) + d * u),
            a.motion.velocity_m_per_s + u * (b.motion.velocity_m_per_s - a.motion.velocity_m_per_s)};
  }

 private:
  const std::vector<SurfaceRow>& rows_;
  std::size_t at_ = 0;
};

}  // namespace

// Fills all columns of a row but those of the branches.
void CommonFit::put_row(double z_m, double velocity_m_per_s, double* row) const {
  const double range_m = high_m_ - low_m_;
  const double x = (z_m - low_m_) / range_m;
  row[0] = 1.0;
  row[1] = -1.0;
  row[2] = std::min(0.0, x);
  row[3] = std::max(0.0, x - 1.0);
  for (int k = 0; k < kElastic; ++k) row[4 + k] = rise(x * kElastic - (k + 0.5));
  for (int k = 0; k < kViscous; ++k)
    row[kFirstViscous + k] = velocity_m_per_s * hat(std::clamp(x, 0.0, 1.0) * (kViscous - 1) - k);
}

CommonFit::Member CommonFit::member(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s) const {
  Member made;
  const auto count = static_cast<Eigen::Index>(rows.size());
  made.design.resize(count, kColumns);
  made.force_N.resize(count);
  made.scale.resize(count);
  made.block = blocks_by_path(rows, kBlocks);
  MotionAt motion_at(rows);
  std::array<double, kBranch> drive{};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto i = static_cast<Eigen::Index>(r);
    const MotionEstimate motion = lag_s == 0.0 ? rows[r].motion : motion_at(rows[r].sample.time_s - lag_s);
    double* row = made.design.row(i).data();
    put_row(motion.position_m - offset_m, motion.velocity_m_per_s, row);
    const double step_s = r > 0 ? rows[r].sample.time_s - rows[r - 1].sample.time_s : 0.0;
    for (std::size_t t = 0; t < kTimes_s.size(); ++t) {
      const double keep = std::exp(-step_s / kTimes_s[t]);
      const double gain = r > 0 ? kTimes_s[t] * (1.0 - keep) / step_s : 0.0;
      double* state = row + kFirstBranch + kBranch * static_cast<int>(t);
      const double* before = state - kColumns;
      for (int k = kBranch; k-- > 0;) {
        const double rising = rise((motion.position_m - offset_m - low_m_) / (high_m_ - low_m_) * kBranch - (k + 0.5));
        const auto at = static_cast<std::size_t>(k);
        state[k] = r > 0 ? keep * before[k] + gain * (rising - drive[at]) : 0.0;
        if (t + 1 == kTimes_s.size()) drive[at] = rising;
      }
    }
    made.force_N(i) = rows[r].force_N;
    made.scale(i) = 1.0 / (no_force_N(noise_N_) + kForceShare * std::abs(rows[r].force_N));
  }
  return made;
}

// Contact is one-sided: where no force is measured the fit may be below 0.
bool CommonFit::is_idle(double force_N, double predicted_N) const {
  return predicted_N < 0.0 && std::abs(force_N) <= no_force_N(noise_N_);
}

double CommonFit::error(const Member& member, Eigen::Index i, double predicted_N) const {
  const double force_N = member.force_N(i);
  return is_idle(force_N, predicted_N) ? 0.0 : (force_N - predicted_N) * member.scale(i);
}

void CommonFit::add_equations(const Member& member, const Eigen::VectorXd& x, Eigen::MatrixXd& gram,
                              Eigen::VectorXd& right_side) const {
  Eigen::VectorXd scale = member.scale;
  if (x.size() > 0) {
    const Eigen::VectorXd predicted_N = member.design * x;
    for (Eigen::Index i = 0; i < scale.size(); ++i) {
      // An idle row counts a hundredth: without any the next fit would be free there.
      if (is_idle(member.force_N(i), predicted_N(i))) scale(i) *= kIdleScale;
      const double size = std::abs(error(member, i, predicted_N(i)));
      scale(i) *= std::sqrt(std::min(1.0, kHuberLimit / std::max(size, 1e-12)));
    }
  }
  const Design scaled = scale.asDiagonal() * member.design;
  gram.noalias() += scaled.transpose() * scaled;
  right_side.noalias() += scaled.transpose() * scale.cwiseProduct(member.force_N);
}

void CommonFit::add(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s) {
  members_.push_back(member(rows, offset_m, lag_s));
  Eigen::VectorXd x;
  for (int pass = 0; pass <= kPasses; ++pass) {
    gram_.setZero(kColumns, kColumns);
    right_side_.setZero(kColumns);
    for (const Member& one : members_) add_equations(one, x, gram_, right_side_);
    if (pass < kPasses) x = solve_non_negative(gram_, right_side_);
  }
}

BlockCosts CommonFit::residual(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s) const {
  const Member tried = member(rows, offset_m, lag_s);
  Eigen::VectorXd x;
  for (int pass = 0; pass < kPasses; ++pass) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(kColumns, kColumns);
    Eigen::VectorXd right_side = Eigen::VectorXd::Zero(kColumns);
    if (!members_.empty()) {
      gram = gram_;
      right_side = right_side_;
    }
    add_equations(tried, x, gram, right_side);
    x = solve_non_negative(gram, right_side);
  }
  BlockCosts costs(members_.empty() ? kBlocks : 2 * kBlocks, 0.0);
  const auto count = [&](const Member& one, std::size_t first_block) {
    const Eigen::VectorXd predicted_N = one.design * x;
    for (Eigen::Index i = 0; i < one.force_N.size(); ++i) {
      costs[first_block + one.block[static_cast<std::size_t>(i)]] += huber(error(one, i, predicted_N(i)), kHuberLimit);
    }
  };
  count(tried, 0);
  for (const Member& one : members_) count(one, kBlocks);
  return costs;
}

}  // namespace palpate
