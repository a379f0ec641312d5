// The program palpate replay: output, files, errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;
using test::run_palpate;

class ReplayVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    recording_ = folder_.file("rec.csv");
    ASSERT_TRUE(write_recording(recording_, test::example_recording(3000, 1000.0, 30e-6), {}, false).ok());
    for (const ModelData& data : test::example_models()) {
      models_.push_back(folder_.file(data.name + ".json"));
      ASSERT_TRUE(save_model(models_.back(), data, false).ok());
    }
  }

  // `palpate replay` of the recording with `models` and `more` arguments.
  test::ProgramRun run(const std::vector<std::string>& models, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"replay", "--recording", recording_};
    for (const std::string& model : models) arguments.insert(arguments.end(), {"--model", model});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_palpate(arguments);
  }

  // The object that it prints with --json, without a word on stderr.
  Json results(const std::vector<std::string>& models, std::vector<std::string> more = {}) {
    more.emplace_back("--json");
    const test::ProgramRun ran = run(models, more);
    if (ran.exit_code != 0 || !ran.err.empty()) throw std::runtime_error(ran.err);
    return Json::parse(ran.out);
  }

  test::TemporaryFolder folder_;
  std::string recording_;
  std::vector<std::string> models_;
};

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

TEST_F(ReplayVerb, JsonHasTheContractsFields) {
  const Json object = results(models_);
  EXPECT_EQ(keys(object), (std::vector<std::string>{"recording", "samples", "contact_samples", "force_zero_N",
                                                    "surface_offset_m", "models"}));
  EXPECT_EQ(object["recording"], recording_);
  EXPECT_EQ(object["samples"], 3000);
  const std::uint64_t contact = object["contact_samples"];
  ASSERT_EQ(object["models"].size(), models_.size());
  for (const Json& model : object["models"]) {
    EXPECT_EQ(keys(model), (std::vector<std::string>{
                               "name", "method", "centres", "began", "rms_error_N", "max_error_N", "within_jnd",
                               "p99_error_over_jnd", "max_error_over_jnd", "out_of_domain_samples", "evaluation_ns",
                               "tick_ns", "surface_moved", "force_zeroed", "surface_offset_m", "beginning_moved",
                               "surface_identified", "predicted_error", "bins"}));
    EXPECT_TRUE(model["beginning_moved"].is_null()) << "it begins without a preload";
    EXPECT_EQ(keys(model["surface_moved"]), (std::vector<std::string>{"rms_error_N", "max_error_N", "within_jnd",
                                                                      "p99_error_over_jnd", "max_error_over_jnd"}));
    EXPECT_TRUE(model["predicted_error"].is_null()) << "a model without a bound";
    EXPECT_EQ(keys(model["evaluation_ns"]), (std::vector<std::string>{"median", "p99"}));
    EXPECT_GT(model["evaluation_ns"]["median"], 0.0);
    EXPECT_GE(model["evaluation_ns"]["p99"], model["evaluation_ns"]["median"]);
    EXPECT_GT(model["tick_ns"]["median"], 0.0);
    EXPECT_GE(model["max_error_N"], model["rms_error_N"]);
    std::uint64_t counted = 0;
    for (const Json& bin : model["bins"]) {
      EXPECT_EQ(keys(bin), (std::vector<std::string>{"force_from_N", "force_to_N", "count", "mean_abs_error_N",
                                                     "std_abs_error_N", "max_abs_error_N", "jnd_N"}));
      counted += bin["count"].get<std::uint64_t>();
    }
    EXPECT_EQ(counted, contact);
  }
  EXPECT_EQ(object["models"][0]["centres"], 40);
  EXPECT_EQ(object["models"][1]["centres"], 3 * 4 * 5 * 6) << "nodes of the grid";
}

TEST_F(ReplayVerb, FiguresFollowFromTheForcesFile) {
  const std::string out = folder_.file("forces.csv");
  const Json object = results({models_[0], models_[3], models_[5]}, {"--out", out});
  std::istringstream file(test::read_text(out));
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line,
            "time_s,position_m,force_N,depth_m,feature_depth_m,feature_velocity_m_per_s,"
            "feature_lowpass_velocity_0.17s_m_per_s,feature_lowpass_velocity_1.27s_m_per_s,"
            "feature_maxwell_spectrum_0.1s_N,feature_maxwell_spectrum_1.111s_N,"
            "direct-cubic-1_N,kdtree-thin-plate-4_N,greedy-cubic-6_N");
  std::array<double, 3> squares{};
  std::array<double, 3> within{};
  int rows = 0;
  int contact = 0;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = fields(line);
    ASSERT_EQ(cells.size(), 13u);
    ++rows;
    const double depth_m = std::stod(cells[3]);
    EXPECT_EQ(depth_m, std::max(0.0, std::stod(cells[1])));
    if (depth_m <= 0.0) {
      EXPECT_EQ(cells[10] + cells[11] + cells[12], "000");
      continue;
    }
    ++contact;
    const double measured_N = std::stod(cells[2]);
    for (std::size_t m = 0; m < 3; ++m) {
      const double error_N = std::abs(std::stod(cells[10 + m]) - measured_N);
      squares[m] += error_N * error_N;
      within[m] += error_N <= 0.065 + 0.0633 * std::abs(measured_N) ? 1.0 : 0.0;
    }
  }
  EXPECT_EQ(rows, 3000);
  EXPECT_EQ(contact, object["contact_samples"]);
  for (std::size_t m = 0; m < 3; ++m) {
    // The tolerance is for the order of the sums and the last printed digit.
    EXPECT_NEAR(object["models"][m]["rms_error_N"], std::sqrt(squares[m] / contact), 1e-12);
    EXPECT_NEAR(object["models"][m]["within_jnd"], within[m] / contact, 1e-12);
  }
}

// Replays the training recording with positions moved by 0.3 mm.
TEST_F(ReplayVerb, GivesEveryErrorAsRecordedAndWithTheSurfaceMoved) {
  Recording recording = test::example_recording(3000, 1000.0, 30e-6);
  const std::string model = folder_.file("fitted.json");
  ASSERT_EQ(run_palpate({"fit", "--recording", recording_, "--method", "random", "--out", model}).exit_code, 0);
  for (RecordingRow& row : recording.rows) row.position_m += 0.3e-3;
  const std::string shifted = folder_.file("shifted.csv");
  ASSERT_TRUE(write_recording(shifted, recording, {}, false).ok());

  const Json list = results({model}, {"--recording", shifted});
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["surface_offset_m"], 0.0);
  EXPECT_NEAR(list[1]["surface_offset_m"], 0.3e-3, 0.02e-3);
  const Json& plain = list[0]["models"][0];
  const Json& moved = list[1]["models"][0];
  EXPECT_EQ(plain["rms_error_N"], plain["surface_moved"]["rms_error_N"]);
  // 0.3 mm at the recording's stiffness of 300 N/m are 90 mN.
  EXPECT_GT(moved["rms_error_N"], 0.05);
  EXPECT_LT(moved["surface_moved"]["rms_error_N"], 0.1 * moved["rms_error_N"].get<double>());
  EXPECT_GT(moved["surface_moved"]["within_jnd"], 0.99);

  recording_ = shifted;
  const auto table = run({model});
  std::smatch said;
  const std::regex note("note: the surface of this recording is at (\\+0\\.[0-9]+) mm");
  ASSERT_TRUE(std::regex_search(table.out, said, note)) << table.out;
  EXPECT_NEAR(std::stod(said[1]), 0.3, 0.02);
}

TEST_F(ReplayVerb, TheSameCommandGivesTheSameBytesInAnotherProcess) {
  for (const char* name : {"first.csv", "second.csv"}) {
    ASSERT_EQ(run(models_, {"--out", folder_.file(name)}).exit_code, 0);
  }
  EXPECT_EQ(test::read_text(folder_.file("first.csv")), test::read_text(folder_.file("second.csv")));
}

TEST_F(ReplayVerb, ModelsOfOneNameGetDistinctNames) {
  const std::string out = folder_.file("forces.csv");
  const Json object = results({models_[5], models_[5], models_[5]}, {"--out", out});
  EXPECT_EQ(object["models"][0]["name"], "greedy-cubic-6");
  EXPECT_EQ(object["models"][1]["name"], "greedy-cubic-6-2");
  EXPECT_EQ(object["models"][2]["name"], "greedy-cubic-6-3");
  const std::string text = test::read_text(out);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time_s,position_m,force_N,depth_m,feature_depth_m,greedy-cubic-6_N,greedy-cubic-6-2_N,greedy-cubic-6-3_N");
}

TEST_F(ReplayVerb, FailuresAreOneErrorLine) {
  const std::string none = folder_.file("none.json");
  EXPECT_TRUE(test::is_refused(run({none}), 1, {none, "no such file", "palpate fit"}));
  EXPECT_TRUE(test::is_refused(run({recording_}), 1, {recording_, "JSON", "palpate fit", "--recording"}));
  EXPECT_TRUE(test::is_refused(run(std::vector<std::string>(17, models_[0])), 1, {"17 models", "16", "; "}));
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--name", "a,b", "--out", folder_.file("forces.csv")}), 1,
                               {"a,b", "comma", "--name"}));
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--name", "force", "--out", folder_.file("forces.csv")}), 1,
                               {"model name force,", "has already", "--name"}));
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--after", recording_}), 1, {"--after", recording_ + " itself"}));
  EXPECT_EQ(run({models_[0]}, {"--name", "a,b", "--json"}).exit_code, 0) << "no column is named";
  const std::string before = test::read_text(recording_);
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--out", recording_, "--force"}), 1, {recording_, "--out", "; "}));
  EXPECT_EQ(test::read_text(recording_), before);
  Recording air = test::example_recording(100, 1000.0);
  for (RecordingRow& row : air.rows) row.position_m = -1e-3 - 1e-6 * row.time_s;
  recording_ = folder_.file("air.csv");
  ASSERT_TRUE(write_recording(recording_, air, {}, false).ok());
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--json"}), 1, {recording_ + ": no_"}));
  recording_ = folder_.file("none.csv");
  EXPECT_TRUE(test::is_refused(run({models_[0]}), 1, {recording_, "no such file"}));
}

TEST_F(ReplayVerb, WrongUsageIsTwo) {
  EXPECT_EQ(run_palpate({"replay"}).exit_code, 2);
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({models_[0]}, {"--dance"}).exit_code, 2);
}

TEST_F(ReplayVerb, NothingIsLostWithoutForceOrAfterAnError) {
  const std::string out = folder_.with_file("forces.csv", "mine");
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--out", out}), 1, {out, "--force"}));
  EXPECT_EQ(test::read_text(out), "mine");
  const std::string both = folder_.file("both.svg");
  EXPECT_TRUE(test::is_refused(run({models_[0]}, {"--out", both, "--plot", folder_.file("./both.svg")}), 2,
                               {"--plot", "both.svg", "another file"}));

  const std::string whole = test::read_text(recording_);
  const std::string good = recording_;
  recording_ = folder_.with_file("cut.csv", whole.substr(0, whole.size() / 2) + ",x\n");
  const auto before = folder_.entries();
  EXPECT_EQ(run({models_[0]}, {"--out", out, "--force"}).exit_code, 1);
  EXPECT_EQ(test::read_text(out), "mine");
  EXPECT_EQ(folder_.entries(), before);

  recording_ = good;
  EXPECT_EQ(run({models_[0]}, {"--out", out, "--force"}).exit_code, 0);
  EXPECT_NE(test::read_text(out), "mine");
}

}  // namespace
}  // namespace palpate
