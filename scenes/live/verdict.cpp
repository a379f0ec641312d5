#include "scenes/live/verdict.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <utility>

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

std::string formatted(const char* pattern, double value) {
  char text[32];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

// A model without centres is the trend alone, by whatever method it was fitted. A name that somebody gave stays.
std::string spoken_name(const ModelInfo& info) {
  const bool named_by_method = info.method != "position" && info.name.rfind(info.method, 0) == 0;
  return info.centres == 0 && named_by_method ? "trend" : info.name;
}

std::string listed(const std::vector<std::size_t>& slots, const SessionModels& models, const std::string& chosen) {
  std::vector<std::string> spoken{chosen};
  std::string names;
  for (const std::size_t slot : slots) {
    const std::string name = spoken_name(models.info(slot));
    if (std::find(spoken.begin(), spoken.end(), name) != spoken.end()) continue;
    spoken.push_back(name);
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

}  // namespace

std::string tick_share(double tick_ns) {
  const double percent = 100.0 * tick_ns / kTick_ns;
  return formatted(percent < 1.0 ? "%.1g %%" : "%.2g %%", percent);
}

Verdict judge(const std::vector<const EvaluatedSlot*>& evaluated, const SessionModels& models,
              const std::string& reference_name) {
  std::vector<Candidate> candidates;
  for (const EvaluatedSlot* one : evaluated)
    candidates.push_back({one->unit_errors.p99_error_over_jnd, one->unit_errors.unit_p99, one->tick});
  const Ranking ranking = rank(candidates);
  Verdict verdict;
  const EvaluatedSlot& chosen = *evaluated[ranking.recommended];
  verdict.chosen = chosen.slot;
  verdict.noticeable = chosen.unit_errors.p99_error_over_jnd > 1.0;
  std::vector<std::size_t> as_good, noticed;
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const bool tied = std::find(ranking.qualified.begin(), ranking.qualified.end(), i) != ranking.qualified.end();
    if (tied) verdict.tied.push_back(evaluated[i]->slot);
    if (i == ranking.recommended) continue;
    if (tied) as_good.push_back(evaluated[i]->slot);
    if (!tied && evaluated[i]->unit_errors.p99_error_over_jnd > 1.0) noticed.push_back(evaluated[i]->slot);
  }
  const ModelInfo& info = models.info(chosen.slot);
  const std::string from = reference_name.empty() ? "" : " from " + reference_name;
  const std::string name = spoken_name(info);
  verdict.headline =
      name +
      (verdict.noticeable ? ": best here, but you can feel the difference" : ": you cannot feel the difference") +
      from + "; uses " + tick_share(info.tick_ns()) + " of the time there is";
  if (verdict.noticeable)
    verdict.detail = "Its error is at most " + formatted("%.1f", chosen.unit_errors.p99_error_over_jnd) +
                     " times what a hand can feel, 99 % of the time. ";
  if (const std::string names = listed(as_good, models, name); !names.empty())
    verdict.detail += "As good, no faster: " + names + ". ";
  if (const std::string names = listed(noticed, models, name); !names.empty())
    verdict.detail += "You can feel the difference of " + names + ".";
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
      for (const Asked& one : asked) evaluated.push_back({one.slot, one.tick, one.errors.unit_errors()});
      return evaluated;
    });
  } catch (const std::system_error&) {
    // Without a thread, a later frame tries again.
  }
}

}  // namespace palpate
