// The models that a report fits.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/fit/fit.h"

namespace palpate {

// no_force  0 N, as a baseline
// trend     the viscoelastic trend without centres
// paper     the recipe of Hoever & Harders (2009), with two relaxation times fitted to the recordings
// palpate   this program's defaults
enum class Recipe { no_force, trend, paper, palpate };

struct PlannedModel {
  std::string name;  // "greedy-100", "2009-greedy-100"
  Recipe recipe = Recipe::palpate;
  MethodRequest request;
  bool main = false;  // has the default size of its recipe and method, so that it is a candidate of the ranking

  // Whether this is greedy by the recipe of 2009, the method that the paper recommends.
  bool is_greedy_2009() const { return recipe == Recipe::paper && request.method == &kGreedyMethod; }
};

// "greedy-100": the name of a model with that number of centres; methods without centres have no number.
std::string model_name(Recipe recipe, const Method& method, int centres);

// No force first, then the main models, then other sizes. A method that starts from another method's fit (its base)
// follows it. `features`: number of the scene's features.
std::vector<PlannedModel> make_plan(bool quick, std::size_t features);

}  // namespace palpate
