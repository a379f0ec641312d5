// Which models a report fits.
//
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/report/data/report_data.h"

namespace palpate {

// Which of the two recipes, and what differs from the defaults of Palpate's. The kernel
// is that of both.
struct ReportRecipe {
  bool paper = true;
  bool palpate = true;
  Reduction reduction = Reduction::coverage;
  Weighting weighting = Weighting::jnd;
  KernelKind kernel = KernelKind::cubic;
  FeatureChoice choice = FeatureChoice::automatic;
  FeatureList list;                // when given
  std::string features = "auto";  // the same in words
};

struct ReportPlan {
  bool quick = false;
  ReportRecipe recipe;
  std::vector<PlannedModel> models;    // the main ones first, a method's base before it
  std::vector<PlannedModel> repeated;  // once per seed
  std::vector<std::uint64_t> seeds;    // at least ten
  // For fit time against sites: the most (or all that there are), halved again and again.
  std::size_t most_sites = 0;
  int site_halvings = 0;
  int left_out_folds = 2;  // of the training, for the recommendation
  int most_dimensions = 0;
  std::size_t dimension_sites = 0;  // at most, for cost against the dimension
};

// `features`: of the scene, 1 to 8.
ReportPlan make_plan(bool quick, std::size_t features, const ReportRecipe& recipe = {});

// The ladder's representative of the rungs that have several methods: the last of the
// table. Null when the plan has none on that rung.
const PlannedModel* representative(const ReportPlan& plan, Rung rung);

// Whether a model is cheap enough in fitting to be fitted again for the recommendation.
bool is_candidate(const PlannedModel& model, bool quick);

}  // namespace palpate
