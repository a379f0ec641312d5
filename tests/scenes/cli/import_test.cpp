// The program palpate import.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

const std::string kFiles = std::string(PALPATE_SOURCE_DIR) + "/tests/engine/import/files/";

TEST(ImportVerb, WritesARecordingAndPrintsTheGuesses) {
  const test::TemporaryFolder folder;
  const auto run = test::must_run({"import", kFiles + "08_excel_de.csv", "--out", folder.file("rec.csv")});
  EXPECT_TRUE(test::has_parts(run.out, {"semicolon", "decimal comma", "UTF-8", "line 1", "24 read, lines 2 to 25",
                                        "position", "2 \"Weg [mm]\" in mm", " check "}));
  EXPECT_EQ(test::must(read_recording(folder.file("rec.csv"))).rows.size(), 24u);
}

// The commands of a refusal are complete: one of them leads to a recording.
TEST(ImportVerb, TheCommandsOfARefusalCanBeRun) {
  const test::TemporaryFolder folder;
  const std::string press = test::read_text(kFiles + "02_matlab.csv");
  const std::string both = folder.with_file("both.csv", press + press), out = folder.file("rec.csv");
  const auto refused = run_palpate({"import", both, "--out", out, "--json"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(test::has_parts(refused.err, {"error: " + both + ": found numbers in 2 blocks",
                                            " import " + both + " --out " + out + " --json --block 1  # lines 2 to 25",
                                            " --block 2  # lines 27 to 50"}));
  const auto json = nlohmann::json::parse(test::must_run({"import", both, "--out", out, "--json", "--block", "2"}).out);
  EXPECT_EQ(json["rows"], 24);
  EXPECT_EQ(json["first_line"], 27);
  EXPECT_EQ(json["left_out"][0].dump(), R"({"first_line":2,"last_line":25,"reason":"in another block","rows":24})");
}

TEST(ImportVerb, WritesOverNothingWithoutForceAndLeavesNothingAfterAnError) {
  const test::TemporaryFolder folder;
  const std::string kept = folder.with_file("kept.csv", "mine\n");
  EXPECT_TRUE(test::fails(1, {"import", kFiles + "02_matlab.csv", "--out", kept}, {"--force"}));
  EXPECT_EQ(test::read_text(kept), "mine\n");
  EXPECT_EQ(run_palpate({"import", kFiles + "20_bare.txt", "--out", folder.file("new.csv")}).exit_code, 1);
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"kept.csv"});
}

TEST(ImportVerb, FlipsPositionForceOrBoth) {
  const test::TemporaryFolder folder;
  const auto first_row = [&](const std::string& flip) {
    const std::string out = folder.file(flip + ".csv");
    test::must_run({"import", kFiles + "02_matlab.csv", "--out", out, "--flip", flip});
    return read_recording(out)->rows[5];
  };
  const RecordingRow position = first_row("position"), force = first_row("force"), both = first_row("both");
  EXPECT_EQ(position.position_m, -force.position_m);
  EXPECT_EQ(position.force_N, -force.force_N);
  EXPECT_EQ(both.position_m, position.position_m);
  EXPECT_EQ(both.force_N, force.force_N);
  EXPECT_NE(both.force_N, 0.0);
}

TEST(ImportVerb, MovesTheOriginUnderBothNames) {
  const test::TemporaryFolder folder;
  for (const std::string option : {"--origin", "--zero"}) {
    const std::string out = folder.file(option.substr(2) + ".csv");
    test::must_run({"import", kFiles + "02_matlab.csv", "--out", out, option, "first"});
    const Recording recording = *read_recording(out);
    EXPECT_EQ(recording.rows[0].position_m, 0.0) << option << ": -1 mm in the file";
    EXPECT_NEAR(recording.rows[1].position_m, 0.522e-3, 1e-6) << option;
  }
}

// A pad that is pressed with some 5 N before each recording begins, at another height each time.
TEST(ImportVerb, MovesTheBeginningToThatOfARecordingUnderTheSamePreload) {
  const test::TemporaryFolder folder;
  std::string train = "time_s,position_m,force_N\n", other = train;
  for (int i = 0; i < 50; ++i) {
    train += fixed(0.01 * i, 2) + "," + fixed(2e-3 + 1e-5 * i, 5) + "," + fixed(5.0 + 0.1 * i, 2) + "\n";
    other += fixed(0.01 * i, 2) + "," + fixed(7e-3 + 1e-5 * i, 5) + "," + fixed(5.2 + 0.1 * i, 2) + "\n";
  }
  const std::string begin = folder.with_file("train.csv", train), out = folder.file("rec.csv");
  const std::string file = folder.with_file("other.csv", other), out_of_air = folder.file("x.csv");
  const auto run = test::must_run({"import", file, "--out", out, "--begin-as", begin});
  EXPECT_TRUE(test::has_parts(run.out, {"position 0 was at 5.0000 mm in the table", "begins where", "train.csv does"}));
  EXPECT_NEAR(read_recording(out)->rows.back().position_m, 2.49e-3, 1e-9);
  EXPECT_TRUE(test::fails(1, {"import", kFiles + "02_matlab.csv", "--out", out_of_air, "--begin-as", begin},
                          {"expected the same preload of more than 0.2 N"}));
}

TEST(ImportVerb, WrongUsageEndsWithTwo) {
  const test::TemporaryFolder folder;
  const std::string file = kFiles + "02_matlab.csv";
  const std::string out = folder.file("x.csv");
  using Option = std::pair<std::string, std::string>;
  for (const auto& [option, value] : {Option{"--columns", "weg=2"},
                                      {"--units", "furlong"},
                                      {"--units", "mm,cm"},
                                      {"--flip", "time"},
                                      {"--rate", "0"},
                                      {"--rate", "nan"},
                                      {"--gain", "0"},
                                      {"--gain", "nan"},
                                      {"--skip-bad-rows", "-1"},
                                      {"--rows", "9-2"},
                                      {"--tare", "x"}})
    EXPECT_EQ(run_palpate({"import", file, "--out", out, option, value}).exit_code, 2) << value;
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace palpate
