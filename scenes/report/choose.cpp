#include "scenes/evaluation/ranking.h"
#include "scenes/report/measure.h"

namespace palpate {
namespace {

// Whether this is the size of its method that the headline shows.
bool is_headline(const ModelResult& one) { return one.model && one.plan.main; }

}  // namespace

Choice choose(const std::vector<ModelResult>& models) {
  Choice choice;
  bool corrected = false;
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ModelResult& one = models[i];
    corrected = corrected || (one.model && one.plan.recipe == Recipe::palpate);
    if (!is_headline(one)) continue;
    choice.candidates.push_back(i);
    candidates.push_back(candidate(one.errors, one.time));
  }
  const Ranking ranking = rank(candidates);
  choice.correction_off = !corrected;
  choice.best = choice.candidates[ranking.best];
  choice.recommended = choice.candidates[ranking.recommended];
  for (const std::size_t i : ranking.qualified) choice.qualified.push_back(choice.candidates[i]);
  return choice;
}

std::vector<std::size_t> headline_models(const ReportData& data) {
  std::vector<std::size_t> rows{0};
  for (const std::size_t i : data.choice.candidates) {
    const PlannedModel& plan = data.models[i].plan;
    if (plan.recipe != Recipe::paper || plan.request.method == &kGreedyMethod || i == data.choice.recommended)
      rows.push_back(i);
  }
  return rows;
}

}  // namespace palpate
