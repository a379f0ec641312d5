#include "models/library/palpate/palpate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/live/device.h"
#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/rt_guard.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// The C interface: forces bit-identical to replay, errors, and no forbidden operations.

using StreamPtr = std::unique_ptr<palpate_stream, decltype(&palpate_stream_free)>;
using RecordingHandle = std::unique_ptr<palpate_recording, decltype(&palpate_recording_free)>;
using ModelHandle = std::unique_ptr<palpate_model, decltype(&palpate_model_free)>;

class LibraryC : public ::testing::Test {
 protected:
  std::string save(const ModelData& data) {
    const std::string path = folder_.file(data.name + ".json");
    EXPECT_TRUE(save_model(path, data, true).ok());
    return path;
  }

  ModelHandle load(const std::string& path) {
    ModelHandle model(palpate_model_load(path.c_str(), error_, sizeof error_), &palpate_model_free);
    EXPECT_NE(model, nullptr) << error_;
    return model;
  }

  StreamPtr stream(const ModelHandle& model, const palpate_sensor& sensor) {
    return {palpate_stream_new_with_sensor(model.get(), &sensor, error_, sizeof error_), &palpate_stream_free};
  }

  std::string save(const Recording& recording) {
    EXPECT_TRUE(write_recording(folder_.file("rec.csv"), recording, {}, true).ok());
    return folder_.file("rec.csv");
  }

  palpate_sensor sensor_of(const Recording& recording) {
    const RecordingHandle loaded(palpate_recording_load(save(recording).c_str(), error_, sizeof error_),
                                 &palpate_recording_free);
    palpate_sensor sensor;
    EXPECT_EQ(palpate_sensor_of(loaded.get(), &sensor), 0) << error_;
    return sensor;
  }

  test::TemporaryFolder folder_;
  char error_[500] = "";
};

// Replays in process and through a stream; every force and flag must be equal.
void compare(const Recording& recording, const ModelData& data, palpate_stream* stream) {
  std::size_t row = 0;
  replay(recording, {std::make_shared<FittedModel>(data)},
         [&](const RecordingRow& r, const TickSnapshot& snapshot, const HapticsTick&) {
           const double force_N = palpate_stream_force_with_motion(stream, r.time_s, r.position_m, r.velocity_m_per_s,
                                                                   r.acceleration_m_per_s2);
           ASSERT_EQ(force_N, snapshot.force_N[0]) << data.name << " row " << row;
           ASSERT_EQ(palpate_stream_out_of_domain(stream), static_cast<int>(snapshot.out_of_domain_mask & 1U));
           const double bound_N = palpate_stream_predicted_error(stream);
           const double expected_N = snapshot.predicted_error_N[0];
           ASSERT_TRUE(bound_N == expected_N || (std::isnan(bound_N) && std::isnan(expected_N))) << data.name;
           ++row;
         });
  EXPECT_EQ(row, recording.rows.size());
}

Recording with_channels(Recording recording) {
  recording.columns = {true, true};
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    RecordingRow& row = recording.rows[i];
    row.velocity_m_per_s = 0.02 * std::sin(0.01 * static_cast<double>(i));
    row.acceleration_m_per_s2 = 0.2 * std::cos(0.01 * static_cast<double>(i));
  }
  return recording;
}

TEST_F(LibraryC, AStreamGivesReplaysForcesToTheLastBit) {
  const std::vector<Recording> recordings = {test::example_recording(1500, 1000.0, 30e-6),
                                             test::example_recording(1500, 700.0),
                                             with_channels(test::example_recording(1500, 1000.0, 30e-6))};
  for (const Recording& recording : recordings) {
    const palpate_sensor sensor = sensor_of(recording);
    for (const ModelData& data : test::example_models()) {
      const StreamPtr one = stream(load(save(data)), sensor);
      ASSERT_NE(one, nullptr) << error_;
      compare(recording, data, one.get());
    }
  }
}

// The identified step is that of the data sheet, without rounding from position differences.
TEST_F(LibraryC, AnEncoderStepAloneIsEnoughWhenPositionsHaveNoOtherNoise) {
  const ModelData data = test::example_models().front();
  const ModelHandle model = load(save(data));
  for (const double step_m : {30e-6, 1e-6, 0.1 / 4096}) {
    const Recording recording = test::example_recording(1500, 1000.0, step_m);
    const palpate_sensor sensor = sensor_of(recording);
    ASSERT_EQ(sensor.position_noise_m, 0.0);
    ASSERT_EQ(sensor.encoder_step_m, step_m);
    const StreamPtr one(palpate_stream_new(model.get(), step_m, error_, sizeof error_), &palpate_stream_free);
    compare(recording, data, one.get());
  }
}

TEST_F(LibraryC, WithNoStepTheSensorIsThatOfTheModelsRecordings) {
  ModelData data = test::example_models().front();
  data.sensor = SensorSpec{30e-6, 0.0};
  const ModelHandle model = load(save(data));
  const Recording recording = test::example_recording(1500, 1000.0, 30e-6);
  const StreamPtr one(palpate_stream_new(model.get(), 0.0, error_, sizeof error_), &palpate_stream_free);
  compare(recording, data, one.get());
}

TEST_F(LibraryC, AStreamContinuesARecordingAsReplayDoes) {
  EXPECT_EQ(palpate_stream_start_after(nullptr, nullptr, error_, sizeof error_), -1);
  const Recording before = test::example_recording(1200, 1000.0), recording = test::example_recording(800, 1000.0);
  std::vector<double> time_s, position_m;
  for (const RecordingRow& row : before.rows) time_s.push_back(row.time_s), position_m.push_back(row.position_m);
  const palpate_recording given{"", time_s.size(), time_s.data(), position_m.data(), nullptr, nullptr, nullptr};
  for (const ModelData& data : test::example_models()) {
    const StreamPtr one = stream(load(save(data)), sensor_of(recording));
    ASSERT_EQ(palpate_stream_start_after(one.get(), &given, error_, sizeof error_), 0) << error_;
    const auto visit = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      ASSERT_EQ(palpate_stream_force(one.get(), row.time_s, row.position_m), snapshot.force_N[0]) << data.name;
    };
    replay(recording, {std::make_shared<FittedModel>(data)}, visit, 0.0, &before);
  }
}

TEST_F(LibraryC, AResetBeginsANewStream) {
  const Recording recording = test::example_recording(800, 1000.0, 30e-6);
  const ModelData data = test::example_models().front();
  const StreamPtr one = stream(load(save(data)), sensor_of(recording));
  for (const RecordingRow& row : recording.rows) palpate_stream_force(one.get(), row.time_s, row.position_m);
  palpate_stream_reset(one.get());
  EXPECT_EQ(palpate_stream_out_of_domain(one.get()), 0);
  compare(recording, data, one.get());
}

TEST_F(LibraryC, AStreamOutlivesItsModel) {
  ModelHandle model = load(save(test::example_models().front()));
  const StreamPtr one(palpate_stream_new(model.get(), 0.0, error_, sizeof error_), &palpate_stream_free);
  model.reset();
  palpate_stream_force(one.get(), 0.0, 0.001);
  EXPECT_GT(palpate_stream_force(one.get(), 0.001, 0.003), 0.0);
}

TEST_F(LibraryC, TheLimiterIsTheProgramsOwn) {
  palpate_limits limits;
  palpate_limits_default(&limits);
  limits.largest_N = 2.0;
  std::unique_ptr<palpate_limiter, decltype(&palpate_limiter_free)> limiter(
      palpate_limiter_new(&limits, error_, sizeof error_), &palpate_limiter_free);
  ForceLimits same;
  same.largest_N = 2.0;
  ForceLimiter expected(same);
  for (int i = 0; i < 2000; ++i) {
    const double commanded_N = i == 700 ? NAN : 3.0 * std::sin(0.01 * i);
    const double age_s = i == 900 ? 0.1 : 0.0;
    ForceConditions conditions;
    conditions.sample_age_s = age_s;
    if (i == 1100) {
      palpate_limiter_stop(limiter.get());
      conditions.device_fault = true;
    }
    ASSERT_EQ(palpate_limiter_force(limiter.get(), commanded_N, 1e-3, age_s),
              expected.limit(commanded_N, 1e-3, conditions));
    ASSERT_EQ(palpate_limiter_flags(limiter.get()), expected.flags());
  }
  limits.fastest_N_per_s = -1.0;
  EXPECT_EQ(palpate_limiter_new(&limits, error_, sizeof error_), nullptr);
  EXPECT_TRUE(test::has_parts(error_, {"fastest_N_per_s", "found -1,", "above 0"}));
}

TEST_F(LibraryC, AStreamTellsARefusedSampleFromNoContact) {
  const ModelHandle model = load(save(test::example_models().front()));
  const StreamPtr one = stream(model, {});
  EXPECT_EQ(palpate_stream_accepted(one.get()), 0) << "no sample yet";
  for (const auto& [time_s, position_m, accepted] : {std::tuple{0.0, -1e-3, 1},
                                                     {1e-3, 2e-3, 1},
                                                     {1e-3, 2e-3, 0},
                                                     {0.5e-3, 2e-3, 0},
                                                     {2e-3, double{NAN}, 0},
                                                     {double{INFINITY}, 2e-3, 0},
                                                     {2e-3, -1e-3, 1}}) {
    const double force_N = palpate_stream_force(one.get(), time_s, position_m);
    EXPECT_EQ(palpate_stream_accepted(one.get()), accepted) << time_s;
    EXPECT_EQ(force_N != 0.0, accepted == 1 && position_m > 0.0) << time_s;
  }
  palpate_stream_reset(one.get());
  EXPECT_EQ(palpate_stream_accepted(one.get()), 0);
}

TEST_F(LibraryC, TimesThatJumpDisturbAStreamForATenthOfASecondAtMost) {
  const ModelHandle model = load(save(test::example_models().front()));
  struct Case {
    const char* what;
    int bad;               // samples with another time
    double by_s, after_s;  // added to their times, and to all later ones
    bool equal;            // the forces after them are those of an undisturbed stream, to the last bit
  };
  for (const auto& [what, bad, by_s, after_s, equal] :
       {Case{"one stamp ahead", 1, 100.0, 0.0, true},
        {"one stamp half a second ahead", 1, 0.5, 0.0, true},
        {"one stamp behind", 1, -100.0, 0.0, true},
        {"some stamps ahead", 50, 100.0, 0.0, true},
        {"some stamps behind", 50, -100.0, 0.0, true},
        {"a clock that is set forward", 0, 0.0, 100.0, false},
        {"a clock that wraps at 2^32 us", 0, 0.0, -4294.967296, false}}) {
    const StreamPtr one = stream(model, {}), undisturbed = stream(model, {});
    int disturbed = 0;
    for (int i = 0; i < 3000; ++i) {
      const double time_s = 4293.0 + 1e-3 * i, position_m = 2e-3 + 2e-3 * std::sin(0.01 * i);
      const double wrong_s = i < 1000 ? 0.0 : i < 1000 + bad ? by_s : after_s;
      const double force_N = palpate_stream_force(one.get(), time_s + wrong_s, position_m);
      const bool skipped = i >= 1000 && i < 1000 + bad;
      const double expected_N = skipped ? 0.0 : palpate_stream_force(undisturbed.get(), time_s, position_m);
      if (skipped) continue;
      if (equal) {
        ASSERT_EQ(force_N, expected_N) << what << " " << i;
      }
      if (std::abs(force_N - expected_N) > 0.065 + 0.0633 * expected_N) ++disturbed;
    }
    EXPECT_LE(disturbed, 100) << what;
  }
}

// A loop of its own around a stream, on a tool that a hand holds. Forces act `delay` calls later.
struct OwnLoop {
  palpate_stream* stream;
  palpate_limiter* limiter;
  double step_s = 1e-3;
  std::size_t delay = 1;
  double given_s = step_s;  // the step that it names
  bool tells = false;       // which force acts
  std::size_t group = 1;    // samples that arrive, and are rendered, together
  double position_m = 0.0, velocity_m_per_s = 0.0, time_s = 0.0;
  std::deque<double> forces_N{};
  std::vector<std::pair<double, double>> arrived{};
  double newest_N = 0.0;

  // `wrong`: what to give instead of the sample.
  double call(std::optional<std::pair<double, double>> wrong = std::nullopt) {
    time_s += step_s;
    if (tells)
      palpate_limiter_acted(limiter, forces_N.empty() ? NAN : time_s - step_s * static_cast<double>(forces_N.size()));
    arrived.push_back(wrong.value_or(std::pair{time_s, 1e-5 * std::round(1e5 * position_m)}));
    constexpr double kBetween_s = 5e-5;
    const double pause_s = static_cast<double>(group) * (given_s - kBetween_s) + kBetween_s;
    for (std::size_t i = 0; i < arrived.size() && arrived.size() == group; ++i)
      newest_N =
          palpate_limiter_render(limiter, stream, arrived[i].first, arrived[i].second, i == 0 ? pause_s : kBetween_s);
    if (arrived.size() == group) arrived.clear();
    forces_N.push_back(newest_N);
    if (forces_N.size() > delay + 1) forces_N.pop_front();
    // A relaxed hand of 80 g that pushes with 1 N.
    for (int i = 0; i < 20; ++i) {
      const double h = step_s / 20;
      velocity_m_per_s += h * (1.0 + 150.0 * (2e-3 - position_m) - 3.5 * velocity_m_per_s - forces_N.front()) / 0.08;
      position_m += h * velocity_m_per_s;
    }
    return forces_N.back();
  }
  void press() {
    while (time_s < 2.0) call();
  }
  double swing_m() {
    double low_m = position_m, high_m = position_m;
    for (double until_s = time_s + 1.0; time_s < until_s; call()) {
      low_m = std::min(low_m, position_m);
      high_m = std::max(high_m, position_m);
    }
    return high_m - low_m;
  }
};

using LimiterHandle = std::unique_ptr<palpate_limiter, decltype(&palpate_limiter_free)>;

LimiterHandle default_limiter() { return {palpate_limiter_new(nullptr, nullptr, 0), &palpate_limiter_free}; }

TEST_F(LibraryC, ARepeatedSampleIsHeldAndNoneChangesTheForceByMoreThan2NInAMillisecond) {
  const ModelHandle model = load(save(test::example_models().front()));
  struct Case {
    int bad;
    double time_s, position_m;  // of the bad samples; time 0: repeated
    bool held;
  };
  for (const auto& [bad, bad_s, bad_m, held] : {Case{1, 0.0, 2e-3, true},
                                                {3, 0.0, 0.5, true},
                                                {1, NAN, 2e-3, false},
                                                {1, 9e3, NAN, false},
                                                {30, 0.0, 2e-3, false}}) {
    const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
    const LimiterHandle limiter = default_limiter();
    OwnLoop loop{one.get(), limiter.get()};
    loop.press();
    const double before_N = loop.call();
    ASSERT_GT(before_N, 0.2);
    double last_N = before_N, calm_N = before_N, least_N = before_N;
    // The force follows the steps of the encoder up and down.
    for (int i = 0; i < 100; ++i) calm_N = std::min(calm_N, last_N = loop.call());
    for (int i = 0; i < bad + 50; ++i) {
      const double force_N = i < bad ? loop.call(std::pair{bad_s == 0.0 ? loop.time_s : bad_s, bad_m}) : loop.call();
      ASSERT_LE(std::abs(force_N - last_N), 2.0 + 1e-9) << i;
      least_N = std::min(least_N, force_N);
      last_N = force_N;
    }
    EXPECT_EQ(least_N > 0.9 * calm_N, held) << bad << " " << bad_s << " " << bad_m;
    for (int i = 0; i < 1000; ++i) last_N = loop.call();
    EXPECT_GT(last_N, 0.5 * before_N) << "with a ramp";
  }
}

TEST_F(LibraryC, AToolThatIsSuddenlyElsewhereIsLetGoAndFeltAgainWithARamp) {
  const ModelHandle model = load(save(test::example_models().front()));
  const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
  const LimiterHandle limiter = default_limiter();
  double last_N = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double jump_m = i < 1000 ? 0.0 : 0.03;
    const double force_N = palpate_limiter_render(limiter.get(), one.get(), 1e-3 * i, 2e-3 + jump_m, 1e-3);
    EXPECT_LT(std::abs(force_N - last_N), i > 1015 ? 0.1 : 2.1) << i;
    const bool stale = (palpate_limiter_flags(limiter.get()) & PALPATE_LIMIT_STALE) != 0;
    EXPECT_TRUE(i != 1090 || (stale && force_N == 0.0)) << force_N;
    last_N = force_N;
  }
  EXPECT_GT(last_N, 1.0);
}

TEST_F(LibraryC, ALateOrSlowLoopOfItsOwnDoesNotDriveAHand) {
  const std::string recording = folder_.file("stiff.csv"), path = folder_.file("stiff.json");
  test::must_run({"synth", "--material", "stiff", "--seconds", "8", "--out", recording});
  test::must_run({"fit", "--recording", recording, "--method", "random", "--centres", "20", "--out", path});
  const ModelHandle model = load(path);
  struct Case {
    double step_s;
    std::size_t delay;
    bool stopped;
    std::size_t group = 1;
  };
  for (int i = 0; i < 18; ++i) {
    constexpr Case kCases[] = {{1e-3, 1, false},    {1e-3, 6, false},    {4e-3, 1, false},
                               {10e-3, 1, false},   {12.5e-3, 1, true},  {33e-3, 1, true},
                               {1e-3, 1, false, 4}, {1e-3, 1, false, 8}, {1e-3, 1, false, 16}};
    const auto [step_s, delay, stopped, group] = kCases[i / 2];
    const bool tells = i % 2 == 1;
    if (tells && group > 1) continue;
    SCOPED_TRACE(std::to_string(step_s) + " s, " + std::to_string(delay) + (tells ? ", measured" : ", named"));
    const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
    const LimiterHandle limiter = default_limiter();
    if (!tells) palpate_limiter_set_lag(limiter.get(), step_s * (static_cast<double>(delay) + 0.5));
    OwnLoop loop{one.get(), limiter.get(), step_s, delay, step_s, tells};
    loop.group = group;
    loop.press();
    EXPECT_EQ(palpate_limiter_stiffness_share(limiter.get()) < 0.95, step_s > 1e-3 || delay > 1 || tells || group > 1);
    EXPECT_LT(loop.swing_m(), 0.2e-3) << palpate_limiter_stiffness_share(limiter.get());
    EXPECT_EQ(loop.call() == 0.0, stopped);
    EXPECT_EQ((palpate_limiter_flags(limiter.get()) & PALPATE_LIMIT_STOPPED) != 0, stopped);
  }
}

TEST_F(LibraryC, NoForceIsReducedInSilence) {
  const ModelHandle model = load(save(test::example_models().front()));
  struct Case {
    double step_s, given_s, lag_s;
    unsigned flags;
    bool softer;
  };
  for (const auto& [step_s, given_s, lag_s, flags, softer] :
       {Case{1e-3, 1e-3, 0.0, 0, false},
        {1e-3, 1e-3, 20e-3, PALPATE_LIMIT_REDUCED, true},
        {8e-3, 8e-3, 0.0, PALPATE_LIMIT_REDUCED, true},
        {8e-3, 1e-3, 0.0, PALPATE_LIMIT_REDUCED | PALPATE_LIMIT_WRONG_STEP, true},
        {1e-3, 8e-3, 0.0, PALPATE_LIMIT_REDUCED | PALPATE_LIMIT_WRONG_STEP, true},
        {1.0 / 94.0, 1.0 / 94.0, 0.0, PALPATE_LIMIT_REDUCED | PALPATE_LIMIT_STOPPED, true}}) {
    const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
    const LimiterHandle limiter = default_limiter();
    EXPECT_EQ(palpate_limiter_set_lag(limiter.get(), lag_s), 0);
    EXPECT_EQ(palpate_limiter_set_lag(limiter.get(), NAN), -1);
    EXPECT_EQ(palpate_limiter_set_lag(limiter.get(), -1e-3), -1);
    OwnLoop loop{one.get(), limiter.get(), step_s, 1, given_s};
    loop.press();
    EXPECT_EQ(palpate_limiter_flags(limiter.get()), flags) << step_s << " " << given_s;
    EXPECT_EQ(palpate_limiter_stiffness_share(limiter.get()) < 0.95, softer) << step_s;
    EXPECT_LT(loop.swing_m(), 0.5e-3) << step_s << " " << given_s;
    loop.call(std::pair{loop.time_s, NAN});
    EXPECT_NE(palpate_limiter_flags(limiter.get()) & PALPATE_LIMIT_STOPPED, 0U);
  }
  // A pause of a minute is no delay for longer than it takes to forget one of 1/16 s.
  const StreamPtr paused = stream(model, {1e-5, 0.0, 0.0, 0.0});
  const LimiterHandle after = default_limiter();
  OwnLoop loop{paused.get(), after.get()};
  loop.press();
  loop.time_s += 60.0;
  palpate_limiter_render(after.get(), paused.get(), loop.time_s, loop.position_m, 60.0);
  for (int i = 0; i < 10000; ++i) loop.call();
  EXPECT_GE(palpate_limiter_stiffness_share(after.get()), 0.95);
  // A press in 0.2 s and back in 40 ms, with the force 5 ms late.
  const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
  const LimiterHandle limiter = default_limiter();
  palpate_limiter_set_lag(limiter.get(), 5e-3);
  unsigned flags = 0;
  for (int i = 0; i < 240; ++i) {
    const double depth_m = 4e-3 * std::min(i / 200.0, (240 - i) / 40.0);
    palpate_limiter_render(limiter.get(), one.get(), 1e-3 * i, 1e-5 * std::round(1e5 * depth_m), 1e-3);
    flags |= palpate_limiter_flags(limiter.get());
  }
  EXPECT_NE(flags & PALPATE_LIMIT_PASSIVE, 0U);
}

TEST_F(LibraryC, RenderingDoesNothingForbidden) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  const ModelHandle model = load(save(test::example_models().front()));
  const StreamPtr one = stream(model, {1e-5, 0.0, 0.0, 0.0});
  const LimiterHandle limiter = default_limiter();
  test::RtGuard guard;
  for (int i = 0; i < 2000; ++i) {
    const double jump_s = i % 100 < 3 ? 50.0 : i > 1500 ? -90.0 : 0.0;
    palpate_limiter_render(limiter.get(), one.get(), 1e-3 * (i - i % 7 / 6) + jump_s, 2e-3 * std::sin(0.01 * i), 1e-3);
  }
  EXPECT_EQ(guard.stop().total(), 0);
}

TEST_F(LibraryC, AnErrorIsCutBetweenCharacters) {
  const std::string name = folder_.path() + "/\xc3\xa9\xc3\xa9\xc3\xa9.json";  // three characters of two bytes
  char whole[300];
  ASSERT_EQ(palpate_model_load(name.c_str(), whole, sizeof whole), nullptr);
  for (std::size_t size = 1; size < std::string(whole).size(); ++size) {
    char cut[300];
    ASSERT_EQ(palpate_model_load(name.c_str(), cut, size), nullptr);
    const std::string text(cut);
    EXPECT_LT(text.size(), size);
    EXPECT_GE(text.size() + 2, size);
    EXPECT_EQ(std::string(whole).rfind(text, 0), 0U);
    EXPECT_NE(static_cast<unsigned char>(whole[text.size()]) & 0xC0U, 0x80U) << "cut inside a character";
  }
}

// A C99 program, built with warnings as errors and linked to the shared library.
TEST_F(LibraryC, ACProgramGivesReplaysForces) {
  const Recording recording = test::example_recording(1500, 1000.0, 30e-6);
  const std::string path = save(recording);
  const ModelData data = test::example_models().front();
  std::string input;
  for (const RecordingRow& row : recording.rows) {
    char line[100];
    std::snprintf(line, sizeof line, "%.17g %.17g\n", row.time_s, row.position_m);
    input += line;
  }
  const std::string command = std::string(PALPATE_C_PROGRAM) + " " + save(data) + " " + path + " " + path + " < " +
                              folder_.with_file("motion.txt", input);
  const auto run = test::run_program({"/bin/sh", "-c", command});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream forces(run.out);
  std::size_t rows = 0;
  replay(recording, {std::make_shared<FittedModel>(data)},
         [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
           std::string line;
           ASSERT_TRUE(std::getline(forces, line));
           EXPECT_EQ(std::strtod(line.c_str(), nullptr), snapshot.force_N[0]);
           ++rows;
         });
  EXPECT_EQ(rows, recording.rows.size());
}

// In pieces, to test that a batch continues where the previous one ended.
TEST_F(LibraryC, ABatchGivesWhatSamplesGiveOneByOne) {
  const Recording recording = with_channels(test::example_recording(1500, 1000.0, 30e-6));
  std::vector<double> time_s, position_m, velocity_m_per_s, acceleration_m_per_s2;
  for (const RecordingRow& row : recording.rows) {
    time_s.push_back(row.time_s);
    position_m.push_back(row.position_m);
    velocity_m_per_s.push_back(row.velocity_m_per_s);
    acceleration_m_per_s2.push_back(row.acceleration_m_per_s2);
  }
  time_s[700] = time_s[699];
  position_m[800] = NAN;
  const std::size_t n = time_s.size();
  const auto part = [&](std::size_t begin, std::size_t count) {
    return palpate_recording{"",
                             count,
                             &time_s[begin],
                             &position_m[begin],
                             nullptr,
                             &velocity_m_per_s[begin],
                             &acceleration_m_per_s2[begin]};
  };
  palpate_sensor sensor;
  const palpate_recording whole = part(0, n);
  ASSERT_EQ(palpate_sensor_of(&whole, &sensor), 0);
  for (const ModelData& data : test::example_models()) {
    const ModelHandle model = load(save(data));
    const StreamPtr one = stream(model, sensor);
    const StreamPtr batch = stream(model, sensor);
    const std::size_t width = palpate_model_feature_count(model.get());
    ASSERT_EQ(width, data.features.size());
    std::vector<double> force_N(n), bound_N(n), features(n * width);
    test::RtGuard guard;
    for (const auto& [begin, count] : {std::pair<std::size_t, std::size_t>{0, 100}, {100, n - 100}}) {
      const palpate_recording motion = part(begin, count);
      ASSERT_EQ(palpate_stream_replay(batch.get(), &motion, &force_N[begin], &bound_N[begin], &features[begin * width]),
                0);
    }
    EXPECT_EQ(test::rt_guard_works() ? guard.stop().total() : 0, 0) << data.name;
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(force_N[i], palpate_stream_force_with_motion(one.get(), time_s[i], position_m[i], velocity_m_per_s[i],
                                                             acceleration_m_per_s2[i]))
          << data.name << " row " << i;
      const double expected_N = palpate_stream_predicted_error(one.get());
      ASSERT_TRUE(bound_N[i] == expected_N || (std::isnan(bound_N[i]) && std::isnan(expected_N)));
    }
  }
  EXPECT_EQ(palpate_stream_forces(nullptr, n, time_s.data(), position_m.data(), position_m.data(), nullptr), -1);
}

TEST_F(LibraryC, AModelIsSavedWithItsBytes) {
  const ModelData data = test::example_models().front();
  const std::string path = save(data);
  const ModelHandle model = load(path);
  const std::string copy = folder_.file("copy.json");
  ASSERT_EQ(palpate_model_save(model.get(), copy.c_str(), 0, error_, sizeof error_), 0) << error_;
  EXPECT_EQ(test::read_text(copy), test::read_text(path));
  EXPECT_EQ(palpate_model_save(model.get(), copy.c_str(), 0, error_, sizeof error_), -1) << "it exists";
  EXPECT_NE(std::string(error_).find("copy.json"), std::string::npos);
}

// palpate::fit gives the same models in a separate program as `palpate fit`.

TEST(FitLibrary, FitsAndReplaysAsTheProgramDoes) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(test::run_palpate(
                {"synth", "--material", "silicone", "--seed", "4", "--seconds", "6", "--out", folder.file("rig.csv")})
                .exit_code,
            0);
  const std::string recording = folder.file("rig.csv");
  const auto run = test::run_program({PALPATE_CPP_PROGRAM, recording, folder.path()});
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto fit = test::run_palpate(
      {"fit", "--recording", recording, "--method", "random", "--centres", "40", "--out", folder.file("program.json")});
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(test::read_text(folder.file("program.json")), test::read_text(folder.file("fitted.json")));

  const auto replay = test::run_palpate(
      {"replay", "--recording", recording, "--model", folder.file("fitted.json"), "--out", folder.file("forces.csv")});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  std::istringstream printed(run.out);
  std::ifstream forces(folder.file("forces.csv"));
  std::string line;
  std::getline(forces, line);
  std::size_t rows = 0;
  while (std::getline(forces, line)) {
    std::string force;
    ASSERT_TRUE(std::getline(printed, force)) << "row " << rows;
    // The model's force is the last column.
    EXPECT_EQ(std::stod(line.substr(line.rfind(',') + 1)), std::stod(force)) << "row " << rows;
    ++rows;
  }
  EXPECT_GT(rows, 1000U);
}

}  // namespace
}  // namespace palpate
