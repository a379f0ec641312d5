#include "models/check/check_recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/base/text.h"
#include "engine/tick/motion_estimator.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

const CheckRequest kSilicone{JndLine{}, true};

Recording silicone() {
  static const Recording made = *test::rig_recording(test::train_settings("silicone"));
  return made;
}

RecordingCheck checked(const Recording& recording, const CheckRequest& request, const RecordingFaults& faults = {}) {
  return check_recording(*prepare_recording(recording), request, faults);
}

const Finding* find(const RecordingCheck& check, const std::string& code) {
  for (const Finding& finding : check.findings) {
    if (finding.code == code) return &finding;
  }
  return nullptr;
}

std::string all_of(const RecordingCheck& check) {
  std::string text;
  for (const Finding& f : check.findings)
    text += std::string(severity_name(f.severity)) + " " + f.code + ": " + f.text + "\n";
  return text;
}

void each(Recording& recording, const std::function<void(RecordingRow&)>& change) {
  for (RecordingRow& row : recording.rows) change(row);
}

// Delays the force by `seconds`.
void delay_force(Recording& recording, double seconds) {
  const Recording before = recording;
  std::size_t j = 0;
  for (RecordingRow& row : recording.rows) {
    while (j + 1 < before.rows.size() && before.rows[j + 1].time_s <= row.time_s - seconds) ++j;
    row.force_N = before.rows[j].force_N;
  }
}

void first_seconds(Recording& recording, double from_s, double seconds) {
  std::erase_if(recording.rows,
                [&](const RecordingRow& row) { return row.time_s < from_s || row.time_s > from_s + seconds; });
}

// A press of 8 s to 5 mm; its force relaxes with `relaxation_s` by a half.
Recording press_and_hold(double relaxation_s) {
  Recording recording;
  for (int i = 0; i < 1200; ++i) {
    const double time_s = 0.01 * i;
    const double position_m = std::clamp(5e-3 * std::min(time_s - 1.0, 11.0 - time_s), -1e-3, 5e-3);
    const double relaxed = 0.5 + 0.5 * std::exp(-std::max(0.0, time_s - 2.0) / relaxation_s);
    recording.rows.push_back(
        {.time_s = time_s, .position_m = position_m, .force_N = 600.0 * relaxed * std::max(0.0, position_m)});
  }
  return recording;
}

// The own force decides whether a hold is long enough, and no time of another material.
TEST(CheckRecording, AHoldLastsUntilTheForceStaysTheSame) {
  for (const double relaxation_s : {0.2, 1.0}) {
    const RecordingCheck check = checked(press_and_hold(relaxation_s), kSilicone);
    EXPECT_EQ(find(check, "no_hold"), nullptr) << all_of(check);
    EXPECT_EQ(find(check, "short_hold"), nullptr) << all_of(check);
  }
  const RecordingCheck check = checked(press_and_hold(8.0), kSilicone);
  const Finding* found = find(check, "short_hold");
  ASSERT_NE(found, nullptr) << all_of(check);
  // 1.5 N of 10 (exp(-0.5) - exp(-0.6) - exp(-0.9) + exp(-1)), the means of exp(-t / 8) over 0.8 s; rows are 10 ms.
  EXPECT_NEAR(check.measures.hold_change_N, -0.2855, 0.005);
  EXPECT_EQ(find(checked(press_and_hold(8.0), CheckRequest{}), "short_hold"), nullptr) << "no memory";
}

// Each fault is found, and following its advice removes the finding or its advice.
TEST(CheckRecording, FindsEachFaultWhichItsAdviceRemoves) {
  using Change = std::function<void(Recording&)>;
  struct Fault {
    const char* code;
    const char* verdict;
    Change fault;
    Change remedy;
  };
  const auto scale_force = [](double factor) {
    return [=](Recording& r) { each(r, [=](RecordingRow& row) { row.force_N *= factor; }); };
  };
  const auto add = [](double RecordingRow::*column, double value) {
    return [=](Recording& r) { each(r, [=](RecordingRow& row) { row.*column += value; }); };
  };
  const auto flip_position = [](Recording& r) { each(r, [](RecordingRow& row) { row.position_m = -row.position_m; }); };
  const auto pause = [](Recording& r) {
    each(r, [](RecordingRow& row) {
      if (row.time_s > 10.0) row.time_s += 5.0;
    });
  };
  const auto cut = [](double from_s, double seconds) {
    return [=](Recording& r) { first_seconds(r, from_s, seconds); };
  };
  const auto hold = [](Recording& r) { each(r, [](RecordingRow& row) { row.position_m = 0.002; }); };
  const auto clip = [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N = std::min(row.force_N, 2.0); }); };
  const auto delay = [](Recording& r) { delay_force(r, 0.03); };
  const auto record_again = [](Recording& r) { r = silicone(); };
  const std::vector<Fault> faults = {
      {"force_sign", "unusable", scale_force(-1.0), scale_force(-1.0)},
      {"position_sign", "unusable", flip_position, flip_position},
      {"no_force", "unusable", scale_force(0.0), record_again},
      {"no_motion", "unusable", hold, record_again},
      {"no_contact", "unusable", add(&RecordingRow::position_m, -0.05), add(&RecordingRow::position_m, 0.05)},
      {"force_unit", "care", scale_force(1000.0), scale_force(1e-3)},
      {"force_zero", "care", add(&RecordingRow::force_N, 0.5), add(&RecordingRow::force_N, -0.5)},
      {"clipping", "care", clip, record_again},
      {"lag", "care", delay, record_again},
      {"gap", "care", pause, cut(0.0, 10.0)},
  };
  for (const Fault& one : faults) {
    SCOPED_TRACE(one.code);
    Recording recording = silicone();
    one.fault(recording);
    const RecordingCheck before = checked(recording, kSilicone);
    const Finding* const finding = find(before, one.code);
    ASSERT_NE(finding, nullptr) << all_of(before);
    EXPECT_STREQ(before.verdict(), one.verdict) << all_of(before);
    EXPECT_FALSE(finding->advice.empty());
    one.remedy(recording);
    const RecordingCheck remedied = checked(recording, kSilicone);
    const Finding* const after = find(remedied, one.code);
    EXPECT_TRUE(after == nullptr || after->advice.empty());
  }
}

TEST(CheckRecording, TellsThatTheSpecimenSlips) {
  const auto pressed_again = [](double slip_m) {
    Recording recording = press_and_hold(8.0);
    for (int i = 0; i < 600; ++i) recording.rows.push_back({.time_s = 12.0 + 0.01 * i, .position_m = -1e-3});
    for (const RecordingRow& row : press_and_hold(8.0).rows)
      recording.rows.push_back({row.time_s + 18.0, row.position_m + slip_m, row.force_N});
    return checked(recording, CheckRequest{});
  };
  EXPECT_EQ(find(pressed_again(0.0), "surface_drift"), nullptr);
  const RecordingCheck check = pressed_again(0.3e-3);
  const Finding* const finding = find(check, "surface_drift");
  ASSERT_NE(finding, nullptr) << all_of(check);
  EXPECT_NEAR(finding->value, 0.3e-3, 0.03e-3);
}

TEST(CheckRecording, TellsTheMassThatTheForceSensorCarries) {
  Recording heavy = silicone();
  each(heavy, [](RecordingRow& row) { row.force_N += 0.06 * row.acceleration_m_per_s2; });
  const RecordingCheck check = checked(heavy, kSilicone);
  const Finding* const finding = find(check, "tool_mass");
  ASSERT_NE(finding, nullptr) << all_of(check);
  EXPECT_NEAR(finding->value, 0.06, 0.01);
  EXPECT_EQ(find(check, "adhesion"), nullptr) << "inertia pulls, the material does not";
}

// Adhesion: on retreat an additional pull of 0.3 N over the last millimetre.
TEST(CheckRecording, TellsThatTheMaterialPulls) {
  Recording sticky = silicone();
  EXPECT_EQ(find(checked(sticky, kSilicone), "adhesion"), nullptr);
  double before_m = 0.0;
  each(sticky, [&](RecordingRow& row) {
    if (row.position_m < before_m && row.position_m > 0.0 && row.position_m < 1e-3) row.force_N -= 0.3;
    before_m = row.position_m;
  });
  const RecordingCheck check = checked(sticky, kSilicone);
  const Finding* const finding = find(check, "adhesion");
  ASSERT_NE(finding, nullptr) << all_of(check);
  EXPECT_NEAR(finding->value, 0.3, 0.1);
  EXPECT_STREQ(check.verdict(), "usable") << all_of(check);
}

// A block pressed from 3 mm to 8 mm and back, always in contact.
TEST(CheckRecording, WithoutFreeAirNothingIsToldOfSurfaceAndZero) {
  Recording recording;
  for (int i = 0; i < 8000; ++i) {
    const double depth_m = 5.5e-3 - 2.5e-3 * std::cos(2e-3 * 3.0 * i);
    recording.rows.push_back({2e-3 * i, depth_m, 500.0 * depth_m + 0.1 * std::sin(7.0 * i) * 0.05, 0.0, 0.0});
  }
  const RecordingCheck check = checked(recording, CheckRequest{});
  EXPECT_FALSE(check.surface_identified);
  EXPECT_EQ(check.surface_offset_m, 0.0);
  EXPECT_EQ(check.force_zero_N, 0.0);
  EXPECT_NE(find(check, "surface_unknown"), nullptr) << all_of(check);
  const Finding* const begins = find(check, "begins_in_contact");
  ASSERT_NE(begins, nullptr) << all_of(check);
  EXPECT_NEAR(begins->value, 1.5, 0.1);
  EXPECT_EQ(find(checked(silicone(), kSilicone), "begins_in_contact"), nullptr);
  for (const char* code : {"surface_offset", "force_zero", "force_zero_drift", "lag"}) {
    EXPECT_EQ(find(check, code), nullptr) << all_of(check);
  }
}

// The highest value of a quantised or held force is no limit of the sensor; a limit is found in all of them.
TEST(CheckRecording, TellsAHeldOrQuantisedTopFromClipping) {
  const auto change = [](double limit_N, double step_N, std::size_t rows) {
    Recording recording = silicone();
    double value_N = 0.0;
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      double& force_N = recording.rows[i].force_N;
      if (i % rows == 0) value_N = std::min(limit_N, step_N * std::round(force_N / step_N));
      force_N = value_N;
    }
    RecordingFaults faults = remove_faults(recording);
    return checked(recording, kSilicone, faults);
  };
  const double peak_N = std::ranges::max(silicone().rows, {}, &RecordingRow::force_N).force_N;
  for (const double step_N : {1e-6, 0.1}) {
    for (const std::size_t rows : {1u, 12u}) {
      const std::string place = general(step_N, 3) + " N, " + std::to_string(rows) + " rows";
      const RecordingCheck whole = change(1e6, step_N, rows);
      EXPECT_EQ(find(whole, "clipping"), nullptr) << place << "\n" << all_of(whole);
      const RecordingCheck limited = change(0.5 * peak_N, step_N, rows);
      EXPECT_NE(find(limited, "clipping"), nullptr) << place << "\n" << all_of(limited);
    }
  }
}

TEST(CheckRecording, BlamesNoVirtualMaterial) {
  for (const Material& material : materials()) {
    for (const std::uint64_t seed : {1ULL, 2ULL, 3ULL}) {
      SCOPED_TRACE(std::string(material.name) + " " + std::to_string(seed));
      RigSettings settings;
      settings.material = std::string(material.name);
      settings.seed = seed;
      const RecordingCheck check = checked(*test::rig_recording(settings), CheckRequest{});
      for (const Finding& finding : check.findings) {
        EXPECT_NE(finding.severity, Severity::fatal) << all_of(check);
        EXPECT_NE(finding.code, "lag") << all_of(check);
        EXPECT_NE(finding.code, "clipping") << all_of(check);
      }
    }
  }
}

TEST(CheckRecording, BlamesNoRealRecording) {
  if (!std::filesystem::exists(test::real_data())) GTEST_SKIP() << "no real recordings here";
  for (const std::filesystem::path& folder : {test::real_data(), test::real_data() / "../labs"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".csv") continue;
      const auto checked = check_recording_file(entry.path().string(), CheckRequest{});
      ASSERT_TRUE(checked.ok()) << checked.error().message;
      RecordingFaults faults;
      EXPECT_TRUE(read_prepared_recording(entry.path().string(), faults).ok() && !faults.any()) << entry.path();
      EXPECT_STRNE(checked->check.verdict(), "unusable") << entry.path() << "\n" << all_of(checked->check);
      EXPECT_EQ(find(checked->check, "lag"), nullptr) << entry.path() << "\n" << all_of(checked->check);
      // The force sensor of one rig drifts by 0.2 to 0.4 N.
      const bool wanders = entry.path().string().find("bench_indenter") != std::string::npos;
      EXPECT_TRUE(wanders || find(checked->check, "force_zero_drift") == nullptr) << entry.path();
      const Finding* const strokes = find(checked->check, "strokes");
      ASSERT_NE(strokes, nullptr) << entry.path();
      EXPECT_LE(strokes->value, 6.0) << entry.path();
    }
  }
}

// Recordings with different forces at the same depth, and cases that only look like that.

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

// Identification of a force lag, separately from viscosity (a force lead), and without false alarms.

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

TEST(ForceLag, FindsALateForce) {
  for (const auto& [material, late_s] :
       {std::pair{"silicone", 8e-3}, std::pair{"foam", 30e-3}, std::pair{"stiff", -10e-3}}) {
    const OffsetEstimate found = lag_of(material, late_s);
    EXPECT_TRUE(found.identified) << material;
    EXPECT_NEAR(found.at, late_s, 2e-3) << material;  // s
  }
}

// Presses whose depth jumps fit no law: the blocks disagree on the lag by some milliseconds, but not that there is one.
// A late force in free air is no drift.
TEST(ForceLag, IsNamedWhereThePressesJump) {
  const auto check_of = [](double late_s) {
    Recording recording;
    double slow_m = 0.0;
    for (int i = 0; i < 15000; ++i) {
      const double time_s = 0.002 * i, rates_Hz[] = {0.25, 0.6, 1.1, 2.0};
      const auto depth_m = [&](double at_s) {
        const int part = std::clamp(static_cast<int>(at_s / 7.5), 0, 3);
        const double turn = 2.0 * std::numbers::pi * rates_Hz[part] * (at_s - 7.5 * part);
        return -1e-3 + 4e-3 * (1.0 - std::cos(turn)) * (0.6 + 0.4 * std::sin(0.37 * at_s));
      };
      const double late_m = std::max(0.0, depth_m(time_s - late_s));
      slow_m += 0.002 / 0.4 * (late_m - slow_m);
      const double force_N = late_m > 0.0 ? 900.0 * late_m + 4e4 * late_m * late_m + 500.0 * (late_m - slow_m) : 0.0;
      recording.rows.push_back({time_s, depth_m(time_s), force_N + 0.004 * std::sin(1.7 * i * i)});
    }
    return checked(recording, CheckRequest{});
  };
  EXPECT_EQ(find(check_of(0.0), "lag"), nullptr);
  for (const double late_s : {-0.3, -0.1, 0.01, 0.03, 0.1, 0.3, 0.5}) {
    const RecordingCheck check = check_of(late_s);
    ASSERT_NE(find(check, "lag"), nullptr) << late_s << all_of(check);
    EXPECT_NEAR(find(check, "lag")->value, late_s, 6e-3) << late_s;
    EXPECT_EQ(find(check, "force_zero_drift"), nullptr) << late_s << all_of(check);
  }
}

TEST(ForceLag, InventsNone) {
  for (const Material& material : materials()) {
    EXPECT_EQ(lag_of(std::string(material.name), 0.0).at, 0.0) << material.name;
  }
}

TEST(NoiseFloor, IsThatOfANormalErrorAtOneForce) {
  // Noise of 65 mN at a mean force of 0 N is one JND: erf(1 / sqrt 2) = 68.27 % are within the
  // JND, and the 99 % quantile is 2.576 JND.
  Recording recording;
  RandomStream random(1, 0);
  for (int i = 0; i < 20000; ++i) recording.rows.push_back({1e-3 * i, 1e-3, 0.065 * random.normal()});
  const PreparedRecordingPointer prepared = prepare_recording(recording);
  const NoiseFloor floor = noise_floor({prepared.get()}, JndLine{0.065, 0.0});
  EXPECT_NEAR(floor.force_noise_N, 0.065, 0.002);  // the standard error of the 0.2 quantile of 400 windows, twice
  const double noise_over_jnd = floor.force_noise_N / 0.065;
  EXPECT_NEAR(floor.within_jnd, std::erf(1.0 / (std::sqrt(2.0) * noise_over_jnd)), 0.01);
  EXPECT_NEAR(floor.p99_error_over_jnd, 2.576 * noise_over_jnd, 0.03);
  // At 20 Hz the motion changes the force by more than the noise from row to row.
  for (std::size_t i = 0; i < recording.rows.size(); ++i)
    recording.rows[i].force_N += std::sin(0.5 * static_cast<double>(i));
  const PreparedRecordingPointer moved = prepare_recording(recording);
  EXPECT_FALSE(noise_floor({moved.get()}, JndLine{0.065, 0.0}).known);
  EXPECT_TRUE(floor.known);
}

}  // namespace
}  // namespace palpate
