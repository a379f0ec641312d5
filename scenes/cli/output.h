// What several verbs print alike.
// Thread guarantee: slow side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate::cli {

// As one object or array on stdout. A path need not be UTF-8; what cannot be said is replaced.
void print_json(const nlohmann::ordered_json& json);

// Rows of cells in columns as wide as their widest cell, to the right from the second on if
// `numbers`, else to the left.
void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers);

// `out` must not be a file that is read, --force or not. `option`: what named it.
Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option);

}  // namespace palpate::cli
