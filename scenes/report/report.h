// The whole of `palpate report`: recordings in, a folder out.
// Thread guarantee: slow side (does I/O, starts gnuplot and threads).
#pragma once

#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "scenes/report/recordings.h"
#include "scenes/scene/scene.h"

namespace palpate {

struct ReportRequest {
  Scene scene;
  std::vector<PreparedRecordingPointer> train;  // empty: the virtual silicone
  std::vector<PreparedRecordingPointer> test;   // empty: see split_recordings
  bool quick = false;                           // fewer models
  std::string out;
  bool force = false;  // replaces an earlier report in `out`
  std::string command_line;
  std::string version;
};

// What the terminal shows.
struct ReportAnswer {
  std::vector<std::vector<std::string>> table;  // the first table of the page; titles first
  std::string sentence;                         // the recommendation
};

// Writes index.html, report.json, tables/*.csv and figures/*.{svg,png,gp} into `request.out`, which appears only when
// it is complete. Errors: gnuplot is missing; those of ReportFolder::create,
// split_recordings and measure; interrupted.
Result<ReportAnswer> make_report(const ReportRequest& request, const FitControl& control = {});

}  // namespace palpate
