// The panel's plot of error against time: one dot for each model, with the columns "99 % error / JND" and "ns" of the
// table. Thread guarantee: the window's thread, inside a frame; speed_ranges is a pure function.
#pragma once

#include "rendering/panels/window_view.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui_style.h"

namespace palpate {

// Decimal logarithms of the time of a tick, ns, and of the error over the JND: the ranges that show all dots, their
// intervals and paths, and the JND. Without a model with errors the ranges are those of usual models.
struct SpeedRanges {
  Range time;
  Range error;
};
SpeedRanges speed_ranges(const ModelsView& models);

void draw_speed(const ModelsView& models, const UiStyle& style, float height);

}  // namespace palpate
