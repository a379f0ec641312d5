#include "scenes/report/data/stroke_errors.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr std::uint64_t kBootstrapSeed = 20090320;
constexpr double kOutside = 0.025;  // on either side of the interval

// The interval of the middle 95 % of `values`.
Interval middle_of(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<std::size_t>(std::floor(kOutside * last))],
          values[static_cast<std::size_t>(std::ceil((1.0 - kOutside) * last))]};
}

}  // namespace

bool StrokeCounter::begins_block(double time_s, bool in_contact) {
  begins_stroke_ = false;
  if (!in_contact) {
    in_air_ = true;
    return false;
  }
  begins_stroke_ = in_air_ && time_s - last_contact_s_ > kStrokePause_s;
  in_air_ = false;
  last_contact_s_ = time_s;
  if (!begins_stroke_ && time_s - block_begin_s_ <= longest_block_s_) return false;
  block_begin_s_ = time_s;
  return true;
}

void StrokeErrors::begin_block(bool begins_stroke) {
  if (begins_stroke || blocks_.empty()) ++strokes_;
  Block block;
  block.stroke = strokes_;
  blocks_.push_back(block);
}

void StrokeErrors::add(double model_N, double measured_N, bool out_of_domain) {
  if (blocks_.empty()) begin_block(true);
  figures_.add(model_N, measured_N, out_of_domain);
  const double error_N = std::abs(model_N - measured_N);
  const auto ratio = static_cast<float>(jnd_.error_over_jnd(model_N, measured_N));
  Block& block = blocks_.back();
  ++block.count;
  block.within += ratio <= 1.0F ? 1 : 0;
  block.squares += error_N * error_N;
  block.largest_N = std::max(block.largest_N, error_N);
  block.worst = std::max(block.worst, ratio);
  ratios_.push_back({ratio, static_cast<std::uint32_t>(blocks_.size() - 1)});
}

Evidence StrokeErrors::evidence() const {
  Evidence evidence;
  static_cast<ErrorSummary&>(evidence) = figures_.summary();
  evidence.strokes = strokes_;
  evidence.blocks = blocks_.size();
  std::set<std::uint32_t> beyond;
  for (const Block& block : blocks_) {
    if (block.within == block.count) continue;
    evidence.beyond_samples += block.count - block.within;
    beyond.insert(block.stroke);
  }
  evidence.beyond_strokes = beyond.size();
  if (evidence.samples > 0) resample(evidence);
  return evidence;
}

void StrokeErrors::resample(Evidence& evidence) const {
  std::vector<Ratio> sorted = ratios_;
  std::sort(sorted.begin(), sorted.end(), [](const Ratio& a, const Ratio& b) {
    return a.value != b.value ? a.value > b.value : a.block < b.block;
  });
  std::vector<double> rms;
  std::vector<double> largest;
  std::vector<double> within;
  std::vector<double> p99;
  std::vector<double> worst;
  RandomStream random(kBootstrapSeed, 0);
  std::vector<std::uint64_t> times(blocks_.size());
  for (int resample = 0; resample < kResamples; ++resample) {
    std::fill(times.begin(), times.end(), 0);
    for (std::size_t i = 0; i < blocks_.size(); ++i) ++times[random.index(blocks_.size())];
    std::uint64_t count = 0;
    std::uint64_t inside = 0;
    double squares = 0.0;
    double largest_N = 0.0;
    float highest = 0.0F;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (times[i] == 0) continue;
      const Block& block = blocks_[i];
      count += times[i] * block.count;
      inside += times[i] * block.within;
      squares += static_cast<double>(times[i]) * block.squares;
      largest_N = std::max(largest_N, block.largest_N);
      highest = std::max(highest, block.worst);
    }
    if (count == 0) continue;  // only blocks without samples were drawn
    // Nearest rank from above: as many samples lie above the 99th percentile as 1 % is.
    const std::uint64_t above = count - static_cast<std::uint64_t>(std::ceil(0.99 * static_cast<double>(count)));
    std::uint64_t passed = 0;
    float quantile = highest;
    for (const Ratio& ratio : sorted) {
      passed += times[ratio.block];
      if (passed <= above) continue;
      quantile = ratio.value;
      break;
    }
    const auto n = static_cast<double>(count);
    rms.push_back(std::sqrt(squares / n));
    largest.push_back(largest_N);
    within.push_back(static_cast<double>(inside) / n);
    p99.push_back(static_cast<double>(quantile));
    worst.push_back(static_cast<double>(highest));
  }
  evidence.rms_interval_N = middle_of(rms);
  evidence.max_interval_N = middle_of(largest);
  evidence.within_interval = middle_of(within);
  evidence.p99_interval = middle_of(p99);
  evidence.worst_interval = middle_of(worst);
}

}  // namespace palpate
