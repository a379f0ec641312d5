// The texts of the exhibit, one JSON file in assets/exhibit per language with a text for each key, and the tally of the
// visitors' answers.
// Thread guarantee: slow side; values.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

class ExhibitWords {
 public:
  // Errors: those of parse_json (a key twice); a member that is no text, as "path:line:column: ...".
  static Result<ExhibitWords> parse(std::string_view text, const std::string& path);

  // The text of a key, with %1 and %2 replaced by `one` and `two`; the key itself where it has no text.
  std::string operator()(const std::string& key, const std::string& one = "", const std::string& two = "") const;

 private:
  std::map<std::string, std::string> texts_;
};

// All languages of a folder, sorted by the text of their key "order". Errors: no file; those of `parse`.
Result<std::vector<ExhibitWords>> read_exhibit_words(const std::string& folder);

// Answers of all visitors, kept across restarts.
struct ExhibitTally {
  std::uint64_t answers = 0, as_expected = 0;
};
// Zero where the file is missing or invalid.
ExhibitTally read_tally(const std::string& path);
Status write_tally(const std::string& path, const ExhibitTally& tally);

}  // namespace palpate
