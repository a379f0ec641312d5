// Recordings with different forces at the same depth, and cases that only look like that.
#include "models/check/check_recording.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

Recording press(const char* material, std::uint64_t seed) {
  RigSettings settings = test::train_settings(material);
  settings.seed = seed;
  return *test::rig_recording(settings);
}

Recording changed(Recording recording, double shift_m, double offset_N) {
  for (RecordingRow& row : recording.rows) {
    row.position_m += shift_m;
    row.force_N += offset_N;
  }
  return recording;
}

// Slow strokes from 2 mm to 8 mm, without free air that would determine the force zero.
Recording strokes(double stiffness_N_per_m) {
  Recording made;
  for (int i = 0; i < 4000; ++i) {
    const double x = 5.0 - 3.0 * std::cos(4e-3 * i);  // mm
    // A buckling shell: a surface offset cannot explain an offset of its force.
    const double force_N = 1e-3 * stiffness_N_per_m * (0.2 * x + 4.0 * std::exp(-(x - 5.0) * (x - 5.0)));
    made.rows.push_back({1e-2 * i, 1e-3 * x, force_N, 0.0, 0.0});
  }
  return made;
}

std::optional<double> contradiction_N(const Recording& first, const Recording& second) {
  return find_contradiction_N(*prepare_recording(first), *prepare_recording(second), JndLine{});
}

TEST(Contradiction, RecordingsOfOneMaterialHaveNone) {
  for (const char* material : {"silicone", "foam", "friction"}) {
    const Recording first = press(material, 1);
    EXPECT_FALSE(contradiction_N(first, press(material, 2))) << material;
    EXPECT_FALSE(contradiction_N(first, changed(press(material, 2), 1e-3, 0.0))) << material;
  }
}

TEST(Contradiction, NamesTheDifferenceOfTheForces) {
  const auto offset_N = contradiction_N(strokes(1000.0), changed(strokes(1000.0), 0.0, 2.8));
  ASSERT_TRUE(offset_N);
  EXPECT_NEAR(*offset_N, 2.8, 0.2);
  EXPECT_TRUE(contradiction_N(strokes(1000.0), strokes(3000.0)));
  EXPECT_FALSE(contradiction_N(strokes(1000.0), changed(strokes(1000.0), 0.0, 0.05)));
}

}  // namespace
}  // namespace palpate
