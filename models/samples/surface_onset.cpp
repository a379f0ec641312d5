#include "models/samples/surface_onset.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "models/linear/non_negative.h"
#include "models/samples/profile_search.h"
#include "models/samples/surface_estimate.h"

namespace palpate {
namespace {

// A touch reaches from kTouchOut_m outside of its first force to kTouchIn_m inside.
constexpr double kTouchOut_m = 1e-3;
constexpr double kTouchIn_m = 2e-3;
// An approach without force over this distance begins in free air.
constexpr double kAirBefore_m = 0.5 * kTouchOut_m;
// A retreat slower than this is jitter of an approach.
constexpr double kBackward_m_per_s = 2e-3;
// Rows of a slow touch beyond this many are thinned.
constexpr std::size_t kMostTouchRows = 300;
// The search ends this far inside of the first force, which comes late where the onset is soft.
constexpr double kScanIn_m = 0.3e-3;
constexpr double kCoarseStep_m = 0.05e-3;
constexpr double kScale_m = 1e-3;  // x in mm: columns of similar size
// The force law may be convex or concave but rises up to x = kFlat (in units of kScale_m).
constexpr double kFlat = 3.0;
constexpr Eigen::Index kTerms = 2;
// The exponent of the force law: a flat or rough contact, or a sphere on a soft solid (Hertz, 1881).
constexpr double kLinear = 1.0;
constexpr double kBall = 1.5;
// A difference of chi^2 above this, two standard errors, selects an exponent. Below it, half the difference of the two
// onsets adds to the standard error.
constexpr double kClearDrop = kSignificantErrors * kSignificantErrors;
// Force begins with this many consecutive rows above the threshold.
constexpr std::size_t kForceRun = 3;

class OnsetCost {
 public:
  OnsetCost(const std::vector<Sample>& rows, const std::vector<Touch>& touches, double zero_N, double exponent)
      : zero_N_(zero_N), exponent_(exponent) {
    for (const Touch& touch : touches) {
      const std::size_t stride = (touch.end - touch.begin) / kMostTouchRows + 1;
      std::vector<const Sample*> kept;
      for (std::size_t i = touch.begin; i < touch.end; i += stride) kept.push_back(&rows[i]);
      count_ += static_cast<double>(kept.size());
      touches_.push_back(std::move(kept));
    }
  }

  // J(d0), N^2.
  double at(double offset_m) const {
    double cost = 0.0;
    for (const auto& touch : touches_) cost += touch_cost(touch, offset_m);
    return cost;
  }

  double degrees_of_freedom() const {
    return std::max(1.0, count_ - 1.0 - static_cast<double>(kTerms) * static_cast<double>(touches_.size()));
  }

 private:
  double touch_cost(const std::vector<const Sample*>& touch, double offset_m) const {
    Eigen::Matrix<double, kTerms, kTerms> gram = Eigen::Matrix<double, kTerms, kTerms>::Zero();
    Eigen::Matrix<double, kTerms, 1> right_side = Eigen::Matrix<double, kTerms, 1>::Zero();
    double squares = 0.0;
    const double bend = exponent_ / ((exponent_ + 1.0) * kFlat);  // the slope is 0 at kFlat
    for (const Sample* row : touch) {
      const double force_N = row->force_N - zero_N_;
      squares += force_N * force_N;
      const double x = (row->motion.position_m - offset_m) / kScale_m;
      if (!(x > 0.0)) continue;
      const double power = exponent_ == kLinear ? x : x * std::sqrt(x);
      const Eigen::Matrix<double, kTerms, 1> term(power * (1.0 - bend * x), power * bend * x);
      gram += term * term.transpose();
      right_side += term * force_N;
    }
    const Eigen::VectorXd best = solve_non_negative(gram, right_side);
    return squares - 2.0 * right_side.dot(best) + best.dot(gram * best);
  }

  double zero_N_;
  double exponent_;
  double count_ = 0.0;
  std::vector<std::vector<const Sample*>> touches_;
};

// Returns the first row of the approach that contains the row `at`.
std::size_t approach_begin(const std::vector<Sample>& rows, std::size_t at, double outermost_m) {
  while (at > 0 && rows[at - 1].motion.position_m > outermost_m &&
         rows[at - 1].motion.velocity_m_per_s > -kBackward_m_per_s) {
    --at;
  }
  return at;
}

std::size_t approach_end(const std::vector<Sample>& rows, std::size_t at, double innermost_m) {
  while (at < rows.size() && rows[at].motion.position_m < innermost_m &&
         rows[at].motion.velocity_m_per_s > -kBackward_m_per_s) {
    ++at;
  }
  return at;
}

struct FormOnset {
  double at_m = 0.0;
  double cost = 0.0;       // N^2
  double curvature = 0.0;  // N^2/m^2
  double degrees_of_freedom = 1.0;
};

FormOnset onset_of_form(const OnsetCost& cost, double first_force_m) {
  FormOnset onset{first_force_m, kUnknownError, 0.0, cost.degrees_of_freedom()};
  const auto scan = [&](double from_m, double to_m, double step_m) {
    for (double at_m = from_m; at_m < to_m + 0.5 * step_m; at_m += step_m) {
      const double value = cost.at(at_m);
      if (value >= onset.cost) continue;
      onset.cost = value;
      onset.at_m = at_m;
    }
  };
  scan(first_force_m - kTouchOut_m, first_force_m + kScanIn_m, kCoarseStep_m);
  for (double step_m = kCoarseStep_m; step_m > kFinest_m;) {
    const double around_m = onset.at_m;
    step_m *= 0.25;
    scan(around_m - 4.0 * step_m, around_m + 4.0 * step_m, step_m);
  }
  onset.curvature = (cost.at(onset.at_m - kLeastOffset_m) + cost.at(onset.at_m + kLeastOffset_m) - 2.0 * onset.cost) /
                    (kLeastOffset_m * kLeastOffset_m);
  return onset;
}

}  // namespace

std::vector<Touch> touches_at_rest(const std::vector<Sample>& rows, double zero_N, double threshold_N,
                                   double air_end_m) {
  std::vector<Touch> touches;
  bool in_air = false;
  bool rested = true;  // the first touch counts as one at rest
  double left_s = 0.0;
  std::size_t run = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double time_s = rows[i].tool.time_s;
    in_air = in_air || rows[i].motion.position_m < air_end_m;
    if (!(rows[i].force_N - zero_N > threshold_N)) {
      run = 0;
      const bool out = touches.empty() || rows[i].motion.position_m < touches.front().first_force_m;
      if (out && time_s - left_s >= kRestBeforeTouch_s) rested = true;
      continue;
    }
    left_s = time_s;
    if (++run != kForceRun || !rested) continue;
    rested = false;
    const std::size_t first = i + 1 - kForceRun;
    const double first_m = rows[first].motion.position_m;
    const Touch touch{approach_begin(rows, first, first_m - kTouchOut_m),
                      approach_end(rows, first, first_m + kTouchIn_m), first_m};
    const bool from_air = in_air || first_m - rows[touch.begin].motion.position_m >= kAirBefore_m;
    if (from_air && touch.end >= first + kForceRun + 1) touches.push_back(touch);
    in_air = false;
  }
  return touches;
}

Onset find_onset(const std::vector<Sample>& rows, const std::vector<Touch>& touches, double zero_N,
                 double force_noise_N) {
  const FormOnset linear = onset_of_form(OnsetCost(rows, touches, zero_N, kLinear), touches.front().first_force_m);
  const FormOnset ball = onset_of_form(OnsetCost(rows, touches, zero_N, kBall), touches.front().first_force_m);
  const double variance =
      std::max(std::min(linear.cost, ball.cost) / linear.degrees_of_freedom, force_noise_N * force_noise_N);
  const double drop = (ball.cost - linear.cost) / std::max(variance, 1e-18);
  const FormOnset& chosen = drop > kClearDrop ? linear : ball;
  Onset onset{chosen.at_m, kUnknownError};
  if (chosen.curvature > 0.0) {
    // J rises by noise^2 within one standard error.
    onset.standard_error_m = std::max(2.0 * kFinest_m, std::sqrt(2.0 * variance / chosen.curvature));
    const bool clear = drop > kClearDrop || drop < -kClearDrop;
    if (!clear) onset.standard_error_m = std::hypot(onset.standard_error_m, 0.5 * (linear.at_m - ball.at_m));
    // Neither law fits, so that the onset between free air and the first force is uncertain.
    if (std::sqrt(variance) > kSignificantErrors * force_noise_N) {
      onset.misfit_m = std::abs(onset.at_m - touches.front().first_force_m);
    }
  }
  return onset;
}

}  // namespace palpate
