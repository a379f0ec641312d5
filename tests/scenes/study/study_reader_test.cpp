// What the reader of study files refuses, and how.
#include <gtest/gtest.h>

#include "scenes/study/study_file.h"
#include "tests/support/replaced.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

const std::string kGood =
    "# palpate-study 1\n# subject S01\n# procedure constant\n# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n"
    "# consent accepted, text 811c9dc5\n" +
    study_columns({}) +
    "\ntraining,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true\n"
    "study,1,2.5,3.5,0,2.4,3.5,1,first,20,paddle,true\n";

std::string complaint_after(const std::string& from, const std::string& to) {
  const auto data = parse_study(test::replaced(kGood, from, to), "S01.csv");
  return data.ok() ? "accepted" : data.error().message;
}

TEST(StudyReader, ReadsEveryField) {
  const auto data = parse_study(kGood, "S01.csv");
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->header.subject, "S01");
  EXPECT_EQ(data->header.strokes, nullptr);
  EXPECT_EQ(data->consent, "text 811c9dc5");
  ASSERT_EQ(data->records.size(), 2u);
  EXPECT_TRUE(data->records[0].training);
  const StudyRecord& record = data->records[1];
  EXPECT_EQ(record.trial, (StudyTrial{2.5, 3.5, false}));
  EXPECT_EQ(record.first_rendered_N, 2.4);
  EXPECT_TRUE(record.limited);
  EXPECT_FALSE(record.comparison_judged_larger());
  EXPECT_FALSE(record.found_larger());
  EXPECT_DOUBLE_EQ(record.rendered_difference(), 1.1 / 2.4);
  EXPECT_EQ(study_row(record, data->header), "study,1,2.5,3.5,0,2.4,3.5,1,first,20,paddle,true\n");
}

TEST(StudyReader, IgnoresALastRowWithoutItsEnd) {
  const auto data = parse_study(kGood + "study,2,2.", "S01.csv");
  ASSERT_TRUE(data.ok());
  EXPECT_EQ(data->records.size(), 2u);
  EXPECT_EQ(data->whole_bytes, kGood.size());
}

TEST(StudyReader, RefusesWithPlaceFoundAndExpected) {
  EXPECT_EQ(complaint_after("study 1", "study 2"),
            "S01.csv:1:1: found \"# palpate-study 2\", expected the first line of a study file, \"# palpate-study 1\"");
  EXPECT_EQ(complaint_after("S01", "Anna"),
            "S01.csv:2:1: found \"# subject Anna\", expected \"# subject \" and a code such as S01");
  EXPECT_EQ(complaint_after("constant", "other"),
            "S01.csv:3:1: found \"# procedure other\", expected \"# procedure \" and constant or discriminate");
  EXPECT_EQ(complaint_after("ramp 100", "ramp 60"),
            "S01.csv:4:1: found \"# timing_ms lead_in 400 ramp 60 hold 900 pause 500\", expected \"# timing_ms lead_in "
            "400 ramp 100 hold 900 pause 500\"");
  EXPECT_EQ(
      complaint_after("accepted", "refused"),
      "S01.csv:5:1: found \"# consent refused, text 811c9dc5\", expected \"# consent accepted, \" and which text");
  EXPECT_EQ(complaint_after(",response_ms", ""),
            "S01.csv:6:1: found \"part,trial,reference_N,comparison_N,comparison_first,firs...\", expected the "
            "columns " +
                study_columns({}));
  EXPECT_EQ(complaint_after("training,1", "practice,1"), "S01.csv:7:1: found \"practice\", expected training or study");
  EXPECT_EQ(complaint_after("study,1,", "study,0,"), "S01.csv:8:7: found \"0\", expected a whole number above 0");
  EXPECT_EQ(complaint_after("3.5,0", "nan,0"), "S01.csv:8:13: found \"nan\", expected a force above 0 and up to 10 N");
  EXPECT_EQ(complaint_after(",2.4,", ",-2.4,"), "S01.csv:8:19: found \"-2.4\", expected a force from 0 to 10 N");
  EXPECT_EQ(complaint_after("first,20", "both,20"), "S01.csv:8:29: found \"both\", expected first or second");
  EXPECT_EQ(complaint_after("first,20", "first,-1"), "S01.csv:8:35: found \"-1\", expected a whole number of ms");
  EXPECT_EQ(complaint_after(",first,20", ",first"),
            "S01.csv:8:1: found \"study,1,2.5,3.5,0,2.4,3.5,1,first,paddle,true\", expected a row of twelve fields");
  EXPECT_EQ(
      complaint_after("first,20", "first,20,1"),
      "S01.csv:8:1: found \"study,1,2.5,3.5,0,2.4,3.5,1,first,20,1,paddle,true\", expected a row of twelve fields");
  EXPECT_EQ(read_study("/none/S01.csv").error().message.rfind("/none/S01.csv: found no such file", 0), 0u);
}

TEST(StudyReader, EveryTruncationIsReadOrRefused) {
  for (std::size_t length = 0; length < kGood.size(); ++length) {
    const auto data = parse_study(std::string_view(kGood).substr(0, length), "S01.csv");
    EXPECT_TRUE(!data.ok() || data->whole_bytes <= length) << length;
  }
}

TEST(StudyReader, RefusesWhatIsNotAPairOfStrokes) {
  const StudyHeader header = test::discrimination_header(0.8);
  const std::string good = study_header_text(header) + "# consent accepted, text 1\n" + study_columns(header) +
                           "\nstudy,1,1.7,1.36,0,1.7,1.36,0,first,20,1.7,0.001,paddle,true\n";
  const auto data = parse_study(good, "S01.csv");
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->records.front().worst_N, 0.001);
  EXPECT_EQ(study_row(data->records.front(), header), "study,1,1.7,1.36,0,1.7,1.36,0,first,20,1.7,0.001,paddle,true\n");
  EXPECT_EQ(data->header.strokes->recording, "silicone 2");
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    const auto changed = parse_study(text, "S01.csv");
    return changed.ok() ? "accepted" : changed.error().message;
  };
  EXPECT_EQ(complaint("# strokes ", "# "),
            "S01.csv:5:1: found \"# {\"checksum\":800,\"comparison\":\"greedy-100\",\"comparison_m...\", expected \"# "
            "strokes \" and which, as JSON");
  for (const char* broken : {"{", "\"checksum\"", "\"offset_N\"", "\"silicone 2\"", "12.3,"}) {
    EXPECT_NE(complaint(broken, "?"), "accepted") << broken;
  }
  EXPECT_EQ(complaint(",1.7,0.001,paddle,true", ""),
            "S01.csv:8:1: found \"study,1,1.7,1.36,0,1.7,1.36,0,first,20\", expected a row of fourteen fields");
  EXPECT_EQ(complaint(",0.001,", ",-1,"), "S01.csv:8:44: found \"-1\", expected a force from 0 to 10 N");
  for (std::size_t length = 0; length < good.size(); ++length) {
    const auto cut = parse_study(std::string_view(good).substr(0, length), "S01.csv");
    EXPECT_TRUE(!cut.ok() || cut->whole_bytes <= length) << length;
  }
}

TEST(StudyReader, RowsSayOnWhatTheyWereGiven) {
  const std::string text =
      "# palpate-study 1\n# subject S01\n# procedure constant\n"
      "# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n# consent accepted, text 8c1f2a9d\n" +
      study_columns({}) +
      "\nstudy,1,2.5,3.5,0,2.4,3.5,0,first,20,paddle,true\n"
      "study,2,2.5,3.5,0,2.4,3.5,0,first,20,mouse,false\n";
  const auto data = parse_study(text, "s.csv");
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->records[0].device, "paddle");
  EXPECT_FALSE(data->records[1].rendered);
}

}  // namespace
}  // namespace palpate
