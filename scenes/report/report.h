// The whole of `palpate report`: recordings in, a folder out.
// Thread guarantee: slow side (does I/O, starts gnuplot and threads).
#pragma once

#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/report/measure.h"
#include "scenes/report/publish.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The first table of the page, which the terminal shows too: the models of headline_models.
Table headline_table(const ReportData& data);

// The terms of the trend's dictionary: whether the regression uses each, and the cross-validated error of the trend
// with it and without it.
Table gains_table(const std::vector<PartGain>& gains);

// All numbers of a report: the tables models, recordings, force_bins, features and times.
std::vector<Table> make_tables(const ReportData& data);

// The curves of the test for the script of the page, as JSON: the models with their largest errors in words, the plots
// of the dots of speed_error, and the rows, thinned by minima and maxima.
std::string curves_json(const ReportData& data);

// Error over time, the worst stretch, and the error by force.
std::vector<Plot> make_figures(const ReportData& data);

struct ReportRequest : PageRequest {
  Scene scene;
  std::vector<PreparedRecordingPointer> train;  // empty: the virtual silicone
  std::vector<PreparedRecordingPointer> test;   // empty: see split_recordings
  PreparedRecordingPointer after{};             // the recording that the tests continue; null: none
  std::vector<std::string> test_files{};        // their paths, for a command in the answer
  bool quick = false;                           // fewer models
  double budget_ns = kBudget_ns;                // the longest tick of a model that is recommended
};

// What the terminal shows.
struct ReportAnswer {
  std::vector<std::vector<std::string>> table;  // the first table of the page; titles first
  std::string sentence;                         // the answer, one line
  std::vector<std::string> details;             // the lines below it
};

// Writes index.html, report.json, model.json (the recommended model), tables/*.csv and figures/*.{svg,png,gp} into
// `request.out`, which appears only when it is complete. Errors: gnuplot is missing; those of ReportFolder::create,
// split_recordings and measure; interrupted.
Result<ReportAnswer> make_report(const ReportRequest& request, const FitControl& control = {});

}  // namespace palpate
