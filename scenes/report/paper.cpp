#include "scenes/report/paper.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "models/correction/methods.h"

namespace palpate {
namespace {

constexpr double kLargeForce_N = 2.5;  // the largest force of the paper's study
constexpr double kSmallForce_N = 0.5;
// Above this ratio of the slowest to the fastest round the times have a remark.
constexpr double kBusy = 1.5;
constexpr double kAny = 1e300;

using BinFigure = double (*)(const ForceBin&);
double spread(const ForceBin& bin) { return bin.error_N.mean() + bin.error_N.deviation(); }
double largest(const ForceBin& bin) { return bin.error_N.largest(); }

// The values that count as reproduced.
struct Tolerance {
  double low = 0.0;
  double high = 0.0;
  const char* text = "";

  ClaimVerdict of(double value) const {
    return value >= low && value <= high ? ClaimVerdict::reproduced : ClaimVerdict::different;
  }
};
constexpr Tolerance kIdentical{1.0 / 1.1, 1.1, "0.91 to 1.1: a tenth of errors below the JND is a tenth of a JND"};
constexpr Tolerance kSimilar{0.8, 1.25, "0.8 to 1.25: less than considerable"};
constexpr Tolerance kConsiderable{0.25, 0.8,
                                  "0.25 to 0.8: twice the difference that counts as none; on one axis in the figures"};
constexpr Tolerance kLess{0.25, 1.0 / 1.1,
                          "0.25 to 0.91: more than the difference that counts as none; on one axis in the figures"};
constexpr Tolerance kFaster{0.0, 1.0 / 1.1, "up to 0.91: by more than a tenth; the paper gives no other limit"};
constexpr Tolerance kLonger{1.1, 3.6, "1.1 to 3.6: more than a tenth, up to twice the 1.8 of greedy-20 over kD-tree"};
constexpr Tolerance kLinear{0.8, 1.2, "0.8 to 1.2: twice the samples take 1.7 to 2.3 times as long"};
constexpr Tolerance kCubic{2.7, 3.3, "2.7 to 3.3: twice the samples take 6.5 to 9.8 times as long"};
constexpr Tolerance kTenfold{8.0, 12.5, "8 to 12.5: ten times the nodes; the other work of a node grows by a fifth"};

std::size_t bins_above(const PaperData& data, const PaperModel& model, BinFigure figure) {
  return static_cast<std::size_t>(std::ranges::count_if(
      model.errors.bins, [&](const ForceBin& bin) { return figure(bin) > data.jnd.at(bin.force_N.mean()); }));
}

std::string of_bins(std::size_t above, const PaperModel& model) {
  return std::to_string(above) + " of " + std::to_string(model.errors.bins.size()) + " bins above";
}

class Claims {
 public:
  explicit Claims(const PaperData& data) : data_(data) {}

  std::vector<Claim> all() {
    add_bins(kRandomCentres, "random: at every force some samples err above the JND",
             "random: the same with other recordings");
    add_bins(kTreeCentres, "kD-tree: mean plus deviation always below the JND",
             "kD-tree: the same with other recordings");
    add_bins(kGreedy20, "greedy-20: mean plus deviation always below the JND");
    add_bins(kGreedy100, "greedy-100: mean plus deviation always below the JND");
    add_settings(claims_[2]);
    add_comparisons();
    for (Claim& claim : claims_) {
      if (claim.why.empty() && std::ranges::count(claim.here, ClaimVerdict::different, &Claim::Result::verdict) > 0)
        claim.why = "The paper's recordings are not public.";
    }
    add_study();
    add_times();
    add_growth();
    return std::move(claims_);
  }

 private:
  // Mean over the bins with forces between two values of a figure, in JND.
  double level(const PaperModel& model, BinFigure figure, double from_N = 0.0, double to_N = kAny) const {
    double sum = 0.0, count = 0.0;
    for (const ForceBin& bin : model.errors.bins) {
      const double force_N = bin.force_N.mean();
      if (force_N <= from_N || force_N >= to_N) continue;
      sum += figure(bin) / data_.jnd.at(force_N);
      count += 1.0;
    }
    return sum / std::max(1.0, count);
  }

  // What a fifth of the recordings cannot decide.
  ClaimVerdict decided(ClaimVerdict verdict) const { return data_.quick ? ClaimVerdict::undecided : verdict; }

  // Adds a claim that is checked in each run by `result`, a function of the run.
  template <typename Check>
  void add(Claim claim, const Check& result) {
    for (const PaperRun& run : data_.runs) claim.here.push_back(result(run));
    claims_.push_back(std::move(claim));
  }
  // Adds a claim about a ratio of two figures of one run.
  template <typename Ratio>
  void add_ratio(Claim claim, const Tolerance& tolerance, const char* what, const Ratio& ratio) {
    claim.tolerance = tolerance.text;
    add(std::move(claim), [&](const PaperRun& run) {
      const double value = ratio(run);
      return Claim::Result{three_digits(value) + what, decided(tolerance.of(value))};
    });
  }
  // Adds a claim about measurements that are made once for all runs.
  void add_once(Claim claim, const std::string& text, ClaimVerdict verdict) {
    claim.here.resize(data_.runs.size());
    claim.here.front() = {text, verdict};
    claims_.push_back(std::move(claim));
  }
  // A remark on times of several rounds; empty if they agree.
  std::string busy() const {
    if (data_.slowest_round <= kBusy) return {};
    return "Busy machine: rounds differ by up to " + three_digits(data_.slowest_round) + " times.";
  }
  // As add_once, about such times.
  void add_timed(Claim claim, const std::string& text, ClaimVerdict verdict) {
    claim.why += (claim.why.empty() ? "" : " ") + busy();
    add_once(std::move(claim), text, verdict);
  }

  // Of random, whether some samples err above the JND in every bin; of the others, whether mean plus deviation is below
  // it in every bin. `others`: the claim about other recordings, if there is one.
  void add_bins(PaperMethod which, const char* claim, const char* others = nullptr) {
    const bool random = which == kRandomCentres;
    const char* tolerance = random ? "every bin: the paper says each" : "0: the paper says always";
    const auto result = [&](const PaperModel& model) {
      const std::size_t above = bins_above(data_, model, random ? largest : spread);
      const bool as_there = above == (random ? model.errors.bins.size() : 0);
      return Claim::Result{of_bins(above, model), as_there ? ClaimVerdict::reproduced : ClaimVerdict::different};
    };
    const char* there = random ? "every force" : "0 bins above";
    add({claim, there, tolerance}, [&](const PaperRun& run) { return result(run.models[which]); });
    if (others == nullptr) return;
    add({others, there, tolerance}, [&](const PaperRun& run) { return result(run.exchanged[which]); });
  }

  // Adds to the claim about kD-tree how many bins are above with other settings of what the paper leaves open, and
  // whether these are the cause of a difference.
  void add_settings(Claim& tree) const {
    std::string passing;
    for (std::size_t i = 0; i < data_.runs.size(); ++i) {
      std::vector<std::size_t> above;
      for (const PaperModel& one : data_.runs[i].settings) above.push_back(bins_above(data_, one, spread));
      const auto [least, most] = std::ranges::minmax(above);
      Claim::Result& here = tree.here[i];
      here.text += "; " + std::to_string(least) + " to " + std::to_string(most) + " with other settings";
      if (here.verdict == ClaimVerdict::different && least == 0) passing += " " + run_name(data_.runs[i]) + ".";
    }
    tree.why = "Settings: every kernel and normalisation, each with several truncations. " +
               (passing.empty() ? "Where it fails, it fails with each of them." : "One passes on" + passing);
  }

  // Mean plus deviation, or another figure, of one method over that of another.
  double ratio(const PaperRun& run, PaperMethod one, PaperMethod other, BinFigure figure = spread, double from_N = 0.0,
               double to_N = kAny) const {
    return level(run.models[one], figure, from_N, to_N) / level(run.models[other], figure, from_N, to_N);
  }

  void add_comparisons() {
    add_ratio({"kD-tree is more accurate than random", "yes"}, kLess, " times mean plus deviation",
              [&](const PaperRun& run) { return ratio(run, kTreeCentres, kRandomCentres); });
    add_ratio({"especially at large forces", "yes"}, kLess, " times that ratio above 2.5 N", [&](const PaperRun& run) {
      return ratio(run, kTreeCentres, kRandomCentres, spread, kLargeForce_N) / ratio(run, kTreeCentres, kRandomCentres);
    });
    // greedy-20 is the same strategy, and almost identical.
    add_ratio({"greedy-100 is more accurate than random and kD-tree", "the highest of all"}, kLess,
              " times the better of them", [&](const PaperRun& run) {
                return std::max(ratio(run, kGreedy100, kRandomCentres), ratio(run, kGreedy100, kTreeCentres));
              });
    add_ratio({"greedy-100 has the lowest maxima (figures 6 and 7)", "the highest accuracy of all"}, kLess,
              " times the better of random and kD-tree", [&](const PaperRun& run) {
                return std::max(ratio(run, kGreedy100, kRandomCentres, largest),
                                ratio(run, kGreedy100, kTreeCentres, largest));
              });
    add_ratio({"greedy-100 is almost as accurate as the interpolant", "almost identical"}, kIdentical,
              " times mean plus deviation", [&](const PaperRun& run) { return ratio(run, kGreedy100, kGridOfAll); });
    add_ratio({"20 and 100 candidates: mean plus deviation almost identical", "almost identical"}, kIdentical, " times",
              [&](const PaperRun& run) { return ratio(run, kGreedy20, kGreedy100); });
    add_ratio({"100 candidates: maxima at small forces considerably lower", "considerably lower"}, kConsiderable,
              " times the maxima below 0.5 N",
              [&](const PaperRun& run) { return ratio(run, kGreedy100, kGreedy20, largest, 0.0, kSmallForce_N); });
    add_ratio({"greedy: repetitions with other random selections change little", "not considerably"}, kSimilar,
              " times, of the repetition that differs most", [&](const PaperRun& run) {
                double most = 1.0;
                for (const PaperModel& one : run.repeated) {
                  const double share = level(one, spread) / level(run.models[kGreedy100], spread);
                  if (std::abs(std::log(share)) > std::abs(std::log(most))) most = share;
                }
                return most;
              });
  }

  void add_study() {
    const auto relative = [&](const JndPoint& point) { return point.jnd_N / point.reference_N; };
    const double rise = relative(data_.points.front()) / relative(kPangTanDurlach);
    add_once({"the relative JND rises at small forces", "13.3 % at 2.5 N, more below; 9 % of Pang et al.", "",
              "Simulated subjects, whose JND is 0.05 N + 11.3 %: they show that the study finds it."},
             fixed(100.0 * relative(data_.points.front()), 1) + " % at " +
                 three_digits(data_.points.front().reference_N) + " N, " + three_digits(rise) +
                 " times that of Pang et al.",
             ClaimVerdict::other_subjects);
  }

  // The fast methods, in the order of the paper's times.
  static constexpr PaperMethod kFast[] = {kRandomCentres, kTreeCentres, kGreedy20, kGreedy100};

  void add_times() {
    add({"samples after the reduction to 50 mN steps", "6,850 of 41,499"}, [](const PaperRun& run) {
      return Claim::Result{
          with_thousands(std::to_string(run.sites)) + " of " + with_thousands(std::to_string(run.trained)),
          ClaimVerdict::other_recording};
    });
    add({"one evaluation with 100 centres", "60 us"}, [](const PaperRun& run) {
      const ModelTiming& time = run.models[kGreedy100].time;
      return Claim::Result{
          three_digits(time.evaluation.median_ns) + " ns; whole tick " + three_digits(time.tick.median_ns) + " ns",
          ClaimVerdict::other_machine};
    });
    const FitTimes& most = data_.by_sites.back();
    std::string text;
    double slowest = 0.0;
    for (const PaperMethod which : kFast) {
      text += (text.empty() ? "" : ", ") + three_digits(most.fit_s[which]) + " s";
      slowest = std::max(slowest, most.fit_s[which]);
    }
    const double grid_s = most.fit_s[kGridOfAll];
    add_timed(
        {"time of a fit: random, kD-tree, greedy-20, greedy-100, interpolation", "4 s, 5 min, 9 min, 41 min, 50 min"},
        text + ", " + three_digits(grid_s) + " s", ClaimVerdict::other_machine);
    add_ratio({"the more accurate a selection, the longer it takes", "1.8 times or more", "", busy()}, kLonger,
              " times or more, of two whose errors differ by more than a tenth", [&](const PaperRun& run) {
                double least = kAny;
                for (const PaperMethod one : kFast)
                  for (const PaperMethod other : kFast)
                    if (ratio(run, one, other) < kIdentical.low)
                      least = std::min(least, most.fit_s[one] / most.fit_s[other]);
                return least < kAny ? least : 1.0;  // no two differ
              });
    add_timed({"with many samples every fast method beats the interpolation", "yes", kFaster.text},
              three_digits(slowest / grid_s) + " times its time, of the slowest",
              decided(kFaster.of(slowest / grid_s)));
  }

  void add_growth() {
    const FitTimes& most = data_.by_sites.back();
    const FitTimes& fewer = data_.by_sites[data_.by_sites.size() - 2];
    // The exponent of a power law through the last two numbers of sites, or of centres.
    const auto power = [](double most_s, double fewer_s, double more, double less) {
      return std::log(most_s / fewer_s) / std::log(more / less);
    };
    const auto exponent = [&](double most_s, double fewer_s) {
      return power(most_s, fewer_s, static_cast<double>(most.of), static_cast<double>(fewer.of));
    };
    std::string linear;
    ClaimVerdict verdict = ClaimVerdict::reproduced;
    for (const PaperMethod which : kFast) {
      const double slope = exponent(most.fit_s[which], fewer.fit_s[which]);
      if (kLinear.of(slope) != ClaimVerdict::reproduced) verdict = ClaimVerdict::different;
      linear += (linear.empty() ? "exponents " : ", ") + fixed(slope, 2);
    }
    add_timed({"cost of random, kD-tree and greedy is linear in the samples", "linear", kLinear.text,
               "A part of the cost, such as the decomposition of 100 columns, does not grow with the samples."},
              linear, decided(verdict));
    const double cubic = exponent(most.solve_s, fewer.solve_s);
    add_timed({"that of the interpolation grows with their third power", "3", kCubic.text,
               "A Cholesky factor instead of singular values; filling the matrix grows with the second power."},
              "exponent " + fixed(cubic, 2), decided(kCubic.of(cubic)));
    const FitTimes& last = data_.by_dimension.back();
    const FitTimes& before = data_.by_dimension[data_.by_dimension.size() - 2];
    const double tenfold = last.grid_s() / before.grid_s();
    // Figure 2: the first dimension in which the grid takes longer than the solution.
    const auto grid_dominates =
        std::ranges::find_if(data_.by_dimension, [](const FitTimes& one) { return one.grid_s() > one.solve_s; });
    const bool crosses = grid_dominates != data_.by_dimension.end();
    add_timed({"with more than four dimensions the grid takes longer than the solution (figure 2)", "from 5-D on",
               "from 5-D on: the paper says more than four"},
              crosses ? "from " + std::to_string(grid_dominates->of) + "-D on" : "never",
              decided(crosses && grid_dominates->of == 5 ? ClaimVerdict::reproduced : ClaimVerdict::different));
    const double growth = last.fit_s[kGreedy20] / before.fit_s[kGreedy20];
    add_timed({"the cost of a selection does not grow exponentially with the dimension", "avoided", kSimilar.text},
              three_digits(growth) + " times with one more dimension, greedy-20", decided(kSimilar.of(growth)));
    const auto [many, many_s] = data_.by_centres.back();
    const auto [half, half_s] = data_.by_centres[data_.by_centres.size() - 2];
    const double evaluation = power(many_s, half_s, many, half);
    add_timed({"the cost of an evaluation is linear in the centres", "controlled by their number", kLinear.text},
              "exponent " + fixed(evaluation, 2), decided(kLinear.of(evaluation)));
    add_timed(
        {"the grid's cost grows tenfold with each dimension of 10 nodes", "exponentially", kTenfold.text},
        three_digits(tenfold) + " times from " + std::to_string(before.of) + "-D to " + std::to_string(last.of) + "-D",
        decided(kTenfold.of(tenfold)));
    add_timed({"six dimensions of 10 nodes", "308 min, solve 50 min"},
              std::to_string(last.of) + "-D: " + three_digits(last.fit_s[kGridOfAll]) + " s, solve " +
                  three_digits(last.solve_s) + " s",
              ClaimVerdict::other_machine);
  }

  const PaperData& data_;
  std::vector<Claim> claims_;
};

}  // namespace

std::string run_name(const PaperRun& run) { return run.material + (run.fitted_times ? ", fitted times" : ""); }

std::vector<Claim> paper_claims(const PaperData& data) { return Claims(data).all(); }

namespace {

// The JND as a curve over the force. `relative`: divided by the force.
Series jnd_curve(const JndLine& jnd, double from_N, double to_N, bool relative) {
  Series curve{"JND", kMutedColour, Mark::dashed, {}};
  for (int i = 0; i <= 60; ++i) {
    const double force_N = from_N + (to_N - from_N) * i / 60.0;
    curve.rows.push_back({force_N, jnd.at(force_N) / (relative ? force_N : 1.0)});
  }
  return curve;
}

Plot bins_figure(const PaperData& data, int number, const std::string& title, bool relative, BinFigure value) {
  Plot plot{.name = "figure_" + std::to_string(number),
            .columns = 2,
            .caption = "Figure " + std::to_string(number) + ": " + title + " over the measured force."};
  for (const PaperRun& run : data.runs) {
    Panel panel{.title = run_name(run),
                .x = {"Force [N]"},
                .y = {relative ? "Relative error" : "Error", relative ? "" : "N", true},
                .names_at_ends = true};
    for (const PaperModel& model : run.models) {
      Series& series = panel.series.emplace_back(Series{model.name, model.colour, Mark::curve, {}});
      for (const ForceBin& bin : model.errors.bins) series.rows.push_back({bin.force_N.mean(), value(bin)});
    }
    const std::vector<PlotRow> rows = panel.series.front().rows;  // at the same forces as all
    panel.series.push_back(jnd_curve(data.jnd, rows.front().x, rows.back().x, relative));
    plot.panels.push_back(std::move(panel));
  }
  return plot;
}

// Computation times over `x`, in one panel. `about`: what follows the number in the caption.
Plot time_figure(int number, const std::string& about, const Axis& x, std::vector<Series> series) {
  return {.name = "figure_" + std::to_string(number),
          .width = 0.6,
          .panels = {{.x = x, .y = {"Time", "s", true}, .series = std::move(series), .names_at_ends = true}},
          .caption = "Figure " + std::to_string(number) + ": computation time over the " + about};
}

Plot dimension_figure(const PaperData& data) {
  Series solve{"solve", kInkColour, Mark::curve, {}};
  Series grid{"grid", kVoxelMethod.colour, Mark::curve, {}};
  Series both{"both", kMutedColour, Mark::curve, {}};
  for (const FitTimes& one : data.by_dimension) {
    const auto d = static_cast<double>(one.of);
    solve.rows.push_back({d, one.solve_s});
    grid.rows.push_back({d, one.grid_s()});
    both.rows.push_back({d, one.fit_s[kGridOfAll]});
  }
  return time_figure(2, "dimension of the domain, interpolation of all sites and a grid of 10 nodes a dimension.",
                     {"Dimensions", ""}, {both, solve, grid});
}

Plot jnd_figure(const PaperData& data) {
  Plot plot{.name = "figure_3", .columns = 2, .height = 1.5};
  plot.caption =
      "Figure 3: JND of twelve simulated subjects in the paper's study, with standard errors, and the point of Pang, "
      "Tan & Durlach (1991); the line through them, and the paper's conservative line, 0.065 N + 6.33 %. The paper's "
      "13.3 % at 2.5 N is the only one of its points with a published value.";
  for (const bool relative : {false, true}) {
    Series study{"simulated study", kGreedyMethod.colour, Mark::bars, {}};
    Series other{"Pang et al.", kRandomMethod.colour, Mark::bars, {}};
    Series papers{"the paper", kMeasuredColour, Mark::bars, {{2.5, relative ? 0.133 : 0.133 * 2.5}}};
    for (const JndPoint& point : data.points) {
      const double by = relative ? point.reference_N : 1.0, error_N = point.standard_error_N;
      Series& to = point.source == kPangTanDurlach.source ? other : study;
      to.rows.push_back(
          {point.reference_N, point.jnd_N / by, (point.jnd_N - error_N) / by, (point.jnd_N + error_N) / by});
    }
    Series fitted = jnd_curve(data.lines.fitted, 0.2, 3.0, relative);
    fitted.name = "fitted line";
    fitted.mark = Mark::line;
    Series conservative = jnd_curve(data.jnd, 0.2, 3.0, relative);
    conservative.name = "conservative line";
    plot.panels.push_back({.x = {"Reference force [N]"},
                           .y = {relative ? "Relative JND" : "JND [N]"},
                           .series = {std::move(study), std::move(other), std::move(papers), std::move(fitted),
                                      std::move(conservative)}});
  }
  return plot;
}

Plot sites_figure(const PaperData& data) {
  std::vector<Series> curves;
  for (std::size_t i = 0; i < data.runs.front().models.size(); ++i) {
    const PaperModel& model = data.runs.front().models[i];
    Series& curve = curves.emplace_back(Series{model.name, model.colour, Mark::curve, {}});
    for (const FitTimes& one : data.by_sites) curve.rows.push_back({static_cast<double>(one.of), one.fit_s[i]});
  }
  return time_figure(8, "number of data points; the interpolation with its 25x11x11x11 grid.",
                     {"Data points", "", true}, std::move(curves));
}

std::vector<Plot> paper_figures(const PaperData& data) {
  return {
      dimension_figure(data),
      jnd_figure(data),
      bins_figure(data, 4, "mean plus standard deviation of the absolute error", false, spread),
      bins_figure(data, 5, "mean plus standard deviation of the relative error", true,
                  [](const ForceBin& bin) { return bin.relative.mean() + bin.relative.deviation(); }),
      bins_figure(data, 6, "maximum absolute error", false, largest),
      bins_figure(data, 7, "maximum relative error", true, [](const ForceBin& bin) { return bin.relative.largest(); }),
      sites_figure(data)};
}

const char* verdict_name(ClaimVerdict verdict) {
  constexpr const char* kNames[] = {"",
                                    "reproduced",
                                    "not reproduced",
                                    "not decided by --quick",
                                    "another machine",
                                    "another recording",
                                    "simulated subjects"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Table claims_table(const PaperData& data, const std::vector<Claim>& claims) {
  Table table{"claims", true};
  for (const Claim& claim : claims) {
    table.begin_row();
    table.add({"claim", "claim of the paper"}, claim.claim);
    table.add({"there", "there"}, claim.there);
    for (std::size_t i = 0; i < data.runs.size(); ++i) {
      const std::string name = run_name(data.runs[i]);
      const std::string key = data.runs[i].material + (data.runs[i].fitted_times ? "_fitted_times" : "");
      const auto& [text, verdict] = claim.here[i];
      table.add({key, name, 1.0, TableColumn::kThreeDigits, 1}, verdict_name(verdict));
      table.add({key + "_measured", ""}, text);
    }
    table.add({"tolerance", "reproduced if"}, claim.tolerance);
    table.add({"remark", "remark"}, claim.why);
  }
  return table;
}

Table models_table(const PaperData& data) {
  Table table{"models", true};
  for (const PaperRun& run : data.runs) {
    for (const PaperModel& model : run.models) {
      table.begin_row();
      table.add({"run", "run"}, run_name(run));
      table.add({"model", "model"}, model.name);
      table.add({"rms_error_N", "RMS [mN]", kInMilli}, model.errors.rms_error_N);
      table.add({"fit_seconds", "fit [s]"}, model.fit_seconds);
      table.add({"evaluation_ns", "evaluation [ns]", 1.0, 0}, model.time.evaluation.median_ns);
      table.add({"tick_ns", "tick [ns]", 1.0, 0}, model.time.tick.median_ns);
    }
  }
  return table;
}

Table bins_table(const PaperData& data) {
  Table table{"bins"};
  for (const PaperRun& run : data.runs) {
    for (const PaperModel& model : run.models) {
      for (const ForceBin& bin : model.errors.bins) {
        table.begin_row();
        table.add({"run", ""}, run_name(run));
        table.add({"model", ""}, model.name);
        table.add({"force_N", ""}, bin.force_N.mean());
        table.add({"count", ""}, bin.force_N.count());
        table.add_moments("error_N", bin.error_N);
        table.add_moments("relative_error", bin.relative);
        table.add({"jnd_N", ""}, data.jnd.at(bin.force_N.mean()));
      }
    }
  }
  return table;
}

std::string runs_words(const PaperData& data) {
  std::string text;
  for (const PaperRun& run : data.runs) {
    text.append(run_name(run)).append(": ").append(with_thousands(std::to_string(run.trained)));
    text.append(" samples to train, ").append(with_thousands(std::to_string(run.tested)));
    text.append(" to test, relaxation times");
    for (const double time_s : run.times_s) text.append(" ").append(three_digits(time_s)).append(" s");
    text.append("; ").append(run.choices).append(". ");
  }
  return text;
}

std::string summary(const PaperData& data, const std::vector<Claim>& claims) {
  std::string text = "Reproduced: ";
  std::size_t undecided = 0, incomparable = 0;
  for (std::size_t i = 0; i < data.runs.size(); ++i) {
    std::size_t compared = 0, reproduced = 0;
    for (const Claim& claim : claims) {
      const ClaimVerdict verdict = claim.here[i].verdict;
      reproduced += verdict == ClaimVerdict::reproduced ? 1 : 0;
      compared += verdict == ClaimVerdict::reproduced || verdict == ClaimVerdict::different ? 1 : 0;
      undecided += verdict == ClaimVerdict::undecided ? 1 : 0;
      incomparable += verdict > ClaimVerdict::undecided ? 1 : 0;
    }
    text += (i == 0 ? "" : "; ") + std::to_string(reproduced) + " of " + std::to_string(compared) + " claims on " +
            run_name(data.runs[i]);
  }
  text += ". Not comparable (machine, recordings, subjects): " + std::to_string(incomparable);
  if (undecided > 0)
    text += "; not decided, because --quick has a fifth of the recordings: " + std::to_string(undecided);
  return text + ".";
}

}  // namespace

Result<std::string> make_paper(const PaperRequest& request, const FitControl& control) {
  if (const Status gnuplot = find_gnuplot(); !gnuplot) return gnuplot.error();
  auto folder = ReportFolder::create(request.out, request.force);
  if (!folder) return folder.error();
  const auto data = measure_paper(request.quick, control);
  if (!data) return data.error();
  const std::vector<Claim> claims = paper_claims(*data);
  const std::vector<Table> tables{claims_table(*data, claims), models_table(*data), bins_table(*data)};
  const std::string answer = summary(*data, claims);
  nlohmann::ordered_json report{{"format", "palpate-paper"}, {"version", 1}, {"answer", answer}};
  for (const Table& table : tables) report["tables"][table.name] = table_json(table);
  const Status written = write_report(*folder, request, "paper.html", tables, paper_figures(*data),
                                      {{"title", "The protocol of Hoever &amp; Harders (2009) on virtual material"},
                                       {"answer", escape_html(answer)},
                                       {"runs", escape_html(runs_words(*data))}},
                                      report, control);
  if (!written) return written.error();
  return answer;
}

}  // namespace palpate
