#include "scenes/report/tables.h"

#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kPercent = 100.0;
constexpr double kMilli = 1e3;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNone;
}

const std::vector<TableColumn>& error_columns() {
  static const std::vector<TableColumn> columns{
      {"contact_samples", "samples"},
      {"rms_error_N", "RMS [mN]", kMilli},
      {"max_error_N", "max [mN]", kMilli},
      {"within_jnd", "within the JND [%]", kPercent, 3},
      {"p99_error_over_jnd", "99 % of errors up to [JND]", 1.0, 2},
      {"max_error_over_jnd", "worst [JND]", 1.0, 2},
      {"out_of_domain_share", "away from the data [%]", kPercent, 2},
  };
  return columns;
}

void add_errors(std::vector<TableCell>& row, const ErrorSummary& errors) {
  row.emplace_back(errors.samples);
  for (const double value : {errors.rms_error_N, errors.max_error_N, errors.within_jnd, errors.p99_error_over_jnd,
                             errors.max_error_over_jnd}) {
    row.emplace_back(errors.samples > 0 ? value : kNone);
  }
  row.emplace_back(share(errors.out_of_domain_samples, errors.samples));
}

Table with_errors(const std::string& name, const std::string& caption, std::vector<TableColumn> columns) {
  columns.insert(columns.end(), error_columns().begin(), error_columns().end());
  return {name, caption, false, std::move(columns), {}};
}

std::string method_of(const ModelResult& model) { return model.plan.request.method->name; }

Table recordings_table(const ReportData& data) {
  Table table{"recordings",
              data.folds > 0 ? "There was no test recording: every one of these was tested by models that were fitted "
                               "to the others."
                             : "No model saw a test recording before it was tested on it.",
              false,
              {{"role", "used to"},
               {"recording", "recording"},
               {"samples", "samples"},
               {"contact_samples", "in contact"},
               {"seconds", "length [s]"},
               {"rate_Hz", "rate [Hz]"},
               {"deepest_m", "deepest [mm]", kMilli},
               {"largest_force_N", "largest force [N]"}},
              {}};
  for (const RecordingFacts& facts : data.recordings) {
    table.rows.push_back({facts.role, facts.name, facts.samples, facts.contact_samples, facts.seconds, facts.rate_Hz,
                          facts.deepest_m, facts.largest_force_N});
  }
  return table;
}

Table errors_table(const ReportData& data) {
  Table table = with_errors("speed_error",
                            "Errors over all test samples in contact. Compare the share within the JND first: it says "
                            "what a hand can notice.",
                            {{"model", "model"}, {"method", "method"}, {"centres", "centres or nodes"}});
  for (const ModelResult& model : data.models) {
    std::vector<TableCell> row{model.plan.name, method_of(model), static_cast<std::uint64_t>(model.size)};
    add_errors(row, model.pooled);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table times_table(const ReportData& data) {
  Table table{"speed_error_times",
              "Times on this machine: compare ratios. The fit times leave out what all methods share (reading, trend, "
              "features, reduction); a grid includes the direct fit that fills it.",
              true,
              {{"model", "model"},
               {"evaluation_ns_median", "evaluation, median [ns]"},
               {"evaluation_ns_p99", "99th percentile [ns]"},
               {"fit_seconds", "fit [s]"}},
              {}};
  for (const ModelResult& model : data.models) {
    const bool timed = model.time.measured;
    table.rows.push_back({model.plan.name, timed ? model.time.median_ns : kNone, timed ? model.time.p99_ns : kNone,
                          model.fit_seconds});
  }
  return table;
}

Table per_recording_table(const ReportData& data) {
  const bool several = data.test_names.size() > 1;
  Table table = with_errors("per_recording",
                            several ? "The same models, test recording by test recording: a model that is good on one "
                                      "and bad on another has not learnt the material."
                                    : "",
                            {{"recording", "recording"}, {"model", "model"}});
  for (std::size_t r = 0; r < data.test_names.size(); ++r) {
    for (const ModelResult& model : data.models) {
      if (!model.plan.main) continue;
      std::vector<TableCell> row{data.test_names[r], model.plan.name};
      add_errors(row, model.per_recording[r]);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// Every model over all test recordings, then the main ones recording by recording.
Table surface_table(const ReportData& data) {
  Table table{"surface_moved",
              "The figures above take positions as recorded. Where a recording has its surface elsewhere than the "
              "models, that alone can decide them; here each stands beside the same with the surface moved to where "
              "the main models fit best.",
              false,
              {{"recording", "recording"},
               {"surface_offset_m", "surface at [mm]", kMilli, 3},
               {"model", "model"}},
              {}};
  for (const bool moved : {false, true}) {
    const std::string key = moved ? "_surface_moved" : "_as_recorded";
    const std::string words = moved ? "moved: " : "";
    table.columns.push_back({"rms_error_N" + key, words + "RMS [mN]", kMilli});
    table.columns.push_back({"max_error_N" + key, words + "max [mN]", kMilli});
    table.columns.push_back({"within_jnd" + key, words + "within the JND [%]", kPercent, 3});
    table.columns.push_back({"p99_error_over_jnd" + key, words + "99 % of errors up to [JND]", 1.0, 2});
    table.columns.push_back({"max_error_over_jnd" + key, words + "worst [JND]", 1.0, 2});
  }
  const auto add = [&](const std::string& recording, double offset_m, const std::string& model,
                       const ErrorSummary& plain, const ErrorSummary& moved) {
    std::vector<TableCell> row{recording, offset_m, model};
    for (const ErrorSummary* errors : {&plain, &moved}) {
      for (const double value : {errors->rms_error_N, errors->max_error_N, errors->within_jnd,
                                 errors->p99_error_over_jnd, errors->max_error_over_jnd}) {
        row.emplace_back(errors->samples > 0 ? value : kNone);
      }
    }
    table.rows.push_back(std::move(row));
  };
  for (const ModelResult& model : data.models) {
    add("all", data.surface_offset_m.size() == 1 ? data.surface_offset_m.front() : kNone, model.plan.name, model.pooled,
        model.pooled_moved);
  }
  for (std::size_t r = 0; data.test_names.size() > 1 && r < data.surface_offset_m.size(); ++r) {
    for (const ModelResult& model : data.models) {
      if (!model.plan.main) continue;
      add(data.test_names[r], data.surface_offset_m[r], model.plan.name, model.per_recording[r],
          model.per_recording_moved[r]);
    }
  }
  return table;
}

Table bins_table(const ReportData& data) {
  Table table{"force_bins",
              "",
              false,
              {{"model", ""},
               {"force_from_N", ""},
               {"force_to_N", ""},
               {"count", ""},
               {"mean_abs_error_N", ""},
               {"std_abs_error_N", ""},
               {"max_abs_error_N", ""},
               {"jnd_N", ""}},
              {}};
  for (const ModelResult& model : data.models) {
    if (!model.plan.main) continue;
    for (const ErrorBin& bin : model.bins) {
      table.rows.push_back({model.plan.name, bin.force_from_N, bin.force_to_N, bin.count, bin.mean_abs_error_N,
                            bin.std_abs_error_N, bin.max_abs_error_N,
                            data.jnd.at(0.5 * (bin.force_from_N + bin.force_to_N))});
    }
  }
  return table;
}

Table coverage_table(const ReportData& data) {
  Table table = with_errors("coverage_errors",
                            "Near the training data and away from it, as greedy-100 sees it. Away from the data every "
                            "model falls back to the trend, so an error there asks for a recording, not for another "
                            "method.",
                            {{"model", "model"}, {"where", "where"}});
  for (const CoverageErrors& errors : data.coverage.errors) {
    for (const bool inside : {true, false}) {
      if ((inside ? errors.inside : errors.outside).samples == 0) continue;
      std::vector<TableCell> row{errors.model, std::string(inside ? "near the data" : "away from it")};
      add_errors(row, inside ? errors.inside : errors.outside);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table seeds_table(const ReportData& data) {
  Table table = with_errors("repeatability", "", {{"model", "model"}, {"seed", "seed"}});
  for (const SeedResult& seed : data.seeds) {
    std::vector<TableCell> row{seed.model.name, seed.seed};
    add_errors(row, seed.errors);
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += (text.empty() ? "" : "; ") + note;
  return text;
}

Table health_table(const ReportData& data) {
  Table table{"fit_health",
              "Rank below unknowns: the data did not decide, and the shortest solution was taken. A condition above "
              "1e12 means that weights are large and cancel; errors above then say whether it hurt.",
              false,
              {{"fold", "fold"},
               {"model", "model"},
               {"training_samples", "samples"},
               {"sites", "after reduction"},
               {"unknowns", "unknowns"},
               {"rank", "rank"},
               {"condition", "condition"},
               {"smoothing", "smoothing"},
               {"residual_rms", "residual [JND]"},
               {"training_within_jnd", "training within the JND [%]", kPercent, 2},
               {"notes", "notes"}},
              {}};
  for (const ModelResult& model : data.models) {
    for (const FitHealth& health : model.health) {
      const FitReport& report = health.report;
      const bool direct = model.plan.request.method->can_take(kTakesSolver);
      table.rows.push_back({static_cast<std::uint64_t>(health.fold + 1), model.plan.name, health.training_samples,
                            health.sites, static_cast<std::uint64_t>(report.columns),
                            static_cast<std::uint64_t>(report.rank), report.condition,
                            direct ? report.smoothing : kNone, report.residual_rms, health.training_within_jnd,
                            joined(report.notes)});
    }
  }
  return table;
}

Table sites_time_table(const ReportData& data) {
  Table table{"fit_time_sites_times", "", true, {{"model", ""}, {"sites", ""}, {"fit_seconds", ""}}, {}};
  for (const SitesTime& time : data.sites_time) table.rows.push_back({time.method, time.sites, time.seconds});
  return table;
}

Table dimension_table(const ReportData& data) {
  Table table{"dimension_times",
              "",
              true,
              {{"dimension", ""}, {"sites", ""}, {"grid_nodes", ""}, {"direct_seconds", ""}, {"grid_seconds", ""},
               {"greedy_seconds", ""}},
              {}};
  for (const DimensionTime& time : data.dimension_time) {
    table.rows.push_back({static_cast<std::uint64_t>(time.dimension), data.dimension_sites, time.nodes,
                          time.direct_seconds, time.grid_seconds, time.greedy_seconds});
  }
  return table;
}

}  // namespace

std::vector<Table> make_tables(const ReportData& data) {
  std::vector<Table> tables{recordings_table(data), errors_table(data),   times_table(data),
                            per_recording_table(data), surface_table(data), bins_table(data),  coverage_table(data),
                            seeds_table(data),      health_table(data),   sites_time_table(data),
                            dimension_table(data)};
  if (data.hard_cases) tables.push_back(*data.hard_cases);
  return tables;
}

Table hard_case_table(const std::vector<HardCaseResult>& results) {
  Table table{"hard_cases",
              "Every method on data that break numerics and on motions far from the training; made up, the same in "
              "every report. Safe: finite and bounded everywhere, or refused with a message. Errors are over what was "
              "held out.",
              false,
              {{"case", "case"},
               {"method", "method"},
               {"safe", "safe"},
               {"within_jnd", "within the JND [%]", kPercent, 1},
               {"worst_over_jnd", "worst [JND]"},
               {"condition", "condition"},
               {"smoothing", "smoothing"},
               {"residual", "residual [JND]"},
               {"outcome", "outcome"}},
              {}};
  for (const HardCaseResult& result : results) {
    table.rows.push_back({result.name, result.method, std::string(result.safe ? "yes" : "no"), result.within_jnd,
                          result.worst_over_jnd, result.condition, result.smoothing, result.residual, result.outcome});
  }
  return table;
}

}  // namespace palpate
