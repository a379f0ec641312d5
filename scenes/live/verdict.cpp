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

std::string difference(const JudgedModel& one, const std::string& reference) {
  return one.name + " differs from " + reference + " by " + jnd_text(one.p99_error_over_jnd) + " JND";
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
  if (std::min(std::abs(ratio - 1.0), std::abs(least - 1.0)) <= kEqualTime) return "as fast";
  return ratio < 1.0 ? general(1.0 / ratio, 2) + " times faster" : general(ratio, 2) + " times slower";
}

Verdict judge(const std::vector<JudgedModel>& judged, const std::string& reference) {
  const Ranking ranking = rank({judged.begin(), judged.end()});
  const JudgedModel& chosen = judged[ranking.recommended];
  Verdict verdict;
  verdict.chosen = chosen.slot;
  verdict.headline = reference.empty() ? recommendation(chosen.name, chosen) : difference(chosen, reference) + ".";
  const auto lowest = std::ranges::min_element(judged, {}, &JudgedModel::p99_error_over_jnd) - judged.begin();
  if (const auto at = static_cast<std::size_t>(lowest); at != ranking.recommended && reference.empty())
    verdict.detail = " " + judged[at].name + " has a lower 99 % error, " +
                     (ranking.as_good[at] ? "by too little to count, and is slower." : "but a smaller share.");
  const JudgedModel& rival = *std::ranges::min_element(judged, {}, [&](const JudgedModel& one) {
    return std::tuple(&one == &chosen, one.paper == chosen.paper, one.p99_error_over_jnd);
  });
  if (&rival == &chosen) return verdict;
  verdict.headline +=
      " " + (reference.empty() ? rival.name + ": " + share_text(rival.within_jnd) : difference(rival, reference)) +
      ", " + time_words(rival.tick, chosen.tick) + ".";
  return verdict;
}

}  // namespace palpate
