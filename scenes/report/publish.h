// Draws the figures of a report folder and fills the templates of its pages.
// Thread guarantee: slow side (does I/O, starts gnuplot).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/plot/plot.h"
#include "scenes/report/report_folder.h"

namespace palpate {

struct Figure {
  Plot plot;
  std::string caption;  // plain text
  std::string svg{};    // set by draw_figures
};

// Draws into the subfolder figures and sets `svg` of each figure. Errors: those of draw_plots and read_drawn.
Status draw_figures(const ReportFolder& folder, std::vector<Figure>& figures);

std::string figure_html(const Figure& figure);

// Returns assets/report/NAME with every {{key}} replaced by its value, and {{style}} by style.css. Errors: a template
// is missing, or has an unknown key.
Result<std::string> fill_page(const std::string& name, std::map<std::string, std::string> values);

}  // namespace palpate
