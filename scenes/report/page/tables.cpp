#include "scenes/report/page/tables.h"

#include "scenes/report/measure/recommendation.h"

namespace palpate {
namespace {

Table recordings_table(const ReportData& data) {
  Table table{"recordings",
              std::string(data.folds > 0
                              ? "There was no test recording: every one of these was tested by models that were "
                                "fitted to the others. "
                              : "") +
                  "No two have the same content, and no stretch of what was tested was trained on: the measured "
                  "forces were compared bit by bit. The noise of the force sensor decides what a perfect model could "
                  "have within the JND.",
              false,
              {{"role", "used to"},
               {"recording", "recording"},
               {"samples", "samples"},
               {"contact_samples", "in contact"},
               {"seconds", "length [s]"},
               {"rate_Hz", "rate [Hz]"},
               {"deepest_m", "deepest [mm]", kInMilli},
               {"largest_force_N", "largest force [N]"},
               {"force_noise_N", "force noise [mN]", kInMilli},
               {"noise_floor_within_jnd", "perfect model within the JND [%]", kInPercent, 2},
               {"content_hash", ""}},
              {}};
  for (const RecordingFacts& facts : data.recordings) {
    table.rows.push_back({facts.role, facts.name, facts.samples, facts.contact_samples, facts.seconds, facts.rate_Hz,
                          facts.deepest_m, facts.largest_force_N, facts.noise.force_noise_N, facts.noise.within_jnd,
                          facts.content_hash});
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
    if (model.plan.rung == Rung::no_force) continue;
    const bool timed = model.time.measured;
    table.rows.push_back({model.plan.name, timed ? model.time.median_ns : kNoNumber, timed ? model.time.p99_ns : kNoNumber,
                          model.fit_seconds});
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
               {"mean_force_N", ""},
               {"mean_error_over_jnd", ""},
               {"std_error_over_jnd", ""},
               {"max_error_over_jnd", ""}},
              {}};
  for (const ModelResult& model : data.models) {
    if (!model.plan.main) continue;
    for (const ErrorBin& bin : model.bins) {
      table.rows.push_back({model.plan.name, bin.force_from_N, bin.force_to_N, bin.count, bin.mean_abs_error_N,
                            bin.std_abs_error_N, bin.max_abs_error_N, bin.mean_force_N, bin.mean_error_over_jnd,
                            bin.std_error_over_jnd, bin.max_error_over_jnd});
    }
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
               {"training_within_jnd", "training within the JND [%]", kInPercent, 2},
               {"notes", "notes"}},
              {}};
  for (const ModelResult& model : data.models) {
    for (const FitHealth& health : model.health) {
      const FitReport& report = health.report;
      const bool direct = model.plan.request.method->can_take(kTakesSolver);
      table.rows.push_back({static_cast<std::uint64_t>(health.fold + 1), model.plan.name, health.training_samples,
                            health.sites, static_cast<std::uint64_t>(report.columns),
                            static_cast<std::uint64_t>(report.rank), report.condition,
                            direct ? report.smoothing : kNoNumber, report.residual_rms, health.training_within_jnd,
                            joined(report.notes)});
    }
  }
  return table;
}

Table sites_time_table(const ReportData& data) {
  Table table{"fit_time_sites_times", "", true, {{"model", ""}, {"sites", ""}, {"fit_seconds", ""}}, {}};
  for (const SitesTime& time : data.sites_time) table.rows.push_back({time.model, time.sites, time.seconds});
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

std::vector<Table> facts_tables(const ReportData& data) {
  const ModelFacts& facts = data.facts;
  Table values{"model_facts",
               "What " + facts.model + " says of the material.",
               false,
               {{"quantity", "quantity"}, {"value", "value"}, {"unit", "unit"}, {"meaning", "meaning"}},
               facts.values};
  Table features{"model_features",
                 "What it is given, in SI, with the range in training.",
                 false,
                 {{"feature", "feature"}, {"lowest", "lowest"}, {"highest", "highest"}},
                 facts.features};
  Table worth{"feature_worth",
              "What every feature is worth: the trend's RMS error over the JND on training strokes left out, with it "
              "and without it.",
              false,
              {{"feature", "feature"},
               {"taken", "taken"},
               {"error_over_jnd_with", "error with it [JND]"},
               {"error_over_jnd_without", "without it [JND]"}},
              {}};
  for (const FeatureWorth& one : data.worth) {
    worth.rows.push_back({one.name, std::string(one.taken ? "yes" : "no"), one.error_with, one.error_without});
  }
  Table curve{"model_depth",
              "",
              false,
              {{"depth_m", ""},
               {"elastic_N", ""},
               {"elastic_stiffness_N_per_m", ""},
               {"instantaneous_stiffness_N_per_m", ""},
               {"viscosity_slow_Ns_per_m", ""},
               {"viscosity_fast_Ns_per_m", ""}},
              {}};
  for (const auto& row : facts.depth) curve.rows.emplace_back(row.begin(), row.end());
  Table spectrum{"model_relaxation", "", false, {{"relaxation_time_s", ""}, {"stiffness_N_per_m", ""}}, {}};
  for (const auto& row : facts.spectrum) spectrum.rows.emplace_back(row.begin(), row.end());
  return {values, features, worth, curve, spectrum};
}

}  // namespace

std::vector<Table> make_tables(const ReportData& data) {
  std::vector<Table> tables = error_tables(data);
  for (Table& table : std::vector<Table>{recordings_table(data), times_table(data), bins_table(data), health_table(data),
                                         sites_time_table(data), dimension_table(data)}) {
    tables.push_back(std::move(table));
  }
  for (Table& table : facts_tables(data)) tables.push_back(std::move(table));
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
               {"within_jnd", "within the JND [%]", kInPercent, 1},
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
