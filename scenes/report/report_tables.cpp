#include "scenes/report/report_tables.h"

namespace palpate {
namespace {

constexpr int kThree = TableColumn::kThreeDigits;

// A column and what stands in it.
template <typename Row>
struct Field {
  TableColumn column;
  TableCell (*cell)(const Row&);
};

template <typename Row>
Table table_of(const std::string& name, const std::vector<Row>& rows, const std::vector<Field<Row>>& fields) {
  Table table{name, false, {}, {}};
  for (const Field<Row>& field : fields) table.columns.push_back(field.column);
  for (const Row& row : rows) {
    table.rows.emplace_back();
    for (const Field<Row>& field : fields) table.rows.back().push_back(field.cell(row));
  }
  return table;
}

TableCell any(const ErrorSummary& errors, double value) { return errors.samples > 0 ? value : kNoNumber; }
TableCell yes_or_no(bool value) { return std::string(value ? "yes" : "no"); }

struct ModelRow {
  const ModelResult& of;
  const Evidence& errors;
  Interval within, p99, rms_N;
  PairedDifference difference;
};

Table models_table(const ReportData& data) {
  std::vector<ModelRow> rows;
  for (const ModelResult& one : data.models) {
    rows.push_back({one, one.errors, one.errors.within_interval(), one.errors.p99_interval(),
                    one.errors.rms_interval_N(),
                    paired_difference(one.errors, data.models[data.choice.chosen].errors)});
  }
  using R = const ModelRow&;
  using C = TableCell;
  return table_of<ModelRow>(
      "models", rows,
      {{{"model", "model"}, [](R r) -> C { return r.of.plan.name; }},
       {{"size", "size"}, [](R r) -> C { return static_cast<std::uint64_t>(r.of.size); }},
       {{"contact_samples", "samples"}, [](R r) -> C { return r.errors.samples; }},
       {{"within_jnd", "≤ JND [%]", kInPercent, 2, true}, [](R r) -> C { return r.errors.within_jnd; }},
       {{"within_jnd_low", ""}, [](R r) -> C { return r.within.low; }},
       {{"within_jnd_high", ""}, [](R r) -> C { return r.within.high; }},
       {{"within_at_least", "at least [%]", kInPercent, 2}, [](R r) -> C { return r.errors.within_at_least(); }},
       {{"p99_error_over_jnd", "99 % error [JND]", 1.0, kThree, true},
        [](R r) -> C { return r.errors.p99_error_over_jnd; }},
       {{"p99_error_over_jnd_low", ""}, [](R r) -> C { return r.p99.low; }},
       {{"p99_error_over_jnd_high", ""}, [](R r) -> C { return r.p99.high; }},
       {{"p99_at_most", ""}, [](R r) -> C { return r.errors.p99_at_most(); }},
       {{"rms_error_N", "RMS [mN]", kInMilli, kThree, true}, [](R r) -> C { return r.errors.rms_error_N; }},
       {{"rms_error_N_low", ""}, [](R r) -> C { return r.rms_N.low; }},
       {{"rms_error_N_high", ""}, [](R r) -> C { return r.rms_N.high; }},
       {{"max_error_N", "worst [mN]", kInMilli}, [](R r) -> C { return r.errors.max_error_N; }},
       {{"max_error_over_jnd", "worst [JND]"}, [](R r) -> C { return r.errors.max_error_over_jnd; }},
       {{"strokes", "strokes"}, [](R r) -> C { return r.errors.strokes; }},
       {{"beyond_strokes", "beyond"}, [](R r) -> C { return r.errors.beyond_strokes; }},
       {{"out_of_domain_samples", ""}, [](R r) -> C { return r.errors.out_of_domain_samples; }},
       {{"moved_within_jnd", "moved: ≤ JND [%]", kInPercent, 2},
        [](R r) { return any(r.of.moved, r.of.moved.within_jnd); }},
       {{"moved_p99_error_over_jnd", "99 % [JND]"}, [](R r) { return any(r.of.moved, r.of.moved.p99_error_over_jnd); }},
       {{"moved_rms_error_N", "RMS [mN]", kInMilli}, [](R r) { return any(r.of.moved, r.of.moved.rms_error_N); }},
       {{"left_out_p99_error_over_jnd", "left out: 99 % [JND]"},
        [](R r) { return any(r.of.left_out, r.of.left_out.p99_error_over_jnd); }},
       {{"difference_p99", "against the choice [JND]", 1.0, kThree, true}, [](R r) -> C { return r.difference.p99; }},
       {{"difference_p99_low", ""}, [](R r) -> C { return r.difference.interval.low; }},
       {{"difference_p99_high", ""}, [](R r) -> C { return r.difference.interval.high; }}});
}

Table times_table(const ReportData& data) {
  std::vector<ModelResult> rows;
  for (const ModelResult& one : data.models) {
    if (one.time.measured) rows.push_back(one);
  }
  using R = const ModelResult&;
  using C = TableCell;
  Table table = table_of<ModelResult>(
      "times", rows,
      {{{"model", "model"}, [](R r) -> C { return r.plan.name; }},
       {{"tick_ns", "tick [ns]", 1.0, 0}, [](R r) -> C { return r.time.tick.median_ns; }},
       {{"tick_p99_ns", "p99 [ns]", 1.0, 0}, [](R r) -> C { return r.time.tick.p99_ns; }},
       {{"evaluation_ns", "evaluation [ns]", 1.0, 0}, [](R r) -> C { return r.time.evaluation.median_ns; }},
       {{"evaluation_p99_ns", "p99 [ns]", 1.0, 0}, [](R r) -> C { return r.time.evaluation.p99_ns; }},
       {{"fit_seconds", "fit [s]"}, [](R r) -> C { return r.fit_seconds; }}});
  table.has_times = true;
  return table;
}

Table recordings_table(const ReportData& data) {
  using R = const RecordingFacts&;
  using C = TableCell;
  return table_of<RecordingFacts>(
      "recordings", data.recordings,
      {{{"role", "role"}, [](R r) -> C { return r.role; }},
       {{"name", "recording"}, [](R r) -> C { return r.name; }},
       {{"samples", "samples"}, [](R r) -> C { return r.samples; }},
       {{"contact_samples", "in contact"}, [](R r) -> C { return r.contact_samples; }},
       {{"seconds", "[s]"}, [](R r) -> C { return r.seconds; }},
       {{"rate_Hz", "[Hz]"}, [](R r) -> C { return r.rate_Hz; }},
       {{"deepest_m", "deepest [mm]", kInMilli}, [](R r) -> C { return r.deepest_m; }},
       {{"largest_force_N", "largest [N]"}, [](R r) -> C { return r.largest_force_N; }},
       {{"force_noise_N", "force noise [mN]", kInMilli}, [](R r) -> C { return r.force_noise_N; }},
       {{"accelerometer", "accelerometer"}, [](R r) { return yes_or_no(r.accelerometer); }},
       {{"content_hash", ""}, [](R r) -> C { return r.content_hash; }}});
}

struct BinRow {
  std::string model;
  ForceBin bin;
};

Table bins_table(const ReportData& data) {
  std::vector<BinRow> rows;
  for (const ModelResult& one : data.models) {
    for (const ForceBin& bin : one.errors.bins) {
      if (one.plan.main && bin.count > 0) rows.push_back({one.plan.name, bin});
    }
  }
  using R = const BinRow&;
  using C = TableCell;
  return table_of<BinRow>("force_bins", rows,
                          {{{"model", ""}, [](R r) -> C { return r.model; }},
                           {{"force_from_N", ""}, [](R r) -> C { return r.bin.force_from_N; }},
                           {{"force_to_N", ""}, [](R r) -> C { return r.bin.force_to_N; }},
                           {{"count", ""}, [](R r) -> C { return r.bin.count; }},
                           {{"mean_force_N", ""}, [](R r) -> C { return r.bin.mean_force_N; }},
                           {{"mean_abs_error_N", ""}, [](R r) -> C { return r.bin.mean_abs_error_N; }},
                           {{"std_abs_error_N", ""}, [](R r) -> C { return r.bin.std_abs_error_N; }},
                           {{"max_abs_error_N", ""}, [](R r) -> C { return r.bin.max_abs_error_N; }},
                           {{"mean_error_over_jnd", ""}, [](R r) -> C { return r.bin.mean_error_over_jnd; }},
                           {{"std_error_over_jnd", ""}, [](R r) -> C { return r.bin.std_error_over_jnd; }},
                           {{"max_error_over_jnd", ""}, [](R r) -> C { return r.bin.max_error_over_jnd; }}});
}

Table worth_table(const ReportData& data) {
  using R = const FeatureWorth&;
  using C = TableCell;
  return table_of<FeatureWorth>(
      "features", data.worth,
      {{{"feature", "feature"}, [](R r) -> C { return r.name; }},
       {{"taken", "taken"}, [](R r) { return yes_or_no(r.taken); }},
       {{"error_over_jnd_with", "RMS error over the JND with it"}, [](R r) -> C { return r.error_with; }},
       {{"error_over_jnd_without", "without"}, [](R r) -> C { return r.error_without; }}});
}

}  // namespace

std::vector<Table> make_tables(const ReportData& data) {
  return {models_table(data), recordings_table(data), bins_table(data), worth_table(data), times_table(data)};
}

}  // namespace palpate
