#include "models/surface/surface_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

using test::RecordingPtr;

Recording shorter(RigSettings settings, std::uint64_t seed) {
  settings.seed = seed;
  settings.seconds = 12.0;
  return *test::rig_recording(settings);
}

std::vector<SurfaceRow> moved(const Recording& recording, double offset_m) {
  Recording copy = recording;
  for (RecordingRow& row : copy.rows) row.position_m += offset_m;
  return thinned_rows(copy, kSearchRows);
}

// The bound: 0.02 mm. Gel, whose slowest branch outlasts these short recordings, comes to 0.035 mm.
TEST(SurfaceSearch, FindsTheShiftOfATestRecording) {
  for (const char* material : {"silicone", "foam", "maxwell"}) {
    const auto training = std::make_shared<const Recording>(shorter(test::train_settings(material), 1));
    const auto prepared = test::prepare({training}, test::default_request("silicone_block"));
    const std::vector<std::shared_ptr<const ForceModel>> models{test::fit(prepared, &kGreedyMethod),
                                                                test::fit(prepared, &kRandomMethod)};
    const Recording recording = shorter(test::test_settings(material), 2);
    for (const double shift_m : {-1.4e-3, -0.5e-3, -0.05e-3, 0.0, 0.05e-3, 0.3e-3, 1.0e-3}) {
      const SurfaceLocation found = locate_surface(moved(recording, shift_m), models, JndLine{});
      EXPECT_NEAR(found.offset_m, shift_m, 0.02e-3) << material;
      EXPECT_LT(found.standard_error_m, 0.02e-3) << material;
    }
  }
}

TEST(SurfaceSearch, WithoutModelsOrRowsThereIsNoSurface) {
  const SurfaceLocation nothing = locate_surface({}, {}, JndLine{});
  EXPECT_EQ(nothing.offset_m, 0.0);
  EXPECT_TRUE(std::isinf(nothing.standard_error_m));
}

}  // namespace
}  // namespace palpate
