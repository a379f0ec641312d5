// Which models a report fits.
//
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/fit/fit.h"

namespace palpate {

// nothing   a model that always says 0 N
// trend     the viscoelastic trend alone, no centres
// paper     the recipe of Hoever & Harders (2009), with two times fitted to the recordings
// palpate   this program's defaults
enum class Recipe { nothing, trend, paper, palpate };

struct PlannedModel {
  std::string name;  // "greedy-100", "2009-greedy-100"
  Recipe recipe = Recipe::palpate;
  MethodRequest request;
  bool main = false;  // one a recipe and method: drawn against force, and a candidate
};

// No force first, then the main models, a method's base before it. `features`: of the scene.
std::vector<PlannedModel> make_plan(bool quick, std::size_t features);

}  // namespace palpate
