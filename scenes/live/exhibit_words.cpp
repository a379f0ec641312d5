#include "scenes/live/exhibit_words.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

void replace(std::string& text, std::string_view sign, const std::string& by) {
  if (const std::size_t at = text.find(sign); at != std::string::npos) text.replace(at, sign.size(), by);
}

}  // namespace

Result<ExhibitWords> ExhibitWords::parse(std::string_view text, const std::string& path) {
  const auto document = parse_json(text, path, 1, {});
  if (!document) return document.error();
  JsonFields fields(text, path, "");
  ExhibitWords words;
  for (const auto& [key, value] : document->items()) words.texts_[key] = fields.text({&*document, ""}, key.c_str());
  if (const auto error = fields.error()) return *error;
  return words;
}

std::string ExhibitWords::operator()(const std::string& key, const std::string& one, const std::string& two) const {
  const auto found = texts_.find(key);
  if (found == texts_.end()) return key;
  std::string text = found->second;
  replace(text, "%1", one);
  replace(text, "%2", two);
  return text;
}

Result<std::vector<ExhibitWords>> read_exhibit_words(const std::string& folder) {
  std::vector<ExhibitWords> languages;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.path().extension() != ".json") continue;
    const auto text = read_whole_file(entry.path().string());
    if (!text) return Error{"cannot read " + entry.path().string()};
    auto words = ExhibitWords::parse(*text, entry.path().string());
    if (!words) return words.error();
    languages.push_back(std::move(*words));
  }
  if (languages.empty()) return Error{"found no language in " + folder + ", expected at least one .json file"};
  std::ranges::sort(languages, {}, [](const ExhibitWords& words) { return words("order"); });
  return languages;
}

ExhibitTally read_tally(const std::string& path) {
  ExhibitTally tally;
  std::istringstream file(read_whole_file(path).value_or(""));
  if (!(file >> tally.answers >> tally.as_expected) || tally.as_expected > tally.answers) return {};
  return tally;
}

Status write_tally(const std::string& path, const ExhibitTally& tally) {
  return write_file_atomically(path, std::to_string(tally.answers) + " " + std::to_string(tally.as_expected) + "\n",
                               true);
}

}  // namespace palpate
