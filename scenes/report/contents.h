// The tables of the report and its figures with captions.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/report/measure.h"
#include "scenes/report/publish.h"

namespace palpate {

// The first table of the page, which the terminal shows too: the models of headline_models.
Table headline_table(const ReportData& data);

// All numbers of a report: the tables models, recordings, force_bins, features and times.
std::vector<Table> make_tables(const ReportData& data);

// The curves of the test for the script of the page, as JSON: the models with their largest errors in words, the plots
// of the dots of speed_error, and the rows, thinned by minima and maxima.
std::string curves_json(const ReportData& data);

// Error over time, the worst stretch, and the error by force.
std::vector<Figure> make_figures(const ReportData& data);

}  // namespace palpate
