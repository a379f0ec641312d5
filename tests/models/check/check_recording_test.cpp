// Each fault of a recording is found, and no good recording is blamed for one.
#include "models/check/check_recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "scenes/material/rig.h"
#include "tests/support/fitting.h"

namespace palpate {
namespace {

const CheckRequest kSilicone{JndLine{}, {0.17, 1.27}};

Recording silicone() {
  static const Recording made = *test::rig_recording(test::train_settings("silicone"));
  return made;
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

struct Fault {
  const char* code;
  const char* verdict;
  std::function<void(Recording&)> apply;
};

void each(Recording& recording, const std::function<void(RecordingRow&)>& change) {
  for (RecordingRow& row : recording.rows) change(row);
}

// The force of `seconds` ago.
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

TEST(CheckRecording, FindsEachFault) {
  const std::vector<Fault> faults = {
      {"force_sign", "unusable", [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N = -row.force_N; }); }},
      {"position_sign", "unusable",
       [](Recording& r) { each(r, [](RecordingRow& row) { row.position_m = -row.position_m; }); }},
      {"no_force", "unusable", [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N = 0.0; }); }},
      {"no_motion", "unusable", [](Recording& r) { each(r, [](RecordingRow& row) { row.position_m = 0.002; }); }},
      {"force_unit", "unusable", [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N *= 1000.0; }); }},
      {"force_unit", "care", [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N /= 9.80665e-3; }); }},
      {"clipping", "care",
       [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N = std::min(row.force_N, 2.0); }); }},
      {"force_zero", "care", [](Recording& r) { each(r, [](RecordingRow& row) { row.force_N += 0.5; }); }},
      {"lag", "care", [](Recording& r) { delay_force(r, 0.03); }},
      {"gap", "care",
       [](Recording& r) {
         each(r, [](RecordingRow& row) {
           if (row.time_s > 10.0) row.time_s += 5.0;
         });
       }},
      {"too_short", "care", [](Recording& r) { first_seconds(r, 2.0, 1.0); }},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.code);
    Recording recording = silicone();
    fault.apply(recording);
    const RecordingCheck check = check_recording(recording, kSilicone);
    const Finding* const finding = find(check, fault.code);
    EXPECT_NE(finding, nullptr) << all_of(check);
    EXPECT_STREQ(check.verdict(), fault.verdict) << all_of(check);
    if (finding == nullptr) continue;
    EXPECT_FALSE(finding->advice.empty());
  }
}

// On retreat 0.3 N more pull than the material's own force, over its last millimetre.
TEST(CheckRecording, TellsThatTheMaterialPulls) {
  Recording sticky = silicone();
  EXPECT_EQ(find(check_recording(sticky, kSilicone), "adhesion"), nullptr);
  double before_m = 0.0;
  each(sticky, [&](RecordingRow& row) {
    if (row.position_m < before_m && row.position_m > 0.0 && row.position_m < 1e-3) row.force_N -= 0.3;
    before_m = row.position_m;
  });
  const RecordingCheck check = check_recording(sticky, kSilicone);
  const Finding* const finding = find(check, "adhesion");
  ASSERT_NE(finding, nullptr) << all_of(check);
  EXPECT_NEAR(finding->value, 0.3, 0.1);
  EXPECT_STREQ(check.verdict(), "usable") << all_of(check);
}

// A block pressed from 3 mm to 8 mm and back, without ever letting go.
TEST(CheckRecording, WithoutFreeAirNothingIsToldOfSurfaceAndZero) {
  Recording recording;
  for (int i = 0; i < 8000; ++i) {
    const double depth_m = 5.5e-3 - 2.5e-3 * std::cos(2e-3 * 3.0 * i);
    recording.rows.push_back({2e-3 * i, depth_m, 500.0 * depth_m + 0.1 * std::sin(7.0 * i) * 0.05, 0.0, 0.0});
  }
  const RecordingCheck check = check_recording(recording, CheckRequest{});
  EXPECT_FALSE(check.surface_told);
  EXPECT_EQ(check.surface_offset_m, 0.0);
  EXPECT_EQ(check.force_zero_N, 0.0);
  EXPECT_NE(find(check, "surface_unknown"), nullptr) << all_of(check);
  for (const char* code : {"surface_offset", "force_zero", "force_zero_drift", "lag"}) {
    EXPECT_EQ(find(check, code), nullptr) << all_of(check);
  }
}

// What softens as it goes in looks like a flipped sign, and free air does not.
TEST(CheckRecording, OnlyWarnsOfSignsWhereAMaterialMayBeLikeThat) {
  Recording softening;
  for (int i = 0; i < 1000; ++i) {
    const double share = 1e-3 * i;
    const double force_N = share < 0.2 ? 0.2 + 8.0 * share : 1.8 - 1.9 * (share - 0.2);
    softening.rows.push_back({1e-2 * i, 2e-3 * share, force_N, 0.0, 0.0});
  }
  const RecordingCheck check = check_recording(softening, CheckRequest{});
  EXPECT_STRNE(check.verdict(), "unusable") << all_of(check);
}

TEST(CheckRecording, CountsStrokesAlikeAtEveryRate) {
  for (const double rate_Hz : {10.0, 100.0, 2000.0}) {
    Recording recording;
    const auto rows = static_cast<int>(20.0 * rate_Hz);
    for (int i = 0; i < rows; ++i) {
      const double time_s = i / rate_Hz;
      const double depth_m = 5e-3 * (1.0 - std::cos(2.0 * 3.141592653589793 * 0.25 * time_s)) - 1e-3;
      recording.rows.push_back({time_s, depth_m, 300.0 * std::max(0.0, depth_m), 0.0, 0.0});
    }
    const RecordingCheck check = check_recording(recording, CheckRequest{});
    const Finding* const strokes = find(check, "strokes");
    ASSERT_NE(strokes, nullptr) << all_of(check);
    EXPECT_EQ(strokes->value, 5.0) << rate_Hz;
  }
}

TEST(CheckRecording, FindsAMonotonicCompressionOnlyForASceneWithMemory) {
  Recording recording;
  for (int i = 0; i < 1000; ++i) {
    const double depth_m = 1e-5 * i;
    recording.rows.push_back({0.05 * i, depth_m, 500.0 * depth_m, 0.0, 0.0});
  }
  EXPECT_NE(find(check_recording(recording, kSilicone), "monotonic"), nullptr);
  EXPECT_EQ(find(check_recording(recording, CheckRequest{}), "monotonic"), nullptr);
}

TEST(CheckRecording, BlamesNoVirtualMaterial) {
  for (const Material& material : materials()) {
    for (const std::uint64_t seed : {1ULL, 2ULL, 3ULL}) {
      SCOPED_TRACE(std::string(material.name) + " " + std::to_string(seed));
      RigSettings settings;
      settings.material = std::string(material.name);
      settings.seed = seed;
      const RecordingCheck check = check_recording(*test::rig_recording(settings), CheckRequest{});
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
      EXPECT_STRNE(checked->check.verdict(), "unusable") << entry.path() << "\n" << all_of(checked->check);
      EXPECT_EQ(find(checked->check, "lag"), nullptr) << entry.path() << "\n" << all_of(checked->check);
      // The sensor of one rig wanders by 0.2 to 0.4 N.
      const bool wanders = entry.path().string().find("bench_indenter") != std::string::npos;
      EXPECT_TRUE(wanders || find(checked->check, "force_zero_drift") == nullptr) << entry.path();
      const Finding* const strokes = find(checked->check, "strokes");
      ASSERT_NE(strokes, nullptr) << entry.path();
      EXPECT_LE(strokes->value, 6.0) << entry.path();
    }
  }
}

}  // namespace
}  // namespace palpate
