// The errors of one model over the samples in contact: every figure of merit, defined here
// and nowhere else, and how far it can be trusted.
//
//   within the JND   share of the samples with |model - measured| <= JND(measured)
//   99 % error       the smallest error over the JND that 99 % of the samples do not exceed
//                    (nearest rank)
//   RMS, maximum     of |model - measured|
// Neighbouring samples are alike, so whole blocks are resampled (block bootstrap): kResamples times as many
// as there are, with replacement; 95 % intervals are the middle of the results. Two models over the same
// samples are compared draw by draw, and tied when the middle 95 % of the differences hold 0 (paired).
// Where no stroke goes beyond one JND a resampling can say nothing: of n strokes at most 3/n do, at 95 %
// (the rule of three).
// A block is a stroke, from touch to release, cut after kLongestBlock_s, when a material has forgotten, or a
// tenth of its recording, since of one or two blocks a resampling says nothing. The seed is fixed: the same
// samples give the same intervals.
// Source: Efron & Tibshirani (1993), chapters 8 and 13; Kuensch (1989) for blocks;
// Hanley & Lippman-Hand (1983) for the rule of three.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/tick/jnd.h"
#include "scenes/evaluation/error_figures.h"

namespace palpate {

inline constexpr int kResamples = 1000;
inline constexpr double kLongestBlock_s = 2.0;
inline constexpr double kLongestBlockShare = 0.1;  // of a recording
// Out of contact for less is the same stroke: noise at the surface.
inline constexpr double kStrokePause_s = 0.05;

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool holds(double value) const { return low <= value && value <= high; }
};

// Without samples every figure is 0 and there are no bins; whoever shows them looks at
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

// Figures of merit and their resamplings.
struct Evidence : ErrorSummary {
  std::uint64_t strokes = 0;
  std::uint64_t blocks = 0;
  // The samples beyond one JND, and in how many strokes they lie.
  std::uint64_t beyond_samples = 0;
  std::uint64_t beyond_strokes = 0;
  // One value a resampling, in their order.
  std::vector<float> within_draws;
  std::vector<float> p99_draws;
  std::vector<float> rms_draws_N;

  Interval within_interval() const;
  Interval p99_interval() const;  // error over JND
  Interval rms_interval_N() const;
  // 95 %, one-sided.
  double p99_at_most() const;
  // At least this share of the samples within the JND, 95 %, one-sided; where no stroke goes beyond one JND
  // by the rule of three: 0 with three strokes and fewer.
  double within_at_least() const;
};

// The 99 % error of `one` less that of `other`, in JND, over the same samples.
struct PairedDifference {
  double p99 = 0.0;
  Interval interval;
  bool tied() const { return interval.holds(0.0); }
};
PairedDifference paired_difference(const Evidence& one, const Evidence& other);

// Where strokes and blocks begin; one for a recording.
class StrokeCounter {
 public:
  explicit StrokeCounter(double recording_s)
      : longest_block_s_(std::min(kLongestBlock_s, kLongestBlockShare * recording_s)) {}

  // Every row in time order. True when this row begins a block.
  bool begins_block(double time_s, bool in_contact);
  bool begins_stroke() const { return begins_stroke_; }  // of the last row asked about

 private:
  double longest_block_s_;
  double last_contact_s_ = -1e300;
  double block_begin_s_ = 0.0;
  bool in_air_ = true;  // since the last row in contact
  bool begins_stroke_ = false;
};

// Takes 4 bytes a sample, for the exact percentile.
class ModelErrors {
 public:
  explicit ModelErrors(const JndLine& jnd) : jnd_(jnd) {}

  void begin_block(bool begins_stroke);
  // One sample in contact, of the block begun last: both forces finite.
  void add(double model_N, double measured_N, bool out_of_domain);
  // Another recording behind this one.
  void append(const ModelErrors& other);

  const JndLine& jnd() const { return jnd_; }
  ErrorSummary summary() const;
  Evidence evidence() const;  // a summary with its resamplings

 private:
  struct Block {
    std::uint64_t count = 0;
    std::uint64_t within = 0;
    double squares = 0.0;
    std::uint32_t stroke = 0;
  };
  void resample(Evidence& evidence) const;

  JndLine jnd_;
  ErrorFigures figures_;
  std::vector<Block> blocks_;
  std::vector<float> ratios_;  // block by block
  std::uint32_t strokes_ = 0;
};

}  // namespace palpate
