// The models that a report fits.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/scene/recipe_fits.h"

namespace palpate {

struct PlannedModel {
  std::string name;
  Recipe recipe = Recipe::palpate;
  MethodRequest request;
  bool main = false;  // has the default size of its recipe and method, so that it is a candidate of the ranking

  // Whether this is greedy by the recipe of 2009, the method that the paper recommends.
  bool is_greedy_2009() const { return recipe == Recipe::paper && request.method == &kGreedyMethod; }
  // Whether this is the viscoelastic trend and a correction by this program's defaults.
  bool is_corrected() const { return recipe == Recipe::palpate && request.method != &kTrendMethod; }
};

// No force first, then the main models, then other sizes. A method that starts from another method's fit (its base)
// follows it. `features`: number of the scene's features.
std::vector<PlannedModel> make_plan(bool quick, std::size_t features);

}  // namespace palpate
