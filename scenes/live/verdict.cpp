#include "scenes/live/verdict.h"

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

// Whether both are the trend of the same recordings: their errors are equal.
bool are_one_trend(const EvaluatedSlot& a, const EvaluatedSlot& b, const SessionModels& models) {
  return is_trend(models.info(a.slot)) && is_trend(models.info(b.slot)) &&
         a.unit_errors->p99_error_over_jnd == b.unit_errors->p99_error_over_jnd;
}

// The recommended model; of several that are one trend, the one with its name.
std::size_t recommended(const std::vector<EvaluatedSlot>& evaluated, const SessionModels& models,
                        std::size_t ranked_first) {
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    if (models.info(evaluated[i].slot).method == "trend" &&
        are_one_trend(evaluated[i], evaluated[ranked_first], models))
      return i;
  }
  return ranked_first;
}

}  // namespace

std::string tick_share(double tick_ns) {
  const double percent = 100.0 * tick_ns / kTick_ns;
  return general(percent, percent < 1.0 ? 1 : 2) + " %";
}

Verdict judge(const std::vector<EvaluatedSlot>& evaluated, const SessionModels& models,
              const std::string& reference_name) {
  std::vector<Candidate> candidates;
  for (const EvaluatedSlot& one : evaluated) candidates.push_back({*one.unit_errors, models.info(one.slot).tick});
  const Ranking ranking = rank(candidates);
  Verdict verdict;
  const std::size_t best = recommended(evaluated, models, ranking.recommended);
  const EvaluatedSlot& chosen = evaluated[best];
  verdict.chosen = chosen.slot;
  verdict.noticeable = chosen.p99_error_over_jnd > 1.0;
  std::vector<std::string> as_good, noticed;  // names
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const EvaluatedSlot& one = evaluated[i];
    if (i == best || are_one_trend(one, chosen, models)) continue;
    if (ranking.qualified[i]) {
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
