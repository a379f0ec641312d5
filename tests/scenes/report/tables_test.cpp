// Tables and findings from known numbers.
#include "scenes/report/tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/report/plan.h"

namespace palpate {
namespace {

ErrorSummary errors(double rms_N, double within, double worst) {
  ErrorSummary summary;
  summary.samples = 2000;
  summary.rms_error_N = rms_N;
  summary.max_error_N = 10.0 * rms_N;
  summary.within_jnd = within;
  summary.p99_error_over_jnd = 0.5;
  summary.max_error_over_jnd = worst;
  summary.out_of_domain_samples = 20;
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
    const bool good = model.size >= 30 && model.plan.request.method == &kKdTreeMethod;
    const bool trend = model.plan.request.method == &kTrendMethod;  // the first
    model.pooled = errors(trend ? 0.1 : 0.01 + 0.001 * static_cast<double>(i - 1), good ? 0.9995 : 0.99, 2.0);
    model.per_recording = {model.pooled};
    model.time = {model.plan.request.method == &kDirectMethod ? 5000.0 : 200.0, 300.0, true};
    model.fit_seconds = 1.5;
    model.health.push_back({0, {}, 100, 50, 0.9});
    data.models.push_back(std::move(model));
  }
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
            "model,method,centres,contact_samples,rms_error_N,max_error_N,within_jnd,p99_error_over_jnd,"
            "max_error_over_jnd,out_of_domain_share");
  EXPECT_NE(csv.find("\ndirect,direct,6830,2000,0.01,0.1,0.99,0.5,2,0.01\n"), std::string::npos) << csv;
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

TEST(Findings, NameTheSmallestGoodAndTheQuickest) {
  const ReportData data = example();
  const auto plain = findings(data, false);
  ASSERT_EQ(plain.size(), 3u);
  EXPECT_EQ(plain[0].rfind("The smallest model with at least 99.9 % of the samples within the JND is kdtree-30 (30 "
                           "centres): 99.95 % within the JND", 0), 0u) << plain[0];
  EXPECT_EQ(plain[1], "50.00 % of the test samples lie away from the training data; there greedy-100 has 50.00 % "
                      "within the JND, near the data 100.00 %.");
  EXPECT_EQ(plain[2], "Over 2 seeds the RMS error of random-100 lies between 10.0 and 12.0 mN.");
  const auto timed = findings(data, true);
  ASSERT_EQ(timed.size(), 2u);
  EXPECT_EQ(timed[0], "The most accurate model within 1 µs an evaluation is voxel (200 ns): 99.00 % within the JND, RMS "
                      "11.0 mN, worst error 2.00 JND.");
}

TEST(Tables, EveryErrorStandsBesideTheOneWithTheSurfaceMoved) {
  ReportData data = example();
  data.test_names = {"one", "two"};
  data.surface_offset_m = {0.0, 0.0003};
  for (ModelResult& model : data.models) {
    model.pooled_moved = errors(0.005, 1.0, 0.5);
    model.per_recording = {model.pooled, model.pooled};
    model.per_recording_moved = {model.pooled, model.pooled_moved};
  }
  const auto tables = make_tables(data);
  const auto moved = std::find_if(tables.begin(), tables.end(), [](const Table& t) { return t.name == "surface_moved"; });
  ASSERT_NE(moved, tables.end());
  EXPECT_EQ(moved->rows.size(), data.models.size() + 2 * main_models(data));
  const std::string csv = table_csv(*moved);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "recording,surface_offset_m,model,rms_error_N_as_recorded,max_error_N_as_recorded,within_jnd_as_recorded,"
            "p99_error_over_jnd_as_recorded,max_error_over_jnd_as_recorded,rms_error_N_surface_moved,"
            "max_error_N_surface_moved,within_jnd_surface_moved,p99_error_over_jnd_surface_moved,"
            "max_error_over_jnd_surface_moved");
  EXPECT_NE(csv.find("\ntwo,0.0003,direct,0.01,0.1,0.99,0.5,2,0.005,0.1,1,0.5,0.5\n"), std::string::npos) << csv;
  EXPECT_EQ(findings(data, false)[2],
            "1 of 2 test recordings have their surface elsewhere than the models (two farthest, by 0.300 mm). With the "
            "surface moved direct has 100.00 % within the JND and RMS 5.00 mN, as recorded 99.00 % and 10.0 mN.");
}

TEST(Findings, SayWhenNoModelIsGoodEnough) {
  ReportData data = example();
  for (ModelResult& model : data.models) model.pooled.within_jnd = 0.5;
  data.models[3].pooled.within_jnd = 0.8;
  EXPECT_EQ(findings(data, false)[0].rfind("No model keeps 99.9 % of the samples within the JND; random-100 comes "
                                           "nearest: 80.00 %", 0), 0u);
}

TEST(Plan, MainModelsComeFirstAndDirectBeforeTheGridsItFills) {
  for (const bool quick : {true, false}) {
    for (const std::size_t features : {std::size_t{1}, std::size_t{4}, std::size_t{8}}) {
      const ReportPlan plan = make_plan(quick, features);
      for (std::size_t i = 0; i < plan.models.size(); ++i) EXPECT_EQ(plan.models[i].main, i < methods().size() + 1);
      EXPECT_EQ(plan.models[1].request.method, &kDirectMethod);
      EXPECT_EQ(plan.models[methods().size()].name, "greedy-100");
      EXPECT_GE(plan.seeds.size(), 10u);
    }
  }
}

}  // namespace
}  // namespace palpate
