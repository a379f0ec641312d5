// The figures by topic; make_figures (figure.h) puts them in order.
//
// Thread guarantee: pure functions.
#pragma once

#include <vector>

#include "scenes/report/figure.h"

namespace palpate {

std::vector<Figure> speed_figures(const ReportData& data);
std::vector<Figure> force_figures(const ReportData& data);  // figures 4 to 7 of the paper
std::vector<Figure> cost_figures(const ReportData& data);   // figures 8 and 2
std::vector<Figure> data_figures(const ReportData& data);   // trace, coverage, repeatability
Figure jnd_figure(const ReportData& data);                  // figure 3

}  // namespace palpate
