#include "scenes/study/study_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/full_disk.h"
#include "tests/support/live_doubles.h"
#include "tests/support/message_parts.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(StudyPlan, AcceptsCodesAndNoNames) {
  for (const char* code : {"S1", "S01", "AB12", "XYZ9999"}) EXPECT_TRUE(check_subject_code(code).ok()) << code;
  for (const char* name : {"", "Anna", "S", "01", "s01", "S01 ", "ABCD1", "S12345", "S0A", "../S01", "Müller1"}) {
    EXPECT_TRUE(test::has_parts(check_subject_code(name), {std::string("\"") + name + "\"", "such as S01"}));
  }
}

// The trials of the plan after the training trials.
std::vector<StudyTrial> study_trials(const std::string& code, const StrokePair* strokes = nullptr) {
  std::vector<StudyTrial> trials = plan_study(code, strokes);
  std::erase_if(trials, [](const StudyTrial& trial) { return trial.training; });
  return trials;
}

TEST(StudyPlan, PresentsEachPairTenTimesBalancedForOrder) {
  for (const char* code : {"S01", "S02", "AB7"}) {
    const std::vector<StudyTrial> trials = study_trials(code);
    ASSERT_EQ(trials.size(), 320u);
    std::map<std::pair<double, double>, std::pair<int, int>> count;
    for (const StudyTrial& trial : trials) {
      auto& [all, first] = count[{trial.reference_N, trial.comparison_N}];
      ++all;
      first += trial.comparison_first ? 1 : 0;
    }
    ASSERT_EQ(count.size(), 32u);
    for (const auto& [pair, times] : count) {
      EXPECT_EQ(times, (std::pair<int, int>{10, 5})) << pair.first << " " << pair.second;
      EXPECT_GE(pair.second, 0.6 * pair.first - 1e-9);
      EXPECT_LE(pair.second, 1.4 * pair.first + 1e-9);
    }
    // Each pair occurs once in every 32 trials.
    for (std::size_t from = 0; from < 320; from += 32) {
      std::map<std::pair<double, double>, int> round;
      for (std::size_t i = from; i < from + 32; ++i) ++round[{trials[i].reference_N, trials[i].comparison_N}];
      EXPECT_EQ(round.size(), 32u);
    }
  }
}

using test::has_parts;
using test::read_text;

const StudyHeader kHeader{"S01"};
constexpr const char* kRow = "training,1,0.3,0.18,1,0.18,0.2999,0,second,731,unknown,true\n";

// An answer to a trial of the plan of S01.
StudyRecord answer_to(std::size_t trial) {
  StudyRecord record{plan_study("S01", nullptr)[trial]};
  record.first_rendered_N = 0.18;
  record.second_rendered_N = 0.2999;
  record.answered_second = true;
  record.response_ms = 731;
  return record;
}

class StudyFileTest : public ::testing::Test {
 protected:
  StudyFile opened() { return test::must(StudyFile::open(path_, kHeader)); }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.file("S01.csv");
};

TEST_F(StudyFileTest, WritesNothingBeforeTheConsentThenRowByRow) {
  StudyFile file = opened();
  EXPECT_FALSE(file.append(answer_to(0)).ok());
  EXPECT_TRUE(folder_.entries().empty());
  ASSERT_TRUE(file.consent("2024-05-06 10:20").ok());
  ASSERT_TRUE(file.append(answer_to(0)).ok());
  EXPECT_EQ(read_text(path_),
            "# palpate-study 1\n# subject S01\n# procedure constant\n"
            "# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n# consent accepted, 2024-05-06 10:20\n"
            "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,"
            "answer,response_ms,device,rendered\n" +
                std::string(kRow));
}

TEST_F(StudyFileTest, IsResumedAfterTheLastCompleteRow) {
  {
    StudyFile file = opened();
    ASSERT_TRUE(file.consent("").ok() && file.append(answer_to(0)).ok());
  }
  const std::string whole = read_text(path_);
  folder_.with_file("S01.csv", whole + "training,2,0.5,0.3");
  StudyFile file = opened();
  EXPECT_TRUE(file.consented());
  EXPECT_EQ(file.records(), std::vector<StudyRecord>{answer_to(0)});
  ASSERT_TRUE(file.append(answer_to(1)).ok());
  EXPECT_EQ(read_text(path_), whole + study_row(answer_to(1), false));
}

TEST_F(StudyFileTest, ChangesOfAnotherSessionAreKept) {
  StudyFile first = opened(), second = opened();  // both have no consent yet
  ASSERT_TRUE(first.consent("").ok());
  EXPECT_TRUE(has_parts(second.consent(""), {path_, "another session", "start again"}));
  StudyFile third = opened();
  ASSERT_TRUE(third.append(answer_to(0)).ok());
  const std::string text = read_text(path_);
  EXPECT_TRUE(has_parts(first.append(answer_to(0)), {path_, "another session", "start again"}));
  EXPECT_EQ(read_text(path_), text);
}

TEST_F(StudyFileTest, OtherStudiesAndOtherFilesAreRefusedAndKept) {
  ASSERT_TRUE(opened().consent("").ok());
  EXPECT_TRUE(has_parts(StudyFile::open(folder_.with_file("S02.csv", read_text(path_)), {"S02"}),
                        {"S02.csv", "S01", "S02", "another folder"}));
  EXPECT_TRUE(
      has_parts(StudyFile::open(path_, test::discrimination_header(0.8)), {path_, "same forces", "another folder"}));
  const std::string strokes = folder_.with_file("S03.csv", study_header_text(test::discrimination_header(0.8), ""));
  EXPECT_TRUE(has_parts(StudyFile::open(strokes, test::discrimination_header(0.9)), {strokes, "same forces"}));
  EXPECT_TRUE(has_parts(StudyFile::open(path_, {"Anna"}), {"Anna", "such as S01"}));
  const std::string notes = folder_.with_file("notes.csv", "time_s,position_m\n");
  EXPECT_TRUE(has_parts(StudyFile::open(notes, kHeader), {notes + ":1:1:", "time_s,position_m", "# palpate-study 1"}));
  EXPECT_EQ(read_text(notes), "time_s,position_m\n");
}

TEST_F(StudyFileTest, AFullDiskLosesNothingThatWasAnswered) {
  StudyFile file = opened();
  ASSERT_TRUE(file.consent("").ok() && file.append(answer_to(0)).ok());
  const std::string text = read_text(path_);
  {
    const test::FullDisk full(text.size() + 20);  // room for half a row
    EXPECT_TRUE(has_parts(file.append(answer_to(1)), {path_, "File too large"}));
  }
  EXPECT_EQ(read_text(path_), text);
  EXPECT_EQ(file.records().size(), 1u);
  EXPECT_TRUE(file.append(answer_to(1)).ok());
  EXPECT_EQ(read_study(path_)->records.size(), 2u);
}

const std::string kGood = study_header_text(kHeader, "2024-05-06") +
                          "training,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true\n"
                          "training,2,2.5,3.5,0,2.4,3.5,1,first,20,mouse,false\n";
const std::string kGoodStrokes = study_header_text(test::discrimination_header(0.8), "2024-05-06") +
                                 "training,1,1.5495,0.7748,1,0.7,1.5,0,first,20,1.7,0.001,paddle,true\n";

std::string complaint_of(const std::string& text) { return test::message_of(parse_study(text, "S01.csv")); }

TEST(StudyReader, ReadsEveryField) {
  const auto data = test::must(parse_study(kGood, "S01.csv"));
  EXPECT_EQ(data.header.subject, "S01");
  EXPECT_EQ(data.header.strokes, nullptr);
  ASSERT_EQ(data.records.size(), 2u);
  EXPECT_TRUE(data.records[0].trial.training);
  EXPECT_TRUE(data.records[0].rendered);
  const StudyRecord& record = data.records[1];
  EXPECT_EQ(record.trial, (StudyTrial{2.5, 3.5, false, true, 2}));
  EXPECT_EQ(record.first_rendered_N, 2.4);
  EXPECT_TRUE(record.limited);
  EXPECT_FALSE(record.rendered);
  EXPECT_EQ(record.device, "mouse");
  EXPECT_FALSE(record.comparison_judged_larger());
  EXPECT_FALSE(record.found_larger());
  EXPECT_DOUBLE_EQ(record.rendered_difference(), 1.1 / 2.4);
  EXPECT_EQ(kGood.find(study_row(record, false)), kGood.rfind("training,2"));
  const auto strokes = test::must(parse_study(kGoodStrokes, "S01.csv"));
  EXPECT_EQ(strokes.records.front().worst_N, 0.001);
  EXPECT_EQ(strokes.header.strokes->recording, "silicone 2");
  EXPECT_EQ(kGoodStrokes.find(study_row(strokes.records.front(), true)), kGoodStrokes.rfind("training,1"));
}

// Every message has the place, the text found there and what was expected.
TEST(StudyReader, RefusesWithPlaceFoundAndExpected) {
  struct Case {
    const char *from, *to, *place, *found, *expected;
  };
  const auto check = [](const std::string& good, const std::vector<Case>& cases) {
    for (const auto& [from, to, place, found, expected] : cases) {
      const std::string message = complaint_of(test::replaced(good, from, to));
      EXPECT_EQ(message.rfind(std::string("S01.csv:") + place + ": ", 0), 0u) << message;
      EXPECT_TRUE(has_parts(message, {std::string("\"") + found, expected}));
    }
  };
  check(kGood, {{"study 1", "study 2", "1:1", "# palpate-study 2", "# palpate-study 1"},
                {"constant", "other", "3:1", "# procedure other", "# procedure constant"},
                {"ramp 100", "ramp 60", "4:1", "# timing_ms", "ramp 100"},
                {"accepted", "refused", "5:1", "# consent refused", "# consent accepted"},
                {",response_ms", "", "6:104", "device", "response_ms"},
                {"training,1", "practice,1", "7:1", "practice", "training"},
                {"training,2", "study,1", "8:1", "study", "training"},
                {"3.5,0", "3.4,0", "8:16", "3.4", "3.5"},
                {",2.4,", ",-2.4,", "8:22", "-2.4", "0"},
                {",2.4,", ",nan,", "8:22", "nan", "0"},
                {",2.4,", ",11,", "8:22", "11", "0"},
                {"first,20", "both,20", "8:32", "both", "first"},
                {"first,20", "first,-1", "8:38", "-1", "0"},
                {",first,20", ",first", "8:38", "mouse", "0"},
                {"20,mouse", "20,", "8:41", "", "unknown"},
                {"mouse,false", "mouse,no", "8:47", "no", "false"},
                {"first,20", "first,20,1", "8:43", "mouse", "false"}});
  check(kGoodStrokes,
        {{"# procedure discriminate", "# procedure constant", "3:1", "# procedure constant", "discriminate"},
         {"# strokes ", "# ", "3:1", "# procedure discriminate", "constant"},
         {",1.7,0.001,paddle,true", "", "8:44", "20", "20,0"},
         {",0.001,", ",-1,", "8:51", "-1", "0"}});
  for (const char* broken : {"{", "\"checksum\"", "\"offset_N\"", "\"silicone 2\"", "12.3,"})
    EXPECT_TRUE(has_parts(complaint_of(test::replaced(kGoodStrokes, broken, "?")), {"S01.csv:5:1: ", "JSON"}));
  EXPECT_TRUE(has_parts(complaint_of(test::replaced(kGood, "S01", "Anna")), {"S01.csv:2:1: ", "Anna", "such as S01"}));
  EXPECT_TRUE(has_parts(read_study("/none/S01.csv"), {"/none/S01.csv", "no such file"}));
}

TEST(StudyFiles, AreOfDifferentSubjectsAndTheSameForces) {
  const auto checked = [](const StudyHeader& one, const StudyHeader& other) {
    return test::message_of(check_study_files({{one, {}}, {other, {}}}));
  };
  const StudyHeader strokes = test::discrimination_header(0.9);
  EXPECT_EQ(checked({"S01"}, {"S02"}), "accepted");
  EXPECT_EQ(checked(strokes, {"S02", strokes.strokes}), "accepted");
  EXPECT_TRUE(has_parts(checked(strokes, strokes), {"two files of subject S01", "leave"}));
  EXPECT_TRUE(has_parts(checked(strokes, {"S02"}), {"S02", "S01", "separate commands"}));
  EXPECT_TRUE(has_parts(checked(strokes, {"S02", test::example_strokes(0.8)}), {"S02", "S01", "separate commands"}));
}

TEST(StudyReader, ReadsOrRefusesEveryTruncation) {
  for (const std::string& good : {kGood, kGoodStrokes}) {
    for (std::size_t length = 0; length < good.size(); ++length) {
      const std::string message = complaint_of(good.substr(0, length));
      EXPECT_TRUE(message == "accepted" || has_parts(message, {"S01.csv:", "found", "expected"})) << length;
    }
  }
}

using test::spring;

// Presses of `depths_m`, 1.2 s each with pauses of 1.2 s, into a spring of 100 N/m. In the last
// press the measured force is too high by `offset_N`.
Recording presses(const std::vector<double>& depths_m, double offset_N, double rate_Hz = 1000.0) {
  Recording recording;
  recording.name = "spring";
  const double pi = std::acos(-1.0);
  for (std::size_t i = 0; static_cast<double>(i) / rate_Hz < 2.4 * static_cast<double>(depths_m.size()); ++i) {
    RecordingRow row;
    row.time_s = static_cast<double>(i) / rate_Hz;
    const auto press = std::min(static_cast<std::size_t>(row.time_s / 2.4), depths_m.size() - 1);
    const double phase = (row.time_s - 2.4 * static_cast<double>(press)) / 1.2;
    row.position_m = phase < 1.0 ? depths_m[press] * std::pow(std::sin(pi * phase), 2) : -0.001;
    if (row.position_m > 0.0) row.force_N = 100.0 * row.position_m + (press + 1 == depths_m.size() ? offset_N : 0.0);
    recording.rows.push_back(row);
  }
  return recording;
}

TEST(PrepareStrokes, TakesTheStrokeThatDiffersMost) {
  const JndLine jnd{0.1, 0.0};
  const StrokePair pair = *test::must(strokes_of(presses({0.02, 0.01, 0.01}, 0.05), nullptr, spring(100.0), jnd));
  EXPECT_EQ(pair.reference, "recorded force");
  EXPECT_EQ(pair.comparison, "spring");
  EXPECT_EQ(pair.recording, "spring");
  EXPECT_GT(pair.from_s, 4.8 - 1.1) << "of the third press";
  EXPECT_LT(pair.from_s, 6.0);
  EXPECT_NEAR(pair.max_over_jnd, 0.5, 0.01);
  EXPECT_GT(pair.mean_over_jnd, 0.3);
  ASSERT_EQ(pair.reference_N.size(), kInterval_ticks);
  EXPECT_NEAR(*std::max_element(pair.comparison_N.begin(), pair.comparison_N.end()), 1.0, 0.01);
  EXPECT_NEAR(pair.reference_mean_N - pair.comparison_mean_N, 0.05, 0.005);
}

TEST(PrepareStrokes, TwoModelsDifferByTheirStiffness) {
  const JndLine jnd{0.1, 0.0};
  const auto strokes = test::must(strokes_of(presses({0.01}, 7.0), spring(100.0), spring(80.0), jnd));
  EXPECT_EQ(strokes->reference, "spring");
  EXPECT_NEAR(strokes->max_over_jnd, 2.0, 0.02) << "0.2 N at 1 N; what was recorded does not count";
  const auto same = strokes_of(presses({0.01}, 7.0), spring(100.0), spring(100.0), jnd);
  EXPECT_EQ((*same)->max_over_jnd, 0.0);
  EXPECT_EQ((*same)->reference_N, (*same)->comparison_N);
  EXPECT_NE((*same)->checksum, strokes->checksum);
}

}  // namespace
}  // namespace palpate
