// Identification of a force lag, separately from viscosity (a force lead), and without false alarms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/tick/sensor_identification.h"
#include "models/check/recording_measures.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

// The forces of a recording at a constant rate, late by whole rows; rows without a force are dropped.
std::vector<Sample> late_forces(const std::vector<Sample>& rows, double late_s) {
  const auto shift = std::lround(late_s / (rows[1].tool.time_s - rows[0].tool.time_s));
  std::vector<Sample> moved;
  for (long i = std::max(0L, shift); i < static_cast<long>(rows.size()) + std::min(0L, shift); ++i) {
    moved.push_back(rows[static_cast<std::size_t>(i)]);
    moved.back().force_N = rows[static_cast<std::size_t>(i - shift)].force_N;
  }
  return moved;
}

OffsetEstimate lag_of(const std::string& material, double late_s) {
  RigSettings settings = test::train_settings(material);
  settings.seconds = 15.0;
  const Recording recording = *test::rig_recording(settings);
  const double noise_N = identify_force_noise_N(recording.rows.data(), recording.rows.size());
  return find_force_lag(late_forces(thinned_rows(recording, kAllRows), late_s), noise_N);
}

// The tolerance is 2 ms.
TEST(ForceLag, FindsALateForce) {
  for (const auto& [material, late_s] :
       {std::pair{"silicone", 8e-3}, std::pair{"foam", 30e-3}, std::pair{"stiff", -10e-3}}) {
    const OffsetEstimate found = lag_of(material, late_s);
    EXPECT_TRUE(found.identified) << material;
    EXPECT_NEAR(found.at, late_s, 2e-3) << material;
  }
}

TEST(ForceLag, InventsNone) {
  for (const Material& material : materials()) {
    EXPECT_EQ(lag_of(std::string(material.name), 0.0).at, 0.0) << material.name;
  }
}

}  // namespace
}  // namespace palpate
