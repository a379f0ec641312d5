// The page: one HTML file that needs nothing else, no network either. Its words and
// style are assets/report/page.html.
//
// Thread guarantee: reads one file, otherwise pure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/report/figures/figure.h"
#include "scenes/report/data/report_data.h"
#include "scenes/report/data/table.h"

namespace palpate {

// How the report came about; in report.json and at the foot of the page.
struct ReportOrigin {
  std::string command_line;
  std::string version;
  std::string machine;   // processor and number of cores
  std::string compiler;
  std::string gnuplot;
  double seconds = 0.0;
};

// `svgs`: each figure's SVG as gnuplot wrote it, by name. Figures follow light and
// dark, fit a phone, and are not cut on A4. Errors: the template is missing or broken.
Result<std::string> make_page(const ReportData& data, const ReportOrigin& origin, const std::vector<Table>& tables,
                              const std::vector<Figure>& figures, const std::map<std::string, std::string>& svgs);

}  // namespace palpate
