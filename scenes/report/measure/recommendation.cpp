#include "scenes/report/measure/recommendation.h"

#include <algorithm>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kPoorShare = 0.9;  // within the JND

std::string percent(double share) { return fixed(100.0 * share, 2) + " %"; }

bool better(const Evidence& one, const Evidence& other) {
  if (one.p99_error_over_jnd != other.p99_error_over_jnd) return one.p99_error_over_jnd < other.p99_error_over_jnd;
  return one.rms_error_N < other.rms_error_N;
}

struct Candidate {
  const ModelResult* model;
  const Evidence* evidence;  // what it is chosen by
};

// Those that pass the 99.9 %, or all, when none does.
std::vector<Candidate> passing(const std::vector<ModelResult>& models, bool left_out) {
  std::vector<Candidate> all;
  std::vector<Candidate> good;
  for (const ModelResult& model : models) {
    const Evidence& evidence = left_out ? model.left_out : model.pooled;
    if (evidence.samples == 0 || model.plan.rung == Rung::no_force) continue;
    all.push_back({&model, &evidence});
    if (evidence.within_jnd >= kGoodShare) good.push_back(all.back());
  }
  return good.empty() ? all : good;
}

std::string test_words(const ModelResult& model) {
  return percent(model.pooled.within_jnd) + " of the test within the JND";
}

// What the choice came to on the test, and who is recommended after it.
void confirm(Recommendation& result, const std::vector<Candidate>& ranked, const std::vector<ModelResult>& models) {
  const ModelResult& chosen = *ranked.front().model;
  const bool passes = chosen.pooled.within_jnd >= kGoodShare;
  const bool any_passes = std::any_of(models.begin(), models.end(), [](const ModelResult& model) {
    return model.plan.rung != Rung::no_force && model.pooled.within_jnd >= kGoodShare;
  });
  if (passes || !any_passes) {
    result.recommended = result.chosen;
    result.reason += passes ? " Tested only then, it has " + test_words(chosen) + "."
                            : " Tested only then, it has " + test_words(chosen) +
                                  "; no model of this report reaches 99.9 %.";
    return;
  }
  const auto next = std::find_if(ranked.begin(), ranked.end(), [](const Candidate& candidate) {
    return candidate.model->pooled.within_jnd >= kGoodShare;
  });
  result.reason += " It failed its test: " + test_words(chosen) + ", where another model passes 99.9 %.";
  if (next != ranked.end()) {
    result.recommended = next->model->plan.name;
    result.reason += " Recommended is the next choice that passes, " + result.recommended + " (" +
                     test_words(*next->model) + "); the test had a say in that, so confirm it on a new recording.";
  } else {
    result.reason += " None is recommended: those that pass were not among the candidates. Record a further test.";
  }
}


}  // namespace

bool tied(const Evidence& one, const Evidence& other) { return one.p99_interval.overlaps(other.p99_interval); }

int evaluation_cost(const ModelResult& model, std::size_t features) {
  const Method& method = *model.plan.request.method;
  if (method.can_take(kTakesGrid)) return 1 << std::min<std::size_t>(features, 16);
  return model.size;
}

Recommendation recommend(const std::vector<ModelResult>& models, std::size_t features) {
  Recommendation result;
  result.left_out = std::any_of(models.begin(), models.end(),
                                [](const ModelResult& model) { return model.left_out.samples > 0; });
  std::vector<Candidate> candidates = passing(models, result.left_out);
  if (candidates.empty()) return result;
  const Candidate best = *std::min_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return better(*a.evidence, *b.evidence);
  });
  // Tied ones first, the cheapest of them first; then the others, the best first.
  std::stable_sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const bool a_tied = tied(*a.evidence, *best.evidence);
    const bool b_tied = tied(*b.evidence, *best.evidence);
    if (a_tied != b_tied) return a_tied;
    const int a_cost = evaluation_cost(*a.model, features);
    const int b_cost = evaluation_cost(*b.model, features);
    if (a_tied && a_cost != b_cost) return a_cost < b_cost;
    return better(*a.evidence, *b.evidence);
  });
  for (const Candidate& candidate : candidates) {
    if (tied(*candidate.evidence, *best.evidence)) result.tied.push_back(candidate.model->plan.name);
  }
  const Candidate& chosen = candidates.front();
  result.chosen = chosen.model->plan.name;
  const std::string where = result.left_out ? "training strokes left out of the fit" : "the test itself";
  const std::string rank =
      result.tied.size() == 1 ? "the best there"
                              : "the cheapest of " + std::to_string(result.tied.size()) + " models that are tied there" +
                                    (chosen.model == best.model ? "" : " (" + best.model->plan.name + " is the best)");
  result.reason = "Chosen on " + where + ": " + result.chosen + ", " + rank + ", with " + percent(chosen.evidence->within_jnd) + " within the JND and 99 % of the errors up to " +
                  three_digits(chosen.evidence->p99_error_over_jnd) + " JND.";
  if (chosen.evidence->within_jnd < kPoorShare) {
    result.reason += result.left_out ? " That is little: the strokes left out are unlike those that remained, so the "
                                       "choice rests on thin ground. Record more strokes to train on."
                                     : " That is little; no model of this report is good enough.";
  }
  if (!result.left_out) {
    result.recommended = result.chosen;
    result.reason += " Nothing could be left out of the training, so no test remains that had no say.";
    return result;
  }
  confirm(result, candidates, models);
  return result;
}

}  // namespace palpate
