// The figures by topic; make_figures (figure.h) puts them in order.
//
// Thread guarantee: pure functions.
#pragma once

#include <vector>

#include "scenes/report/figures/figure.h"

namespace palpate {

std::vector<Figure> speed_figures(const ReportData& data);
Figure evidence_figure(const ReportData& data);
std::vector<Figure> force_figures(const ReportData& data);  // figures 4 to 7 of the paper
std::vector<Figure> cost_figures(const ReportData& data);   // figures 8 and 2
std::vector<Figure> data_figures(const ReportData& data);   // coverage, repeatability
Figure trace_figure(const ReportData& data);
Figure jnd_figure(const ReportData& data);                  // figure 3
Figure facts_figure(const ReportData& data);

// "x" of the least-squares line through (log x, log y), with the half width of its 95 %
// interval; NaN with fewer than three points.
struct FittedSlope {
  double slope = 0.0;
  double half_width = 0.0;
};
FittedSlope fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace palpate
