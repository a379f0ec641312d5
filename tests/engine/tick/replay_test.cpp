#include "engine/tick/haptics_tick.h"

#include <gtest/gtest.h>

#include "engine/tick/jnd.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

// Replay gives exactly the results of the tick.

using test::example_recording;

// All numbers of a replay, in order.
struct Trace {
  std::vector<double> values;
  ReplayVisitor visitor() {
    return [this](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
      values.insert(values.end(), {row.time_s, snapshot.time_s, snapshot.depth_m, snapshot.velocity_m_per_s});
      for (std::size_t m = 0; m < tick.model_count(); ++m) {
        values.push_back(snapshot.force_N[m]);
        for (const double feature : tick.features_of(m).values) values.push_back(feature);
      }
    };
  }
};

// A rig whose material starts at 6.2 mm; before that is air.
TEST(Replay, ContactCountsFromTheSurfaceOfTheModel) {
  std::vector<FeatureSpec> features = test::position_features();
  features.front().surface_position_m = 6.2e-3;
  const auto at_surface =
      std::make_shared<const FittedModel>(test::example_model("random", KernelKind::cubic, std::move(features), 20));
  const auto at_zero = std::make_shared<const FittedModel>(test::example_models().front());
  Recording recording;
  for (int i = 0; i < 1000; ++i) recording.rows.push_back({1e-3 * i, 1e-5 * (i + 0.5), 0.0, 0.0, 0.0});
  const auto contacts = [&](const ForceModels& models) { return replay(recording, models, {}).contact_samples; };
  EXPECT_EQ(contacts({at_surface}), 380u);
  EXPECT_EQ(contacts({at_surface, at_zero}), 380u);
  EXPECT_EQ(contacts({at_zero}), 1000u);
  EXPECT_EQ(contacts({}), 1000u);
}

TEST(Replay, EqualsSteppingByHand) {
  const Recording recording = example_recording(3000, 1000.0, 30e-6);
  const ForceModels models = test::example_force_models();
  Trace trace;
  const ReplaySummary summary = replay(recording, models, trace.visitor());

  Trace by_hand;
  const ReplayVisitor visit = by_hand.visitor();
  HapticsTick tick(identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns), models);
  std::uint64_t contact = 0;
  for (const RecordingRow& row : recording.rows) {
    const TickSnapshot& snapshot = tick.step({row.time_s, row.position_m, 0.0, 0.0});
    contact += row.position_m > 0.4e-3 ? 1 : 0;  // the surface of the last example
    visit(row, snapshot, tick);
  }
  EXPECT_EQ(trace.values, by_hand.values);
  EXPECT_EQ(summary.samples, recording.rows.size());
  EXPECT_EQ(summary.contact_samples, contact);
  EXPECT_NEAR(summary.sensor.encoder_step_m, 30e-6, 1e-12);
}

// With an offset, the tick gets the same as from a recording with moved positions; the
// visitor gets the original row. The offset is a power of two, so that no sum rounds.
TEST(Replay, MovesTheSurface) {
  const double offset_m = std::ldexp(1.0, -12);
  Recording recording = example_recording(3000, 1000.0);
  for (RecordingRow& row : recording.rows) row.position_m = std::round(row.position_m * 1e7) * std::ldexp(1.0, -23);
  Recording shifted = recording;
  for (RecordingRow& row : shifted.rows) row.position_m += offset_m;
  const ForceModels models = test::example_force_models();
  Trace plain;
  Trace moved;
  replay(recording, models, plain.visitor());
  replay(shifted, models, moved.visitor(), offset_m);
  EXPECT_EQ(plain.values, moved.values);
}

// The paper's conservative line, section 4.1.
TEST(JndLine, IsThePapersConservativeLine) {
  const JndLine line;
  EXPECT_DOUBLE_EQ(line.at(0.0), 0.065);
  EXPECT_NEAR(line.at(2.5), 0.065 + 0.0633 * 2.5, 1e-15);
  EXPECT_DOUBLE_EQ(line.at(-2.5), line.at(2.5));
}

}  // namespace
}  // namespace palpate
