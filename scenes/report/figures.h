// The report's figures as plots (scenes/plot/plot.h) with captions.
//
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/plot/plot.h"
#include "scenes/report/measure.h"

namespace palpate {

struct Figure {
  Plot plot;
  std::string caption;  // plain text
  std::string svg{};    // once it is drawn
};

Figure speed_figure(const ReportData& data);
Figure worst_figure(const ReportData& data);
Figure force_figure(const ReportData& data);

// Its method's, in the window as well.
Hue model_colour(const PlannedModel& plan);

}  // namespace palpate
