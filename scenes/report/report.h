// The whole of `palpate report`: recordings in, a folder out.
// Thread guarantee: slow side (does I/O, starts gnuplot and threads).
#pragma once

#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "scenes/report/recordings.h"
#include "scenes/scene/scene.h"

namespace palpate {

struct ReportRequest {
  Scene scene;
  std::vector<SharedRecording> train;  // none: the virtual silicone
  std::vector<SharedRecording> test;   // none: k-fold over `train`
  bool quick = false;
  std::string out;
  bool force = false;
  std::string command_line;
  std::string version;
};

// Writes index.html, report.json, tables/*.csv and figures/*.{svg,png,gp} into
// `request.out`, which appears only when all is there. Errors: gnuplot is missing; the
// folder exists without `force`; those of split_recordings and the fits; interrupted. Returns the
// sentence of the page, plain.
Result<std::string> make_report(const ReportRequest& request, const FitControl& control = {});

}  // namespace palpate
