// Errors stroke by stroke, and how far their figures can be trusted: neighbouring
// samples are alike, so what is resampled is whole strokes.
//
//   Block bootstrap: kResamples times as many blocks as there are, drawn with
//   replacement; every figure of merit over the drawn blocks; the interval holds
//   the middle 95 % of the results.
// A block is a stroke, from touch to release; one that lasts longer than
// kLongestBlock_s is cut, since after that long a material has forgotten, and one longer
// than a tenth of its recording, since of one or two blocks a resampling says nothing. The seed is
// fixed, so the same samples give the same intervals.
// Source: Efron & Tibshirani (1993), chapters 8 and 13; Kuensch (1989) for blocks.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/tick/evaluation.h"

namespace palpate {

inline constexpr int kResamples = 1000;
inline constexpr double kLongestBlock_s = 2.0;
inline constexpr double kLongestBlockShare = 0.1;  // of a recording
// Out of contact for less is the same stroke: noise at the surface.
inline constexpr double kStrokePause_s = 0.05;
// With fewer strokes the intervals are too narrow to be believed.
inline constexpr std::uint64_t kFewStrokes = 8;

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool overlaps(const Interval& other) const { return low <= other.high && other.low <= high; }
};

// Figures of merit with their 95 % intervals.
struct Evidence : ErrorSummary {
  Interval rms_interval_N;
  Interval max_interval_N;
  Interval within_interval;
  Interval p99_interval;  // error over JND
  Interval worst_interval;  // likewise
  std::uint64_t strokes = 0;
  std::uint64_t blocks = 0;
  // The samples beyond one JND, and in how many strokes they lie.
  std::uint64_t beyond_samples = 0;
  std::uint64_t beyond_strokes = 0;
};

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

// Takes 8 bytes a sample.
class StrokeErrors {
 public:
  explicit StrokeErrors(const JndLine& jnd) : jnd_(jnd), figures_(jnd) {}

  void begin_block(bool begins_stroke);
  // One sample in contact, of the block begun last: both forces finite.
  void add(double model_N, double measured_N, bool out_of_domain);

  Evidence evidence() const;

 private:
  struct Block {
    std::uint64_t count = 0;
    std::uint64_t within = 0;
    double squares = 0.0;
    double largest_N = 0.0;
    float worst = 0.0F;
    std::uint32_t stroke = 0;
  };
  struct Ratio {
    float value;
    std::uint32_t block;
  };

  void resample(Evidence& evidence) const;

  JndLine jnd_;
  ErrorStatistics figures_;
  std::vector<Block> blocks_;
  std::vector<Ratio> ratios_;
  std::uint32_t strokes_ = 0;
};

}  // namespace palpate
