// Figures and pages of a folder: drawn, and put into a template.
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
  std::string svg{};    // once it is drawn
};

// Into figures/ of the folder; their svg is set. Errors: those of draw_plots.
Status draw_figures(const ReportFolder& folder, std::vector<Figure>& figures);

std::string figure_html(const Figure& figure);

// assets/report/NAME with every {{key}} replaced by its value, and {{style}} by style.css. Errors: a template is
// missing, or asks for what is not there.
Result<std::string> fill_page(const std::string& name, std::map<std::string, std::string> values);

}  // namespace palpate
