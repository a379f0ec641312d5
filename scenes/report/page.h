// Makes the HTML page of a report.
// Thread guarantee: pure functions; make_page reads the template in the assets.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/report/answer.h"
#include "scenes/report/figures.h"
#include "scenes/report/measure.h"
#include "scenes/report/table.h"

namespace palpate {

// `origin`: command line, version and machine; `tables`: those of make_tables; `figures`: drawn already. Errors: the
// template is missing, or has an unknown key.
Result<std::string> make_page(const ReportData& data, const Sentence& answer, const std::string& origin,
                              const std::vector<Table>& tables, const std::vector<Figure>& figures);

}  // namespace palpate
