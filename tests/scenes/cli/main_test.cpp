#include "tests/support/message_parts.h"

#include <nlohmann/json.hpp>

#include <filesystem>

#include "engine/recording/recording.h"
#include "scenes/cli/verbs.h"
#include "scenes/material/material.h"
#include "scenes/scene/scene.h"
#include "scenes/study/study_file.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// The whole program: exit codes and output.

using test::run_palpate;
using test::run_program;

TEST(Main, HelpAndVersionGoToStandardOutput) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"--version"}, {"scenes", "--help"}, {"devices", "--help"}}) {
    const auto run = test::must_run(arguments);
    EXPECT_FALSE(run.out.empty());
    EXPECT_EQ(run.err, "");
  }
  EXPECT_EQ(run_palpate({"--version"}).out.rfind("palpate ", 0), 0u);
}

TEST(Main, HelpIsAVerbToo) {
  EXPECT_EQ(test::must_run({"help"}).out, test::must_run({"--help"}).out);
  EXPECT_EQ(test::must_run({"help", "fit"}).out, test::must_run({"fit", "--help"}).out);
  EXPECT_TRUE(test::fails(2, {"help", "fti"}, {"verb \"fti\"; did you mean fit?"}));
}

TEST(Main, WrongUsageIsOneLineThatNamesTheVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"dance"}, {"--dance"}, {""}}) {
    EXPECT_TRUE(test::fails(2, arguments, {"known verbs: ", "scenes, devices"}));
  }
}

// CLI11 reports a missing option before an unknown one.
TEST(Main, MistypedOptionIsNamedWithTheNearestOne) {
  EXPECT_TRUE(
      test::fails(2, {"fit", "--recoding", "a.csv"}, {"--recoding", "did you mean --recording?", "palpate fit"}));
  EXPECT_TRUE(test::fails(2, {"study", "analyse", "a.csv", "--pagn"}, {"--pagn", "did you mean --pang?"}));
  EXPECT_TRUE(test::fails(2, {"study", "simulat"}, {"verb \"simulat\"; did you mean simulate?", "palpate study"}));
  EXPECT_TRUE(test::fails(2, {"chek", "a.csv"}, {"verb \"chek\"; did you mean check?", "known verbs: "}));
  EXPECT_TRUE(test::fails(2, {"replay", "--modle=m.json"}, {"--modle", "did you mean --model?"}));
}

TEST(Main, WrongUsageSaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("x.csv");
  EXPECT_TRUE(test::fails(2, {"fit", "--recording", "--out", "m.json"}, {"--recording: found no value, expected one"}));
  EXPECT_TRUE(test::fails(2, {"synth", "--material", "foam", "--seconds", "abc", "--out", out},
                          {"found \"abc\", expected a number from 0.1 to 1000000"}));
  EXPECT_TRUE(test::fails(2, {"study", "simulate", "--subjects", "abc", "--out", out},
                          {"expected a number from 1 to 99", "palpate study simulate --help explains"}));
  EXPECT_TRUE(test::fails(2, {"check", out, "--scene", "no_such"}, {"unknown scene \"no_such\"; known scenes: "}));
  EXPECT_TRUE(test::fails(2, {"record", "--device", "no_such", "--out", out}, {"unknown device \"no_such\""}));
  EXPECT_TRUE(test::fails(2, {"replay", "--recording", out, "--model", "m.json", "--plot", "x.bmp"},
                          {"found x.bmp, expected a file that ends in .svg or .png"}));
  EXPECT_TRUE(test::has_parts(test::must_run({"help", "fit"}).out, {"palpate fit", "--recording"}));
}

TEST(Main, EveryVerbHasAnExampleAndTheVersionSaysWhatComputes) {
  for (const char* verb : {"synth", "import", "check", "fit", "replay", "export", "report", "paper", "hard", "record",
                           "scenes", "devices", "study"}) {
    EXPECT_TRUE(test::has_parts(test::must_run({verb, "--help"}).out, {"Example:\n  palpate " + std::string(verb)}));
  }
  for (const std::string verb : {"analyse", "simulate"}) {
    EXPECT_TRUE(test::has_parts(test::must_run({"study", verb, "--help"}).out, {"Example:\n  palpate study " + verb}));
  }
  EXPECT_TRUE(test::has_parts(run_palpate({"--version"}).out, {"palpate ", "commit ", "BLAS", "vectors "}));
}

TEST(Main, HardRefusesAFolderThatExistsBeforeItRuns) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(test::fails(1, {"hard", "--out", folder.path()}, {folder.path() + " exists", "--force"}));
}

TEST(Main, ScenesListsEveryScene) {
  const auto run = test::must_run({"scenes"});
  EXPECT_EQ(run.err, "");
  for (const char* name : {"silicone_block", "button", "foam_block", "elastic_block", "stiff_block", "skin"}) {
    EXPECT_TRUE(test::has_parts(run.out, {name}));
  }
}

TEST(Main, ResultsThatCannotBePrintedAreAFailure) {
  const auto run = run_program({"/bin/sh", "-c", "\"$0\" scenes > /dev/full", PALPATE_BINARY});
  EXPECT_TRUE(test::is_refused(run, 1, {"standard output\n"}));
}

// What palpate devices says about the devices that are plugged in.

TEST(DevicesVerb, SaysWhyADeviceCannotBeOpenedAndHowToFixIt) {
  test::FakeDeviceBus bus;
  bus.refusals = 1;
  const std::string refused = cli::plugged_in_text(bus, "/share");
  EXPECT_TRUE(test::has_parts(
      refused, {"/dev/hidraw7  1209:ffb0  FFBoard: OpenFFBoard", "cannot be used: /dev/hidraw7: no permission\n",
                "sudo cp /share/udev/70-palpate.rules /etc/udev/rules.d/"}));
  const std::string opened = cli::plugged_in_text(bus, "/share");
  EXPECT_EQ(opened.find("cannot be used"), std::string::npos) << opened;
  EXPECT_EQ(opened.find("udev"), std::string::npos) << opened;
}

TEST(DevicesVerb, ListsADeviceWithoutSupportAndNeverOpensIt) {
  test::FakeDeviceBus keyboard(DeviceNode{"/dev/hidraw0", "Keyboard", 1, 2, 1, 6});
  keyboard.refusals = 1;
  EXPECT_EQ(cli::plugged_in_text(keyboard, "/share"),
            "\nPLUGGED IN (hidraw)\n  /dev/hidraw0  0001:0002  Keyboard: not supported\n");
  EXPECT_EQ(keyboard.opened, 0);
}

TEST(DevicesVerb, SaysThatASpaceMouseHasNoForce) {
  test::FakeDeviceBus mouse(test::found_space_mouse());
  EXPECT_TRUE(test::has_parts(cli::plugged_in_text(mouse, "/share"), {"SpaceNavigator: SpaceMouse", "no force"}));
}

TEST(DevicesVerb, SaysThatNothingIsPluggedIn) {
  test::FakeDeviceBus none;
  none.plugged_in = false;
  EXPECT_TRUE(test::has_parts(cli::plugged_in_text(none, "/share"), {"none; ", "plugged in"}));
}

// The program palpate synth.

TEST(Synth, ListsTheMaterialsWithTheirRelaxationTimes) {
  const auto run = test::must_run({"synth", "--list"});
  EXPECT_EQ(run.err, "");
  for (const Material& material : materials())
    EXPECT_TRUE(test::has_parts(run.out, {std::string(material.name), std::string(material.relaxation_times)}));
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

// The program palpate check.

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

// The program palpate study, from the first trial to errors of a scene in terms of the measured JND.

TEST(Study, MeasuresTheJndOfAScene) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("study");
  const std::vector<std::string> simulate = {"study", "simulate", "--subjects", "3", "--seed", "2", "--out", out};
  const auto run = test::must_run(simulate);
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(test::has_parts(run.out, {"conservative "}));
  for (const char* name : {"S01.csv", "S03.csv", "results.csv", "jnd.json"}) {
    EXPECT_TRUE(std::filesystem::exists(out + "/" + name)) << name;
  }
  EXPECT_EQ(read_study(out + "/S02.csv")->records.size(), 328u);
  const auto again = run_palpate(simulate);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_TRUE(test::has_parts(again.err, {"error: ", out, "/S01.csv", "--force"}));

  // The same files give the same result.
  const auto analysed = test::must_run(
      {"study", "analyse", out + "/S01.csv", out + "/S02.csv", out + "/S03.csv", "--out", folder.file("again")});
  EXPECT_EQ(analysed.out, run.out);
  const auto json = test::must_run({"study", "analyse", out + "/S01.csv", out + "/S02.csv", out + "/S03.csv", "--json",
                                    "--force", "--out", folder.file("again")});
  EXPECT_EQ(json.out, test::read_text(out + "/jnd.json"));
  EXPECT_EQ(test::read_text(folder.file("again/jnd.json")), test::read_text(out + "/jnd.json"));

  const auto scene = test::must(load_scene("silicone_block"));
  std::string text = test::read_text(std::string(PALPATE_SOURCE_DIR) + "/assets/scenes/silicone_block.json");
  const std::size_t begin = text.find("\"jnd\""), end = text.find('}', begin);
  text.replace(begin, end + 1 - begin, "\"jnd_file\": \"jnd.json\"");
  const auto judged = test::must(parse_scene(text, out + "/silicone_block.json"));
  EXPECT_EQ(judged.jnd.offset_N, read_jnd_file(out + "/jnd.json")->offset_N);
  EXPECT_NE(judged.jnd.weber_fraction, scene.jnd.weber_fraction);
}

TEST(Study, SimulatedSubjectsDiscriminateStrokes) {
  const test::TemporaryFolder folder;
  const std::string foam = folder.file("foam.csv"), out = folder.file("out");
  ASSERT_EQ(run_palpate({"synth", "--material", "foam", "--seed", "2", "--seconds", "20", "--out", foam}).exit_code, 0);
  const auto run = test::must_run(
      {"study", "simulate", "--discriminate", foam, "--model", "greedy", "--subjects", "2", "--out", out});
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(test::has_parts(
      run.out, {"comparison   greedy-100\nstroke       foam, ", "Predicted above the JND", "one JND: consistent."}))
      << "a model of silicone against foam: " << run.out;
  EXPECT_EQ(test::must(read_study(out + "/S02.csv")).records.size(), 104u);

  const auto again =
      test::must_run({"study", "analyse", out + "/S01.csv", out + "/S02.csv", "--out", folder.file("again")});
  EXPECT_EQ(again.out, run.out);
  EXPECT_EQ(test::read_text(folder.file("again/results.csv")), test::read_text(out + "/results.csv"));
}

TEST(Study, RefusesWrongUsage) {
  EXPECT_EQ(run_palpate({"study"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "simulate"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "recovery"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "analyse", "--out", "x"}).exit_code, 2);
  for (const char* option : {"--offset", "--weber", "--bias", "--lapse", "--seed"}) {
    EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", option, "nan"}).exit_code, 2) << option;
  }
  EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", "--seed", "-1"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", "--model", "greedy"}).exit_code, 2)
      << "needs --discriminate";
  EXPECT_TRUE(test::fails(1, {"study", "analyse", "/none/S01.csv", "--out", "/none/out"}, {"/none/S01.csv"}));
}

}  // namespace
}  // namespace palpate
