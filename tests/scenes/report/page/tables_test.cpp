// Tables and findings from known numbers.
#include "scenes/report/page/tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/report/data/plan.h"

namespace palpate {
namespace {

Evidence errors(double rms_N, double within, double worst) {
  Evidence summary;
  summary.samples = 2000;
  summary.rms_error_N = rms_N;
  summary.max_error_N = 10.0 * rms_N;
  summary.within_jnd = within;
  summary.p99_error_over_jnd = 0.5;
  summary.max_error_over_jnd = worst;
  summary.out_of_domain_samples = 20;
  summary.p99_interval = {0.4, 0.6};
  summary.strokes = 20;
  return summary;
}

ReportData example() {
  ReportData data;
  data.test_names = {"test"};
  const ReportPlan plan = make_plan(true, 4);
  for (std::size_t i = 0; i < plan.models.size(); ++i) {
    ModelResult model;
    model.plan = plan.models[i];
    model.size = model.plan.request.method == &kDirectMethod ? 6830 : std::max(10, model.plan.request.centres);
    // Only kdtree-30 and what is larger is good; direct is best and slow.
    const bool good =
        model.size >= 30 && model.plan.request.method == &kKdTreeMethod && model.plan.rung == Rung::palpate;
    const bool trend = model.plan.request.method == &kTrendMethod;  // the first
    model.pooled = errors(trend ? 0.1 : 0.01 + 0.001 * static_cast<double>(i - 1), good ? 0.9995 : 0.99, 2.0);
    model.per_recording = {model.pooled};
    model.time = {model.plan.request.method == &kDirectMethod ? 5000.0 : 200.0, 300.0, true};
    model.fit_seconds = 1.5;
    model.health.push_back({0, {}, 100, 50, 0.9});
    data.models.push_back(std::move(model));
  }
  data.coverage.reference = "greedy-100";
  data.recommendation = recommend(data.models, 4);
  data.coverage.errors.push_back({"greedy-100", errors(0.01, 1.0, 0.5), errors(0.1, 0.5, 3.0)});
  PlannedModel random;
  random.name = "random-100";
  random.request.method = &kRandomMethod;
  data.seeds = {{random, 1, errors(0.010, 1.0, 1.0)}, {random, 2, errors(0.012, 1.0, 1.0)}};
  return data;
}

TEST(Tables, MainTableHoldsTheFigures) {
  const auto tables = make_tables(example());
  const auto main = std::find_if(tables.begin(), tables.end(), [](const Table& t) { return t.name == "speed_error"; });
  ASSERT_NE(main, tables.end());
  const std::string csv = table_csv(*main);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "model,recipe,method,centres,contact_samples,within_jnd,within_jnd_low,within_jnd_high,p99_error_over_jnd,"
            "p99_error_over_jnd_low,p99_error_over_jnd_high,rms_error_N,rms_error_N_low,rms_error_N_high,"
            "max_error_over_jnd,max_error_over_jnd_low,max_error_over_jnd_high,max_error_N,max_error_N_low,"
            "max_error_N_high,out_of_domain_share,surface_moved_within_jnd,surface_moved_p99_error_over_jnd,"
            "surface_moved_rms_error_N,surface_moved_max_error_over_jnd,surface_moved_max_error_N,left_out_within_jnd,"
            "left_out_p99_error_over_jnd,strokes,blocks,beyond_jnd_samples,beyond_jnd_strokes");
  EXPECT_NE(csv.find("\ndirect,palpate,direct,6830,2000,0.99,0,0,0.5,0.4,0.6,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\na perfect model,floor,none,,2000,1,,,0,,,0,"), std::string::npos) << csv;
}

TEST(Tables, TimesStandApart) {
  for (const Table& table : make_tables(example())) {
    const bool named = table.name.size() > 6 && table.name.substr(table.name.size() - 6) == "_times";
    EXPECT_EQ(table.has_times, named) << table.name;
    for (const TableColumn& column : table.columns) {
      const bool time = column.key.find("_ns") != std::string::npos || column.key.find("fit_seconds") != std::string::npos;
      EXPECT_TRUE(!time || table.has_times) << table.name << " " << column.key;
    }
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.name;
  }
}

TEST(Tables, HardCasesSayWhetherTheyAreSafe) {
  HardCaseResult result;
  result.name = "two sites";
  result.method = "greedy";
  result.outcome = "bounded";
  result.worst_over_jnd = 3.0;
  result.within_jnd = 0.5;
  result.safe = true;
  EXPECT_EQ(table_csv(hard_case_table({result})),
            "case,method,safe,within_jnd,worst_over_jnd,condition,smoothing,residual,outcome\n"
            "two sites,greedy,yes,0.5,3,0,0,0,bounded\n");
}

TEST(Findings, LeadWithWhatEveryRungGains) {
  const auto plain = findings(example(), false);
  ASSERT_GE(plain.size(), 5u);
  EXPECT_EQ(plain[0].rfind("Within the JND of the test: a model that always says 0 N has ", 0), 0u) << plain[0];
  for (const char* rung : {"the trend alone", "the paper's recipe (paper-greedy-100)", "Palpate (greedy-100)"}) {
    EXPECT_NE(plain[0].find(rung), std::string::npos) << plain[0];
  }
  EXPECT_EQ(plain[1].rfind("Recommended: kdtree-30. ", 0), 0u) << plain[1];
  EXPECT_NE(plain[2].find("are tied with it"), std::string::npos) << plain[2];
  EXPECT_NE(plain[4].find("50.00 % of the test samples lie away from the training data; there greedy-100 has 50.00 % "
                          "within the JND, near the data 100.00 %."), std::string::npos) << plain[4];
  EXPECT_EQ(plain.back(), "Over 2 seeds the RMS error of random-100 lies between 10.0 and 12.0 mN.");
}

TEST(Findings, SayWhenFewSamplesOrStrokesDecide) {
  ReportData data = example();
  for (ModelResult& model : data.models) {
    model.pooled.strokes = 3;
    model.pooled.beyond_samples = 13;
    model.pooled.beyond_strokes = 1;
  }
  const std::string ties = findings(data, false)[2];
  EXPECT_NE(ties.find("The test has few strokes (3)"), std::string::npos) << ties;
  EXPECT_NE(ties.find("Few samples decide: the 13 samples beyond the JND lie in one stroke."), std::string::npos) << ties;
}

TEST(Tables, EveryErrorStandsBesideTheOneWithTheSurfaceMovedAndTheFloor) {
  ReportData data = example();
  data.surface_offset_m = {0.0003};
  for (ModelResult& model : data.models) model.pooled_moved = errors(0.005, 1.0, 0.5);
  const auto tables = make_tables(data);
  const auto ladder = std::find_if(tables.begin(), tables.end(), [](const Table& t) { return t.name == "ladder"; });
  ASSERT_NE(ladder, tables.end());
  EXPECT_EQ(ladder->rows.size(), main_models(data) + 1);
  EXPECT_EQ(ladder->rows.back()[1].text, "a perfect model");
  EXPECT_NE(findings(data, false)[3].find("the surface of the test lies at 0.30 mm; moved there, greedy-100 has 100.00 %"),
            std::string::npos) << findings(data, false)[3];
}

}  // namespace
}  // namespace palpate
