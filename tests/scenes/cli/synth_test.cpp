// The program palpate synth.
#include <gtest/gtest.h>

#include "engine/recording/recording.h"
#include "scenes/material/rig.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

TEST(Synth, ListsTheMaterialsWithTheirRelaxationTimes) {
  const auto run = test::must_run({"synth", "--list"});
  EXPECT_EQ(run.err, "");
  for (const Material& material : materials())
    EXPECT_TRUE(test::has_parts(run.out, {std::string(material.name), std::string(material.relaxation_times)}));
}

TEST(Synth, WritesTheRecordingOfTheLibrary) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("maxwell.csv");
  const auto run = test::must_run(
      {"synth", "--material", "maxwell", "--seed", "3", "--seconds", "2", "--rate", "500", "--out", path});
  EXPECT_EQ(run.out, "written  " + path + ": 1000 rows, 1.998 s\n");
  EXPECT_EQ(run.err, "");
  const Recording read = test::must(read_recording(path));
  EXPECT_EQ(test::read_text(path).rfind("# virtual recording by palpate synth", 0), 0u);
  const Recording rig = test::must(record_sensors({"maxwell", 3, 2.0, 500.0}));
  ASSERT_EQ(read.rows.size(), 1000u);
  EXPECT_TRUE(read.columns.acceleration);
  for (std::size_t i = 0; i < read.rows.size(); ++i) {
    const RecordingRow& expected = rig.rows[i];
    ASSERT_EQ(read.rows[i].time_s, expected.time_s);
    ASSERT_EQ(read.rows[i].position_m, expected.position_m);
    ASSERT_EQ(read.rows[i].force_N, expected.force_N);
    ASSERT_EQ(read.rows[i].acceleration_m_per_s2, expected.acceleration_m_per_s2);
  }
}

TEST(Synth, WritesOverNothingWithoutForce) {
  const test::TemporaryFolder folder;
  const std::string path = folder.with_file("kept.csv", "mine\n");
  const std::vector<std::string> command = {"synth", "--material", "stiff", "--seconds", "1", "--out", path};
  EXPECT_TRUE(test::fails(1, command, {"--force"}));
  EXPECT_EQ(test::read_text(path), "mine\n");
  std::vector<std::string> forced = command;
  forced.push_back("--force");
  EXPECT_EQ(run_palpate(forced).exit_code, 0);
  EXPECT_NE(test::read_text(path), "mine\n");
}

TEST(Synth, WrongUsageEndsWithTwoAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("x.csv");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--material", "silicone"},
      {"--out", out},
      {"--material", "jelly", "--out", out},
      {"--material", "silicone", "--out", out, "--seconds", "0"},
      {"--material", "silicone", "--out", out, "--seconds", "soon"},
      {"--material", "silicone", "--out", out, "--rate", "9"},
      {"--material", "silicone", "--out", out, "--seed", "-1"},
      {"--material", "silicone", "--out", out, "--seed", "one"},
      {"--material", "silicone", "--out", out, "--seed", "99999999999999999999"},
  };
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), "synth");
    EXPECT_TRUE(test::fails(2, arguments));
  }
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace palpate
