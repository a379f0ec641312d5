// The errors of one model over the samples in contact: every figure of merit, defined here
// and nowhere else, and how far it can be trusted.
//
//   within the JND   share of the samples with |model - measured| <= JND(measured)
//   99 % error       the smallest error over the JND that 99 % of the samples do not exceed
//                    (nearest rank)
//   RMS, maximum     of |model - measured|
// Neighbouring samples are alike, so intervals come from independent units (unit_statistics.h): whole recordings
// where there are several, else strokes, from touch to release. With fewer than kLeastUnits there is none. The
// share has the standard error of a ratio; the 99 % error that of the mean of the units' own. Where no unit goes
// beyond one JND the scatter is 0, and the bound is exact: of n units at most 1 - 0.05^(1/n) do, at 95 %.
// Two models over the same samples are compared unit by unit (paired).
// Source: Cochran (1977), Sampling Techniques, 2.7 and 6.4; Clopper & Pearson (1934).
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/jnd.h"
#include "scenes/evaluation/error_figures.h"
#include "scenes/evaluation/unit_statistics.h"

namespace palpate {

// Out of contact for less is the same stroke: noise at the surface.
inline constexpr double kStrokePause_s = 0.05;

// Without samples every figure is 0 and there are no bins; callers look at
// `samples` first.
struct ErrorSummary {
  std::uint64_t samples = 0;
  double rms_error_N = 0.0;
  double max_error_N = 0.0;
  double within_jnd = 0.0;
  double p99_error_over_jnd = 0.0;
  double max_error_over_jnd = 0.0;
  std::uint64_t out_of_domain_samples = 0;
  std::vector<ForceBin> bins;  // from 0 to the largest measured force
};

// Figures of merit, and those of every unit.
struct Evidence : ErrorSummary {
  bool units_are_recordings = false;
  std::uint64_t beyond_units = 0;  // with a sample beyond one JND
  std::vector<double> unit_samples;
  std::vector<double> unit_within;  // samples within the JND
  std::vector<double> unit_p99;     // 99 % error over the JND

  std::size_t units() const { return unit_samples.size(); }
  bool has_intervals() const { return units() >= kLeastUnits; }
  // Not known with too few units.
  Interval p99_interval() const;
  double p99_at_most() const;      // 95 %, one-sided
  double within_at_least() const;  // of the samples; of the units where none goes beyond
};

// The 99 % error of one model less that of another, in JND, over the same samples.
struct PairedDifference {
  double p99 = 0.0;
  Interval interval;          // 95 %; not known with too few units
  double at_most = kUnknown;  // 95 %, one-sided
};
PairedDifference paired_difference(double one_p99, const std::vector<double>& one_units, double other_p99,
                                   const std::vector<double>& other_units);
inline PairedDifference paired_difference(const Evidence& one, const Evidence& other) {
  return paired_difference(one.p99_error_over_jnd, one.unit_p99, other.p99_error_over_jnd, other.unit_p99);
}

// Where strokes begin; one for a recording.
class StrokeCounter {
 public:
  // Every row in time order. True when this row begins a stroke.
  bool begins_stroke(double time_s, bool in_contact);

 private:
  double last_contact_s_ = -1e300;
  bool in_air_ = true;  // since the last row in contact
};

// Takes 4 bytes a sample, for the exact percentile.
class ModelErrors {
 public:
  explicit ModelErrors(const JndLine& jnd) : jnd_(jnd) {}

  void begin_stroke() { strokes_.push_back(ratios_.size()); }
  // One sample in contact, of the stroke begun last: both forces finite.
  void add(double model_N, double measured_N, bool out_of_domain);
  // Another recording after this one.
  void append(const ModelErrors& other);

  ErrorSummary summary() const;
  Evidence evidence() const;  // a summary with its units
  // The same error at every sample.
  bool equals(const ModelErrors& other) const { return ratios_ == other.ratios_; }

 private:
  JndLine jnd_;
  ErrorFigures figures_;
  std::vector<float> ratios_;
  // Where each begins in `ratios_`.
  std::vector<std::size_t> strokes_;
  std::vector<std::size_t> recordings_;
};

}  // namespace palpate
