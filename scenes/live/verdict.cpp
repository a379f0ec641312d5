#include "scenes/live/verdict.h"

#include <algorithm>

#include "engine/base/text.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/live/session_models.h"

namespace palpate {
namespace {

constexpr double kTick_ns = 1e6;

// Whether a model is the trend alone: it has no centres, and the user has not renamed it. Any method can fit it.
bool is_trend(const ModelInfo& info) {
  return info.centres == 0 && info.method != "position" && info.name.rfind(info.method, 0) == 0;
}

// Whether a model of another method is the trend in slot `trend`, of the same recordings: their errors are equal.
bool copies(const EvaluatedSlot& one, const EvaluatedSlot& trend, const SessionModels& models) {
  return models.info(trend.slot).method == "trend" && models.info(one.slot).method != "trend" &&
         is_trend(models.info(one.slot)) &&
         one.unit_errors->p99_error_over_jnd == trend.unit_errors->p99_error_over_jnd;
}

}  // namespace

std::string tick_share(double tick_ns) {
  const double percent = 100.0 * tick_ns / kTick_ns;
  return general(percent, percent < 1.0 ? 1 : 2) + " %";
}

Verdict judge(std::vector<EvaluatedSlot> evaluated, const SessionModels& models, const std::string& reference_name) {
  // A correction without centres adds nothing: the trend stands for it.
  std::erase_if(evaluated, [&, all = evaluated](const EvaluatedSlot& one) {
    return std::ranges::any_of(all, [&](const EvaluatedSlot& other) { return copies(one, other, models); });
  });
  std::vector<Candidate> candidates;
  for (const EvaluatedSlot& one : evaluated) {
    const ModelInfo& info = models.info(one.slot);
    candidates.push_back({info.method, one.unit_errors->p99_error_over_jnd, info.tick_ns()});
  }
  const Ranking ranking = rank(candidates);
  Verdict verdict;
  const EvaluatedSlot& chosen = evaluated[ranking.recommended];
  verdict.chosen = chosen.slot;
  verdict.noticeable = chosen.p99_error_over_jnd > 1.0;
  std::vector<std::string> as_good, noticed;  // names
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const EvaluatedSlot& one = evaluated[i];
    if (i == ranking.recommended) continue;
    if (ranking.near_best[i]) {
      as_good.push_back(models.info(one.slot).name);
    } else if (one.p99_error_over_jnd > 1.0) {
      noticed.push_back(models.info(one.slot).name);
    }
  }
  const ModelInfo& info = models.info(chosen.slot);
  const std::string from = reference_name.empty() ? "" : " from " + reference_name;
  verdict.headline =
      info.name +
      (verdict.noticeable ? ": best here, but you can feel the difference" : ": you cannot feel the difference") +
      from + "; uses " + tick_share(info.tick_ns()) + " of the 1 ms of a tick";
  if (verdict.noticeable)
    verdict.detail =
        "99 % of its errors are at most " + fixed(chosen.p99_error_over_jnd, 1) + " times what a hand can feel. ";
  if (!as_good.empty()) verdict.detail += "Equally good, but not faster: " + joined(as_good) + ". ";
  if (!noticed.empty()) verdict.detail += "You can feel the difference of " + joined(noticed) + ".";
  return verdict;
}

}  // namespace palpate
