#include "scenes/evaluation/model_errors.h"

#include <cmath>
#include <set>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr std::uint64_t kBootstrapSeed = 20090320;
constexpr double kOutside = 0.025;  // on either side of an interval
constexpr double kOneSided = 0.05;
constexpr double kRuleOfThree = 3.0;

// The value that a share of `draws` does not exceed.
double quantile(std::vector<float> draws, double share) {
  if (draws.empty()) return 0.0;
  const double place = share * static_cast<double>(draws.size() - 1);
  const auto nth = draws.begin() + static_cast<std::ptrdiff_t>(share < 0.5 ? std::floor(place) : std::ceil(place));
  std::nth_element(draws.begin(), nth, draws.end());
  return static_cast<double>(*nth);
}

Interval middle_of(const std::vector<float>& draws) {
  return {quantile(draws, kOutside), quantile(draws, 1.0 - kOutside)};
}

// The smallest value that at least 99 % of `values` do not exceed.
double percentile_99(std::vector<float> values) {
  const std::size_t rank = (values.size() * 99 + 99) / 100;  // rounded up, from 1
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

struct Ratio {
  float value;
  std::uint32_t block;
};

}  // namespace

Interval Evidence::within_interval() const { return middle_of(within_draws); }
Interval Evidence::p99_interval() const { return middle_of(p99_draws); }
Interval Evidence::rms_interval_N() const { return middle_of(rms_draws_N); }
double Evidence::p99_at_most() const { return std::max(p99_error_over_jnd, quantile(p99_draws, 1.0 - kOneSided)); }

double Evidence::within_at_least() const {
  if (samples == 0) return 0.0;
  const double by_strokes = std::max(0.0, 1.0 - kRuleOfThree / static_cast<double>(strokes));
  return beyond_samples == 0 ? by_strokes : quantile(within_draws, kOneSided);
}

PairedDifference paired_difference(const Evidence& one, const Evidence& other) {
  PairedDifference result;
  result.p99 = one.p99_error_over_jnd - other.p99_error_over_jnd;
  std::vector<float> differences;
  for (std::size_t i = 0; i < std::min(one.p99_draws.size(), other.p99_draws.size()); ++i) {
    differences.push_back(one.p99_draws[i] - other.p99_draws[i]);
  }
  result.interval = middle_of(differences);
  return result;
}

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

void ModelErrors::begin_block(bool begins_stroke) {
  if (begins_stroke || blocks_.empty()) ++strokes_;
  Block block;
  block.stroke = strokes_;
  blocks_.push_back(block);
}

void ModelErrors::add(double model_N, double measured_N, bool out_of_domain) {
  if (blocks_.empty()) begin_block(true);
  figures_.add(model_N, measured_N, out_of_domain, jnd_);
  const double error_N = std::abs(model_N - measured_N);
  const double ratio = jnd_.error_over_jnd(model_N, measured_N);
  Block& block = blocks_.back();
  ++block.count;
  block.within += ratio <= 1.0 ? 1 : 0;
  block.squares += error_N * error_N;
  ratios_.push_back(static_cast<float>(ratio));
}

void ModelErrors::append(const ModelErrors& other) {
  figures_.add(other.figures_);
  for (Block block : other.blocks_) {
    block.stroke += strokes_;
    blocks_.push_back(block);
  }
  strokes_ += other.strokes_;
  ratios_.insert(ratios_.end(), other.ratios_.begin(), other.ratios_.end());
}

ErrorSummary ModelErrors::summary() const {
  ErrorSummary summary;
  summary.samples = figures_.samples();
  if (summary.samples == 0) return summary;
  summary.rms_error_N = figures_.rms_error_N();
  summary.max_error_N = figures_.max_error_N();
  summary.within_jnd = figures_.within_jnd();
  summary.p99_error_over_jnd = percentile_99(ratios_);
  summary.max_error_over_jnd = figures_.max_error_over_jnd();
  summary.out_of_domain_samples = figures_.out_of_domain_samples();
  summary.bins = figures_.bins(jnd_);
  return summary;
}

Evidence ModelErrors::evidence() const {
  Evidence evidence;
  static_cast<ErrorSummary&>(evidence) = summary();
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

void ModelErrors::resample(Evidence& evidence) const {
  std::vector<Ratio> sorted;
  sorted.reserve(ratios_.size());
  std::size_t next = 0;
  for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
    for (std::uint64_t i = 0; i < blocks_[b].count; ++i) sorted.push_back({ratios_[next++], b});
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const Ratio& a, const Ratio& b) { return a.value != b.value ? a.value > b.value : a.block < b.block; });
  RandomStream random(kBootstrapSeed, 0);
  std::vector<std::uint64_t> times(blocks_.size());
  for (int resample = 0; resample < kResamples; ++resample) {
    std::fill(times.begin(), times.end(), 0);
    for (std::size_t i = 0; i < blocks_.size(); ++i) ++times[random.index(blocks_.size())];
    std::uint64_t count = 0;
    std::uint64_t inside = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      count += times[i] * blocks_[i].count;
      inside += times[i] * blocks_[i].within;
      squares += static_cast<double>(times[i]) * blocks_[i].squares;
    }
    if (count == 0) continue;  // only blocks without samples were drawn, as of every other model
    // Nearest rank from above: as many samples lie above the 99th percentile as 1 % is.
    const std::uint64_t above = count - (count * 99 + 99) / 100;
    std::uint64_t passed = 0;
    float p99 = 0.0F;
    for (const Ratio& ratio : sorted) {
      passed += times[ratio.block];
      if (passed <= above) continue;
      p99 = ratio.value;
      break;
    }
    const auto n = static_cast<double>(count);
    evidence.rms_draws_N.push_back(static_cast<float>(std::sqrt(squares / n)));
    evidence.within_draws.push_back(static_cast<float>(static_cast<double>(inside) / n));
    evidence.p99_draws.push_back(p99);
  }
}

}  // namespace palpate
