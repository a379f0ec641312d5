// The report's page from its data.
//
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

// `origin`: what made it, in words; `tables`: those of make_tables; `figures`: drawn. Errors: the template is
// missing, or asks for what is not there.
Result<std::string> make_page(const ReportData& data, const Sentence& answer, const std::string& origin,
                              const std::vector<Table>& tables, const std::vector<Figure>& figures);

}  // namespace palpate
