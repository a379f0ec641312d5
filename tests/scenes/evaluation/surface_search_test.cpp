#include "scenes/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

Recording shorter(RigSettings settings, std::uint64_t seed) {
  settings.seed = seed;
  settings.seconds = 12.0;
  return *test::rig_recording(settings);
}

std::vector<Sample> moved(const Recording& recording, double offset_m) {
  Recording copy = recording;
  for (RecordingRow& row : copy.rows) row.position_m += offset_m;
  return thinned_rows(copy, kSearchRows);
}

// Offsets of any size. Gel is left out: its slowest branch is longer than these recordings (error 0.035 mm).
TEST(SurfaceSearch, FindsTheShiftOfATestRecording) {
  for (const char* material : {"silicone", "foam", "maxwell"}) {
    const auto training = std::make_shared<const Recording>(shorter(test::train_settings(material), 1));
    const auto prepared = test::prepare({training}, test::default_request("silicone_block"));
    const std::vector<std::shared_ptr<const ForceModel>> models{test::fit(prepared, &kGreedyMethod),
                                                                test::fit(prepared, &kRandomMethod)};
    const Recording recording = shorter(test::test_settings(material), 2);
    for (const double shift_m : {-12e-3, -1.4e-3, -0.5e-3, 0.0, 0.3e-3, 5e-3}) {
      const OffsetEstimate found = locate_surface(moved(recording, shift_m), models, JndLine{});
      EXPECT_NEAR(found.at, shift_m, 0.03e-3) << material;
      EXPECT_TRUE(found.identified) << material;
    }
  }
}

}  // namespace
}  // namespace palpate
