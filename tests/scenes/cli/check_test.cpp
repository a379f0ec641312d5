// The program palpate check.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/recording/recording.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

std::string pressed(double sign, double inward = 1.0) {
  std::string text = "time_s,position_m,force_N\n";
  for (int i = 0; i < 600; ++i) {
    const double phase = (i % 200) / 100.0;
    const double position_mm = 5.0 * (phase < 1.0 ? phase : 2.0 - phase) - 1.0;
    const double force_N = position_mm > 0.0 ? sign * 0.5 * position_mm : 0.0;
    text += std::to_string(0.01 * i) + "," + std::to_string(1e-3 * inward * position_mm) + "," +
            std::to_string(force_N) + "\n";
  }
  return text;
}

TEST(CheckVerb, PrintsTheVerdictFirst) {
  const test::TemporaryFolder folder;
  const auto run = test::must_run({"check", folder.with_file("good.csv", pressed(1.0)), "--json"});
  const auto object = nlohmann::json::parse(run.out);
  EXPECT_NE(object["recordings"][0]["verdict"], "unusable");
  for (const char* field : {"file", "findings", "noise_floor_within_jnd", "surface_offset_m", "force_zero_N"}) {
    EXPECT_TRUE(object["recordings"][0].contains(field)) << field;
  }
}

TEST(CheckVerb, EndsWithOneForARecordingThatFitsNothing) {
  const test::TemporaryFolder folder;
  const std::string bad = folder.with_file("bad.csv", pressed(-1.0));
  const auto check = run_palpate({"check", bad});
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_EQ(check.err, "error: " + bad + ": not usable for a fit: force_sign; follow the advice above\n");
  EXPECT_TRUE(test::has_parts(check.out, {"fatal", "force_sign", "--flip force"}));
  EXPECT_TRUE(test::fails(1, {"fit", "--recording", bad, "--method", "greedy", "--out", folder.file("m.json")},
                          {bad + ": force_sign: "}));
}

// Both signs are wrong: the error names all that check prints.
TEST(CheckVerb, TheErrorNamesEveryFatalFinding) {
  const test::TemporaryFolder folder;
  const auto check = run_palpate({"check", folder.with_file("bad.csv", pressed(-1.0, -1.0))});
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_TRUE(test::has_parts(check.out, {"position_sign", "--flip both", "force_sign", "--flip both"}));
  EXPECT_TRUE(test::has_parts(check.err, {"error: ", "position_sign, force_sign"}));
}

// A sensor offset and a moved surface: the command that check prints gives a recording without either.
TEST(CheckVerb, PrintsTheCommandThatCorrectsTheZeros) {
  const test::TemporaryFolder folder;
  const std::string rec = folder.file("rec.csv"), moved = folder.file("moved.csv");
  test::must_run({"synth", "--material", "silicone", "--seed", "1", "--seconds", "20", "--out", rec});
  test::must_run({"import", rec, "--tare", "-0.18", "--zero", "-0.0124", "--out", moved});
  const auto check = test::must_run({"check", moved});
  const std::string options = " --tare auto --zero contact --out " + folder.file("moved_zeroed.csv");
  EXPECT_TRUE(test::has_parts(check.out, {"force is 0.18 N in free air", " import " + moved + options}));
  test::must_run({"import", moved, "--tare", "auto", "--zero", "contact", "--out", folder.file("moved_zeroed.csv")});
  const auto before = test::must(read_recording(rec)).rows,
             after = test::must(read_recording(folder.file("moved_zeroed.csv"))).rows;
  ASSERT_EQ(before.size(), after.size());
  EXPECT_NEAR(before[5000].force_N, after[5000].force_N, 2e-3);
  EXPECT_NEAR(before[5000].position_m, after[5000].position_m, 0.05e-3);
  EXPECT_EQ(before[5000].acceleration_m_per_s2, after[5000].acceleration_m_per_s2);
}

}  // namespace
}  // namespace palpate
