#include "scenes/live/ab_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace palpate {
namespace {

const TrialModel* find_trial_model(const std::vector<TrialModel>& models, const std::string& method) {
  const auto found =
      std::find_if(models.begin(), models.end(), [&](const TrialModel& model) { return model.method == method; });
  return found != models.end() ? &*found : nullptr;
}

std::string times_noticeable(double over_jnd) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f times", over_jnd);
  return text;
}

}  // namespace

bool AbTrial::begin(const std::vector<TrialModel>& ready) {
  reset();
  if (ready.size() < 2) return false;
  const TrialModel* one = find_trial_model(ready, "greedy");
  if (one == nullptr) one = find_trial_model(ready, "direct");
  if (one == nullptr) one = &ready.front();
  const TrialModel* other = draw_other(ready, *one);
  const bool swapped = random_.uniform(0.0, 1.0) < 0.5;
  pair_ = {swapped ? *other : *one, swapped ? *one : *other};
  tried_[0] = true;  // key 1 begins
  state_ = State::exploring;
  return true;
}

const TrialModel* AbTrial::draw_other(const std::vector<TrialModel>& ready, const TrialModel& one) {
  const bool alike = random_.uniform(0.0, 1.0) < 0.5;
  const TrialModel* drawn = find_trial_model(ready, alike ? "direct" : "position");
  if (drawn != nullptr && drawn != &one) return drawn;
  std::vector<const TrialModel*> rest;
  for (const TrialModel& model : ready) {
    if (&model != &one) rest.push_back(&model);
  }
  const double place = random_.uniform(0.0, static_cast<double>(rest.size()));
  return rest[std::min(static_cast<std::size_t>(place), rest.size() - 1)];
}

void AbTrial::reset() {
  state_ = State::idle;
  pair_ = {};
  tried_ = {};
  pressed_ = 1;
  different_ = false;
  largest_ = 0.0;
  samples_ = 0;
  counts_.fill(0);
}

void AbTrial::press(int key) noexcept {
  if (state_ != State::exploring || (key != 1 && key != 2)) return;
  pressed_ = key;
  tried_[key == 2 ? 1 : 0] = true;
}

void AbTrial::update(double force_1_N, double force_2_N, bool in_contact, const JndLine& jnd) noexcept {
  if (state_ != State::exploring || !in_contact || !std::isfinite(force_1_N) || !std::isfinite(force_2_N)) return;
  const double over_jnd = std::abs(force_1_N - force_2_N) / jnd.at(0.5 * (force_1_N + force_2_N));
  largest_ = std::max(largest_, over_jnd);
  const double bin = std::min(over_jnd / kMostJnd * static_cast<double>(kBins), static_cast<double>(kBins - 1));
  ++counts_[static_cast<std::size_t>(bin)];
  ++samples_;
}

// The middle of the bin that holds the sample; no more than the largest.
double AbTrial::p95_over_jnd() const noexcept {
  if (samples_ == 0) return 0.0;
  const std::uint64_t rank = (samples_ * 95 + 99) / 100;  // rounded up, from 1
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && below + counts_[bin] < rank) below += counts_[bin++];
  return std::min(largest_, (static_cast<double>(bin) + 0.5) * kMostJnd / static_cast<double>(kBins));
}

void AbTrial::answer(bool different) noexcept {
  if (state_ != State::exploring) return;
  different_ = different;
  state_ = State::answered;
}

std::string AbTrial::verdict() const {
  if (state_ != State::answered) return {};
  const std::string which = "1 was \"" + pair_[0].name + "\" and 2 was \"" + pair_[1].name + "\"";
  if (samples_ == 0) return which + ". The block was not touched, so there was no difference to feel.";
  if (!tried_both()) return which + ". Only one of them was in the hand, so there was nothing to compare.";
  const std::string size = "; their forces differed by up to " + times_noticeable(largest_) +
                           " what a hand can notice, and 95 % of the time by less than " +
                           times_noticeable(p95_over_jnd()) + " it. ";
  const bool agrees = different_ == predicts_difference();
  const std::string expected =
      predicts_difference() ? "That should be felt, and you said they are " : "That should not be felt, and you said they are ";
  return which + size + expected + (different_ ? "different" : "the same") +
         (agrees ? ": as predicted." : ": not as predicted.");
}

}  // namespace palpate
