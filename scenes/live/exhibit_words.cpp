#include "scenes/live/exhibit_words.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

void replace(std::string& text, std::string_view sign, const std::string& by) {
  if (const std::size_t at = text.find(sign); at != std::string::npos) text.replace(at, sign.size(), by);
}

}  // namespace

Result<ExhibitWords> ExhibitWords::parse(std::string_view text, const std::string& path) {
  ExhibitWords words;
  std::size_t number = 0;
  std::istringstream lines{std::string(text)};
  for (std::string whole; std::getline(lines, whole);) {
    std::erase(whole, '\r');
    const std::string_view line = trimmed(whole);
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::size_t sign = line.find('=');
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (sign == std::string::npos) return Error{where + "found \"" + std::string(line) + "\", expected key = text"};
    const std::string key(trimmed(line.substr(0, sign)));
    if (!words.texts_.emplace(key, trimmed(line.substr(sign + 1))).second)
      return Error{where + "found \"" + key + "\" a second time, expected each key once"};
  }
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

std::vector<std::string> ExhibitWords::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, text] : texts_) keys.push_back(key);
  return keys;
}

Result<std::vector<ExhibitWords>> read_exhibit_words(const std::string& folder) {
  std::vector<ExhibitWords> languages;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.path().extension() != ".txt") continue;
    const auto text = read_whole_file(entry.path().string());
    if (!text) return Error{"cannot read " + entry.path().string()};
    auto words = ExhibitWords::parse(*text, entry.path().string());
    if (!words) return words.error();
    languages.push_back(std::move(*words));
  }
  if (languages.empty()) return Error{"found no language in " + folder + ", expected at least one .txt file"};
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
