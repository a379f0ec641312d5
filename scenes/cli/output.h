// Output that several verbs have in common.
// Thread guarantee: slow side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate::cli {

// Prints to stdout. Bytes that are not UTF-8, as in paths, are replaced.
void print_json(const nlohmann::ordered_json& json);

// Prints rows of cells in aligned columns, left-aligned; with `numbers` all but the first are right-aligned.
void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers);

// Errors: `out` is one of the files that are read. `option`: the option that named it, for the message.
Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option);

}  // namespace palpate::cli
