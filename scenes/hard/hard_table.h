// Runs every method of the comparison on every hard case, and compares each cell with its expectation.
// Thread guarantee: slow side; fits start threads.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "scenes/hard/hard_case.h"

namespace palpate {

// The plans of the table: all methods on the measured force, the trend, and the default.
std::vector<ModelPlan> hard_plans();

struct HardCell : HardTraining::Fit {
  HardFigures figures{};
  std::string missed{};  // what the expectation does not allow; empty: as expected
};

struct HardRow {
  HardCase of;
  std::vector<HardCell> cells;  // in the order of hard_plans()
};

// What `cell` misses of an expectation; empty: nothing.
std::string missed_by(const HardCell& cell, const HardExpectation& expected);

// Errors: interrupted.
Result<std::vector<HardRow>> run_hard(const FitControl& control = {});

// "voxel, repeated sites: ..." for each missed cell.
std::vector<std::string> missed_cells(const std::vector<HardRow>& rows);
// One sentence.
std::string hard_answer(const std::vector<HardRow>& rows);

// One object for each cell, with every figure.
nlohmann::ordered_json hard_json(const std::vector<HardRow>& rows);
// "✓ 99.8": whether the cell is as expected, and the percentage within the JND, or "refused".
std::string cell_text(const HardCell& cell);

// Writes the page, its tables and report.json into the folder `out`. Errors: those of ReportFolder and write_report.
struct HardPage {
  std::string out;
  bool force = false;
  std::string origin;  // command line and version
};
Status write_hard_page(const std::vector<HardRow>& rows, const HardPage& page, const FitControl& control = {});

}  // namespace palpate
