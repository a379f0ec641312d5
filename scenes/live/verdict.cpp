#include "scenes/live/verdict.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "engine/base/text.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/live/comparison.h"
#include "scenes/live/session_models.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

constexpr double kTick_ns = 1e6;
// The interval between two evaluations, and its share of the contact so far: a few more samples change little.
constexpr double kInterval_s = 2.0;
constexpr double kMoreContact = 0.1;

// A model without centres is the trend alone, by whatever method it was fitted. A name that somebody gave stays.
bool is_trend(const ModelInfo& info) {
  return info.centres == 0 && info.method != "position" && info.name.rfind(info.method, 0) == 0;
}

// Whether both are the trend of the same recordings: their errors are equal.
bool are_one_trend(const EvaluatedSlot& a, const EvaluatedSlot& b, const SessionModels& models) {
  return is_trend(models.info(a.slot)) && is_trend(models.info(b.slot)) &&
         a.unit_errors.p99_error_over_jnd == b.unit_errors.p99_error_over_jnd;
}

std::string listed(const std::vector<std::size_t>& slots, const SessionModels& models) {
  std::string names;
  for (const std::size_t slot : slots) names += (names.empty() ? "" : ", ") + models.info(slot).name;
  return names;
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
  for (const EvaluatedSlot& one : evaluated) candidates.push_back({one.unit_errors, one.tick});
  const Ranking ranking = rank(candidates);
  Verdict verdict;
  const std::size_t best = recommended(evaluated, models, ranking.recommended);
  const EvaluatedSlot& chosen = evaluated[best];
  verdict.chosen = chosen.slot;
  verdict.noticeable = chosen.p99_error_over_jnd > 1.0;
  std::vector<std::size_t> as_good, noticed;
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const EvaluatedSlot& one = evaluated[i];
    if (i == best || are_one_trend(one, chosen, models)) continue;
    if (ranking.qualified[i]) {
      as_good.push_back(one.slot);
    } else if (one.p99_error_over_jnd > 1.0) {
      noticed.push_back(one.slot);
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
  if (!as_good.empty()) verdict.detail += "Equally good, but not faster: " + listed(as_good, models) + ". ";
  if (!noticed.empty()) verdict.detail += "You can feel the difference of " + listed(noticed, models) + ".";
  return verdict;
}

void BackgroundEvaluation::reset() {
  evaluated_.clear();
  discard_ = running_.valid();
  next_s_ = 0.0;
}

void BackgroundEvaluation::update(const SessionModels& models, const Comparison& comparison, double now_s) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    std::vector<EvaluatedSlot> made = running_.get();
    if (!std::exchange(discard_, false)) evaluated_ = std::move(made);
  }
  if (now_s < next_s_ || comparison.counted_s() < kLeastContact_s) return;
  next_s_ = now_s + std::max(kInterval_s, kMoreContact * comparison.counted_s());
  struct Asked {
    std::size_t slot;
    Timing tick;
    ModelErrors errors;
  };
  std::vector<Asked> asked;
  for (const std::size_t slot : models.ready_slots()) {
    const bool is_reference = comparison.reference() == ReferenceKind::direct && models.reference() == slot;
    if (is_reference || models.info(slot).other_material || comparison.figures(slot).errors.samples == 0) continue;
    asked.push_back({slot, models.info(slot).tick, comparison.model_errors(slot)});
  }
  if (asked.empty()) return;
  try {
    running_ = std::async(std::launch::async, [asked = std::move(asked)] {
      lower_thread_priority();
      std::vector<EvaluatedSlot> evaluated;
      for (const Asked& one : asked) evaluated.push_back({one.slot, one.tick, one.errors.unit_errors(), 0.0});
      return evaluated;
    });
  } catch (const std::system_error&) {
    // Without a thread, a later frame tries again.
  }
}

}  // namespace palpate
