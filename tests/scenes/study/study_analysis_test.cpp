#include "scenes/study/study_analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/scene/jnd_file.h"
#include "scenes/study/psychometrics.h"
#include "scenes/study/simulated_subject.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

// A session whose answers have exactly the expected frequencies, with `repetitions` of
// each pair in each order.
StudyData average_subject(const std::string& code, const std::vector<double>& relative_jnds, int repetitions) {
  StudyData data{{code}, {}};
  for (std::size_t r = 0; r < kReferenceForces_N.size(); ++r) {
    const PsychometricFunction truth{normal_quantile(kJndCriterion) / relative_jnds[r], 0.1, 0.0};
    for (const int percent : kComparisonPercent) {
      for (const bool first : {false, true}) {
        StudyRecord record;
        record.trial = {kReferenceForces_N[r], percent_of(kReferenceForces_N[r], percent), first};
        record.first_rendered_N = record.trial.first_N();
        record.second_rendered_N = record.trial.second_N();
        const double larger = std::round(repetitions * truth.at(record.rendered_difference(), first));
        for (int i = 0; i < repetitions; ++i) {
          record.number = data.records.size() + 1;
          record.answered_second = (i < larger) != first;
          data.records.push_back(record);
        }
      }
    }
  }
  return data;
}

// Section 4.1: 13.3 % at 2.5 N. The line through their points and that of Pang, Tan &
// Durlach (9 % at 2.5 N) has the slope 6.33 %; moved below all points it starts at
// 0.065 N. Their other points are not published; these give the same result: with
// F - mean F = -1.06, -0.86, -0.36, 1.14, 1.14 N (sum of squares 4.592) the JNDs 0.14,
// 0.1748, 0.1283, 0.3325 and 0.225 N give 0.0633, and the point at 1.0 N is the lowest.
TEST(StudyAnalysis, ReproducesThePapersOutcome) {
  const std::vector<double> relative = {0.14 / 0.3, 0.17477 / 0.5, 0.1283, 0.133};
  const auto analysis = analyse_study({average_subject("S01", relative, 1000)}, true);
  ASSERT_TRUE(analysis.ok()) << analysis.error().message;
  ASSERT_EQ(analysis->points.size(), 5u);
  EXPECT_NEAR(analysis->points[3].jnd_N / 2.5, 0.133, 5e-4);
  ASSERT_TRUE(analysis->lines.ok()) << analysis->lines.error().message;
  EXPECT_NEAR(analysis->lines->conservative.offset_N, 0.065, 5e-4);
  EXPECT_NEAR(analysis->lines->conservative.weber_fraction, 0.0633, 5e-4);
  const std::string text = jnd_file_text(*analysis);
  const auto line = parse_jnd_file(text, "jnd.json");
  ASSERT_TRUE(line.ok()) << line.error().message;
  EXPECT_EQ(line->offset_N, analysis->lines->conservative.offset_N);
  EXPECT_EQ(line->weber_fraction, analysis->lines->conservative.weber_fraction);
  EXPECT_EQ(text.find("\"standard_error_N\""), std::string::npos) << "one subject has none";
  // Without the point of Pang, Tan & Durlach the line differs.
  const auto own = analyse_study({average_subject("S01", relative, 1000)}, false);
  EXPECT_GT(own->lines->fitted.weber_fraction, 0.08);
}

TEST(StudyAnalysis, AveragesOverTheSubjects) {
  const StudyData one = average_subject("S01", {0.2, 0.2, 0.2, 0.2}, 200);
  const StudyData two = average_subject("S02", {0.1, 0.1, 0.1, 0.1}, 200);
  const auto analysis = analyse_study({one, two}, false);
  ASSERT_TRUE(analysis.ok());
  ASSERT_EQ(analysis->means.size(), 4u);
  for (const ReferenceJnd& mean : analysis->means) {
    EXPECT_EQ(mean.count, 2u);
    EXPECT_NEAR(mean.jnd_N, 0.15 * mean.reference_N, 2e-3 * mean.reference_N);
    EXPECT_NEAR(mean.standard_error_N, 0.05 * mean.reference_N, 2e-3 * mean.reference_N);
  }
  const std::string table = analysis_table(*analysis);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 8 + 4);
  EXPECT_EQ(table.substr(table.find('\n') + 1, 17), "S01,0.3,0.3,3200,");
}

TEST(StudyAnalysis, JudgesByWhatWasRendered) {
  StudyData data = average_subject("S01", {0.3, 0.2, 0.15, 0.13}, 100);
  for (StudyRecord& record : data.records) {
    record.first_rendered_N *= 0.98;
    record.second_rendered_N *= 0.98;
  }
  data.records[0].second_rendered_N *= 0.7;  // the device was off for part of the time
  data.records[1].trial.training = true;
  data.records[2].rendered = false;  // a rehearsal
  const auto analysis = analyse_study({data}, false);
  ASSERT_TRUE(analysis.ok()) << analysis.error().message;
  const SubjectJnd& subject = analysis->subjects.front();
  EXPECT_EQ(subject.unusable, 2u);
  EXPECT_EQ(subject.references[0].count, 1597u);
  EXPECT_NEAR(subject.references[3].rendered_N, 2.45, 1e-9);
  EXPECT_NEAR(subject.references[3].jnd_N, 0.13 * 2.45, 6e-3) << "counts are rounded";
}

TEST(StudyAnalysis, RefusesWhatCannotBeAnalysed) {
  const StudyData data = average_subject("S01", {0.3, 0.2, 0.15, 0.13}, 1);
  const auto complaint = [](const std::vector<StudyData>& files) {
    return analyse_study(files, false).error().message;
  };
  EXPECT_NE(complaint({}).find("found no study file"), std::string::npos);
  EXPECT_NE(complaint({data, data}).find("two files of subject S01"), std::string::npos);
  EXPECT_NE(complaint({{{"S02"}, {}}}).find("no usable answer of subject S02"), std::string::npos);
  StudyData other = data;
  other.records[3].trial.reference_N = 0.7;
  EXPECT_NE(complaint({other}).find("0.7 N in the file of subject S01"), std::string::npos) << complaint({other});
  EXPECT_NE(complaint({data, {{"S02", test::example_strokes(0.9)}, {}}}).find("S02, strokes of"), std::string::npos);
}

TEST(StudyAnalysis, FindsTheJndsOfKnownSubjects) {
  std::array<std::vector<double>, kReferenceForces_N.size()> ratios;
  RandomStream random(1, 41);
  for (int i = 0; i < 24; ++i) {
    const SubjectTraits traits{{random.uniform(0.03, 0.065), random.uniform(0.05, 0.12)},
                               random.uniform(-0.5, 0.5),
                               random.uniform(0.0, 0.03)};
    const StudyHeader header{"R" + std::to_string(i)};
    const StudyData data{header, simulated_answers(header, traits, random.next())};
    const SubjectJnd found = analyse_study({data}, false)->subjects.front();
    for (std::size_t r = 0; r < kReferenceForces_N.size(); ++r)
      ratios[r].push_back(found.references[r].jnd_N / traits.jnd.at(kReferenceForces_N[r]));
  }
  for (std::size_t r = 0; r < kReferenceForces_N.size(); ++r) {
    std::nth_element(ratios[r].begin(), ratios[r].begin() + 12, ratios[r].end());
    EXPECT_NEAR(ratios[r][12], 1.0, 0.2) << kReferenceForces_N[r];
  }
}

TEST(StudyAnalysis, TakesFilesThatEndEarly) {
  const StudyHeader header{"S01"};
  const std::vector<StudyRecord> records = simulated_answers(header, {}, 1);
  for (const std::size_t kept : {9u, 12u, 60u}) {
    const StudyData cut{header, {records.begin(), records.begin() + static_cast<std::ptrdiff_t>(kept)}};
    const auto analysis = analyse_study({cut}, false);
    ASSERT_TRUE(analysis.ok()) << analysis.error().message;
    EXPECT_GE(analysis->means.size(), 1u);
  }
}

TEST(JndLineFit, FitsByLeastSquaresAndShiftsBelowAllPoints) {
  const auto lines = fit_jnd_lines({{0.0, 0.1, 0.0, "study"}, {1.0, 0.3, 0.0, "study"}, {2.0, 0.2, 0.0, "study"}});
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  EXPECT_NEAR(lines->fitted.weber_fraction, 0.05, 1e-12);
  EXPECT_NEAR(lines->fitted.offset_N, 0.15, 1e-12);
  EXPECT_NEAR(lines->conservative.weber_fraction, 0.05, 1e-12);
  EXPECT_NEAR(lines->conservative.offset_N, 0.1, 1e-12);
}

TEST(JndLineFit, RefusesLinesThatNothingCanBeJudgedBy) {
  EXPECT_FALSE(fit_jnd_lines({}).ok());
  EXPECT_FALSE(fit_jnd_lines({{1.0, 0.1, 0.0, "study"}, {1.0, 0.2, 0.0, "study"}}).ok());
  const auto falling = fit_jnd_lines({{1.0, 0.3, 0.0, "study"}, {2.0, 0.2, 0.0, "study"}});
  EXPECT_NE(falling.error().message.find("0.4000 N + -10.00 %"), std::string::npos) << falling.error().message;
  const auto negative = fit_jnd_lines({{1.0, 0.1, 0.0, "study"}, {2.0, 0.3, 0.0, "study"}});
  EXPECT_NE(negative.error().message.find("-0.1000 N + 20.00 %"), std::string::npos) << negative.error().message;
}

}  // namespace
}  // namespace palpate
