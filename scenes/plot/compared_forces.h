// The forces of models beside a measured force over time, as panels of a figure.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "engine/tick/jnd.h"
#include "scenes/plot/plot.h"

namespace palpate {

struct ComparedMoment {
  double time_s = 0.0, measured_N = 0.0;
  bool in_contact = false;
  std::vector<double> force_N;  // one per model
};

struct ComparedModel {
  Series curve;  // without rows
  JndLine jnd;
};

// Two panels: the forces, and below them each model's difference from the measured force in JND, in contact, with the
// band of one JND. Of many moments the one with the largest error of each group is drawn, so that a bad sample is
// visible. The first model is on top, and its curve is never cut. `moments`: at least one.
std::vector<Panel> compared_forces(const std::string& title, const std::vector<ComparedModel>& models,
                                   const std::vector<ComparedMoment>& moments);

// Merges curves that are equal, because only one of them would be visible. Areas stay.
void merge_equal(std::vector<Series>& series);

}  // namespace palpate
