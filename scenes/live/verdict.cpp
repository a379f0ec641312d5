#include "scenes/live/verdict.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/base/text.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate {
namespace {

constexpr double kTick_ns = 1e6;
// Medians of six rounds of the same model differ by a few percent.
constexpr double kEqualTime = 0.1;

bool is_noticeable(const JudgedModel& one) { return one.p99_error_over_jnd > 1.0; }

std::string quality(const JudgedModel& one, const std::string& reference) {
  if (!reference.empty()) return " differs from " + reference + " by " + jnd_text(one.p99_error_over_jnd) + " JND";
  if (!is_noticeable(one)) return " feels like the block";
  return " differs by " + jnd_text(one.p99_error_over_jnd) + " of what a hand can notice";
}

}  // namespace

std::string jnd_text(double error_over_jnd) {
  return fixed(error_over_jnd, error_over_jnd < 0.995 ? 2 : error_over_jnd < 9.95 ? 1 : 0);
}

std::string tick_share(double tick_ns) {
  const double percent = 100.0 * tick_ns / kTick_ns;
  return general(percent, percent < 1.0 ? 1 : 2) + " %";
}

std::string time_words(const Timing& one, const Timing& other) {
  const double ratio = one.median_ns / other.median_ns;
  // Other programs only add time, so that on a busy machine the least of the rounds are nearer to the truth.
  const double least = one.low_ns / other.low_ns;
  if (std::min(std::abs(ratio - 1.0), std::abs(least - 1.0)) <= kEqualTime)
    return "as fast (" + fixed(one.median_ns, 0) + " ns)";
  return "in " + general(ratio, 2) + (ratio < 1.0 ? " of the time (" : " times the time (") + fixed(one.median_ns, 0) +
         " against " + fixed(other.median_ns, 0) + " ns)";
}

Verdict judge(const std::vector<JudgedModel>& judged, const std::string& reference) {
  std::vector<Candidate> candidates;
  for (const JudgedModel& one : judged)
    candidates.push_back({one.within_jnd, one.p99_error_over_jnd, one.tick.median_ns, one.strokes});
  const JudgedModel& chosen = judged[rank(candidates).recommended];
  Verdict verdict;
  verdict.chosen = chosen.slot;
  verdict.noticeable = is_noticeable(chosen);
  verdict.headline = chosen.name + quality(chosen, reference) + ".";
  const JudgedModel& rival = *std::ranges::min_element(judged, {}, [&](const JudgedModel& one) {
    return std::tuple(&one == &chosen, one.paper == chosen.paper, one.p99_error_over_jnd);
  });
  if (&rival == &chosen) {
    verdict.headline += " It uses " + tick_share(chosen.tick.median_ns) + " of the 1 ms of a tick.";
    return verdict;
  }
  const bool both = reference.empty() && !is_noticeable(chosen) && !is_noticeable(rival);
  verdict.headline += (both ? " So does " + rival.name : " " + rival.name + quality(rival, reference)) + ", " +
                      time_words(rival.tick, chosen.tick) + ".";
  return verdict;
}

}  // namespace palpate
