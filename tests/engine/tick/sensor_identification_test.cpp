// Identification of sensors from recordings with a known sensor.
#include "engine/tick/sensor_identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

SensorSpec identify(const Recording& recording) {
  return identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns);
}

// Gaussian noise of standard deviation `sigma` on one column, fixed seed.
void add_noise(Recording& recording, double RecordingRow::*column, double sigma) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> noise(0.0, sigma);
  for (RecordingRow& row : recording.rows) row.*column += noise(engine);
}

// Linear strokes of a machine, recorded as commanded positions.
TEST(SensorIdentification, ARampIsNoEncoder) {
  Recording recording;
  for (int i = 0; i < 1000; ++i) {
    RecordingRow row;
    row.time_s = 1e-3 * i;
    row.position_m = 5e-5 * std::min(std::max(0, i - 200), std::max(0, 600 - i));
    recording.rows.push_back(row);
  }
  EXPECT_EQ(identify(recording).encoder_step_m, 0.0);
}

// The tolerance is a factor of 1.6 for rounding to 1, 2 or 5, and 10 % by which the quietest
// fifth of the windows differs between recordings.
TEST(SensorIdentification, FindsTheNoiseOfAPositionThatIsNotQuantised) {
  for (const double noise_m : {1e-6, 5e-6, 20e-6}) {
    Recording recording = test::example_recording(10000, 1000.0);
    add_noise(recording, &RecordingRow::position_m, noise_m);
    const SensorSpec sensor = identify(recording);
    EXPECT_EQ(sensor.encoder_step_m, 0.0);
    EXPECT_LT(std::abs(std::log(sensor.position_noise_m / noise_m)), std::log(1.75));
  }
}

// The error of a velocity from encoder differences is uniform, up to a step per
// sample: its standard deviation is step / dt / sqrt(12).
TEST(SensorIdentification, KnowsADifferencedVelocityForWhatItIs) {
  Recording recording = test::example_recording(10000, 1000.0, 30e-6);
  recording.columns.velocity = true;
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    recording.rows[i].velocity_m_per_s = (recording.rows[i].position_m - recording.rows[i - 1].position_m) / 1e-3;
  }
  const SensorSpec sensor = identify(recording);
  ASSERT_TRUE(sensor.has_velocity);
  const double expected = 30e-6 / 1e-3 / std::sqrt(12.0);
  EXPECT_GT(sensor.velocity_noise_m_per_s, 0.8 * expected);
  EXPECT_LT(sensor.velocity_noise_m_per_s, 2.0 * expected);
}

TEST(SensorIdentification, FindsTheNoiseOfAnAccelerometer) {
  Recording recording = test::example_recording(10000, 1000.0, 30e-6);
  recording.columns.acceleration = true;
  for (RecordingRow& row : recording.rows) row.acceleration_m_per_s2 = 0.3 * std::sin(5.0 * row.time_s);
  add_noise(recording, &RecordingRow::acceleration_m_per_s2, 0.08);
  const SensorSpec sensor = identify(recording);
  ASSERT_TRUE(sensor.has_acceleration);
  EXPECT_NEAR(sensor.acceleration_noise_m_per_s2, 0.08, 0.3 * 0.08);
}

TEST(SensorIdentification, ColumnsWithoutNoiseGetTheFloors) {
  for (const double moving : {0.0, 1.0}) {
    Recording recording = test::example_recording(5000, 1000.0);
    recording.columns = {true, true};
    for (RecordingRow& row : recording.rows) {
      row.position_m *= moving;
      row.velocity_m_per_s = moving * 0.02 * std::sin(5.0 * row.time_s);
      row.acceleration_m_per_s2 = moving * 0.1 * std::cos(5.0 * row.time_s);
    }
    const SensorSpec sensor = identify(recording);
    EXPECT_EQ(sensor.encoder_step_m, 0.0);
    EXPECT_LT(sensor.position_noise_m, 1e-6);
    EXPECT_EQ(sensor.velocity_noise_m_per_s, 1e-4);
    EXPECT_EQ(sensor.acceleration_noise_m_per_s2, 1e-2);
  }
  EXPECT_EQ(identify_sensor(nullptr, 0, {}).encoder_step_m, 0.0);
}

}  // namespace
}  // namespace palpate
