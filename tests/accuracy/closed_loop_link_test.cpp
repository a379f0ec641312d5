// The closed loop (closed_loop_test.cpp) behind a link that is slow, late or sends in groups: the rendered stiffness is
// limited to the stable range (engine/live/force_guard.h), so that no hand oscillates, and not much more than needed.
// PALPATE_GRID=1 runs every hand with every model on every link, and prints each row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/support/hand_on_link.h"
#include "tests/support/live_doubles.h"

namespace palpate::test {
namespace {

// 50 to 300 g, with the low damping of relaxed hands, 0.35 to 0.7 of critical.
const Grip kHands[] = {{"finger, 50 g", 0.05, 100.0, 2.2},
                       {"relaxed, 80 g", 0.08, 150.0, 3.5},
                       {"braced, 120 g", 0.12, 800.0, 14.0},
                       {"loose, 300 g", 0.3, 150.0, 4.7}};

// The largest swing at rest and the energy from the device in a second of it. Measured on the whole grid: see below.
constexpr double kSwing_m = 0.35e-3;
constexpr double kGiven_J = 300e-6;
// What a whole press may return beyond what it took. Whole grid: 0.5 mJ in the median, 4.9 in 95 %, 176 where a block
// of 7 kN/m is touched behind commands in groups of 16: the first groups are younger than later ones.
constexpr double kReturned_J = 0.2;
constexpr double kEncoder_m = 10e-6;
constexpr double kEncoderReturns_J = 50e-6;  // two of its steps at 2.5 N

// F = scale x stiffness x depth x (1 + depth / 2 mm), or without the last factor.
class Surface final : public NamedModel {
 public:
  Surface(double stiffness_N_per_m, bool hardens) : NamedModel("surface"), k_(stiffness_N_per_m), hardens_(hardens) {}
  double force(const double* features) const noexcept override {
    return k_ * features[0] * (hardens_ ? 1.0 + features[0] / 2e-3 : 1.0);
  }

 private:
  double k_;
  bool hardens_;
};
struct Stiffness {
  double N_per_m = 0.0;
  bool hardens = false;
};
constexpr Stiffness kModels[] = {{600.0}, {1500.0}, {1000.0, true}, {7000.0}};

HandOnLink::Rest rest(const Link& link, const Grip& grip, const Stiffness& model, double share, bool limited) {
  HandOnLink loop(link, grip, std::make_shared<const Surface>(share * model.N_per_m, model.hardens), kEncoder_m,
                  limited);
  return loop.run(1e-3 + 1.0 / grip.stiffness_N_per_m);
}

std::vector<Link> links() {
  std::vector<Link> all;
  for (const double rate_Hz : {100.0, 200.0, 333.0, 500.0, 1000.0, 2000.0, 5000.0}) {
    for (const int group : {1, 2, 3, 5, 16}) {
      // Groups of samples, of commands, of both.
      for (int which = 1; which <= (group == 1 ? 1 : 3); ++which) {
        const int samples = (which & 1) != 0 ? group : 1, commands = (which & 2) != 0 ? group : 1;
        for (const double delay_s : {0.0, 2e-3, 5e-3, 15e-3, 50e-3}) {
          for (const double jitter_s : {0.0, 2e-3}) all.push_back({rate_Hz, samples, commands, delay_s, jitter_s});
        }
      }
    }
  }
  return all;
}

// The largest share of the model with which this hand keeps still, without the limit; at most 1.
double largest_still_share(const Link& link, const Grip& grip, const Stiffness& model) {
  double still = 0.0, swings = 1.0;
  for (int i = 0; i < 7; ++i) {
    const double share = i == 0 ? 1.0 : 0.5 * (still + swings);
    (rest(link, grip, model, share, false).swing_m <= kSwing_m ? still : swings) = share;
    if (still == 1.0) break;
  }
  return still;
}

TEST(ClosedLoop, NoHandIsDrivenBehindAnyLink) {
  const bool whole = std::getenv("PALPATE_GRID") != nullptr;
  std::vector<double> shares_of_still, returned_J;
  double worst_m = 0.0, worst_J = 0.0, worst_wander = 0.0, worst_returned_J = 0.0;
  std::size_t number = 0, runs = 0, cut = 0, returning = 0;
  for (const Link& link : links()) {
    for (std::size_t pair = 0; pair < 16; ++pair, ++number) {
      // One of the sixteen pairs of hand and model on each link.
      if (!whole && pair != number / 16 * 7 % 16) continue;
      const Grip& grip = kHands[pair % 4];
      const Stiffness& model = kModels[pair / 4];
      const HandOnLink::Rest one = rest(link, grip, model, 1.0, true);
      char row[160];
      std::snprintf(row, sizeof row, "%4.0f Hz, groups of %2d and %2d, %2.0f ms, +%.0f ms, %s, %.0f N/m", link.rate_Hz,
                    link.sample_group, link.command_group, 1e3 * link.delay_s, 1e3 * link.jitter_s, grip.name.c_str(),
                    model.N_per_m);
      ++runs;
      // The force of a link at the limit of lateness goes away once, and the hand moves once.
      if (one.force_N > 0.0 && one.faults != 0) {
        ++cut;
        continue;
      }
      EXPECT_LE(one.swing_m, kSwing_m) << row;
      EXPECT_LE(one.given_J, kGiven_J) << row;
      EXPECT_LE(one.most_share - one.least_share, 0.05) << row;
      worst_returned_J = std::max(worst_returned_J, one.returned_J);
      if (one.returned_J > kEncoderReturns_J) ++returning;
      EXPECT_LE(one.returned_J, kReturned_J) << row;
      worst_m = std::max(worst_m, one.swing_m);
      worst_J = std::max(worst_J, one.given_J);
      worst_wander = std::max(worst_wander, one.most_share - one.least_share);
      // A link so slow that the device is refused has no force.
      if (one.force_N == 0.0 || !(whole || number / 16 % 16 == 0)) continue;
      returned_J.push_back(one.returned_J);
      const double still = largest_still_share(link, grip, model);
      shares_of_still.push_back(one.least_share / std::max(still, 1e-3));
      if (whole) {
        std::printf("%s: swing %.3f mm, %.0f uJ, share %.3f to %.3f, still up to %.3f, returned %.0f uJ\n", row,
                    1e3 * one.swing_m, 1e6 * one.given_J, one.least_share, one.most_share, still, 1e6 * one.returned_J);
      }
    }
  }
  std::ranges::sort(shares_of_still);
  const double median = shares_of_still[shares_of_still.size() / 2];
  std::printf(
      "swing up to %.3f mm, %.0f uJ, share wanders by %.3f; it is %.2f of the largest still one (median of %zu)\n",
      1e3 * worst_m, 1e6 * worst_J, worst_wander, median, shares_of_still.size());
  std::printf("a press returns up to %.2f mJ more than it took; %zu of %zu more than %.0f uJ\n", 1e3 * worst_returned_J,
              returning, runs, 1e6 * kEncoderReturns_J);
  std::ranges::sort(returned_J);
  std::printf("of %zu with a force: %.2f mJ in the median, %.2f in 95 %%\n", returned_J.size(),
              1e3 * returned_J[returned_J.size() / 2], 1e3 * returned_J[returned_J.size() * 95 / 100]);
  EXPECT_GE(median, 0.6);
  EXPECT_LE(cut, runs / 50);
}

// 2 to 3 ms from a sample to its force, and one more until the next one.
TEST(ClosedLoop, AnOrdinaryLoopRendersABlockOf1500NPerMAlmostInFull) {
  EXPECT_EQ(rest({.delay_s = 1e-3}, kHands[0], {1500.0}, 1.0, true).least_share, 1.0);
  EXPECT_GE(rest({.delay_s = 2e-3}, kHands[0], {1500.0}, 1.0, true).least_share, 0.85);
}

// The stability limit includes the stiffness scale and the damping that a user sets.
TEST(ClosedLoop, NeitherScaleNorDampingOfTheUserDrivesAHand) {
  for (const double encoder_m : {5e-6, 30e-6}) {
    for (const ForceScale& scale : {ForceScale{4.0, 0.0}, ForceScale{1.0, 20.0}, ForceScale{4.0, 20.0}}) {
      for (const double delay_s : {0.0, 3e-3}) {
        HandOnLink loop({.delay_s = delay_s}, kHands[0], spring(3000.0), encoder_m);
        loop.controls.scale = scale;
        EXPECT_LE(loop.run(11e-3).swing_m, kSwing_m) << scale.stiffness << ", " << scale.damping_Ns_per_m;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
