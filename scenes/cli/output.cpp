#include "scenes/cli/output.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace palpate::cli {

void print_json(const nlohmann::ordered_json& json) {
  std::printf("%s\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      line += (i == 0 ? "" : "  ") + (numbers && i > 0 ? blanks + row[i] : row[i] + blanks);
    }
    std::printf("%s\n", line.substr(0, line.find_last_not_of(' ') + 1).c_str());
  }
}

Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option) {
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (!std::filesystem::equivalent(out, input, missing)) continue;
    return Error{out + " is the file to read from, expected another one for " + option + "; name a new file"};
  }
  return {};
}

}  // namespace palpate::cli
