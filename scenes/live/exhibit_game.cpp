#include "scenes/live/exhibit_game.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

constexpr double kColumnOfTicks_s = 0.025;  // a longer gap between two ticks is a stall

}  // namespace

void ExhibitTrace::add(const HistoryPoint& tick, const ExhibitLineUp& line_up, std::size_t level) {
  if (began_s_ < 0.0 && !tick.in_contact) return;
  if (began_s_ < 0.0) began_s_ = tick.loop_time_s;
  seconds_ = tick.loop_time_s - began_s_;
  const auto at = static_cast<std::size_t>(seconds_ / kColumn_s);
  if (columns_.size() <= at) columns_.resize(at + 1);
  const double true_N = line_up.true_N(tick), over_jnd = line_up.over_jnd(tick, level);
  const double model_N = tick.force_N[line_up.levels[level].slot];
  if (tick.out_of_domain || !std::isfinite(true_N + model_N + over_jnd)) return;
  Column& column = columns_[at];
  const double share = 1.0 / ++column.ticks;
  column.true_N += share * (true_N - column.true_N);
  column.position_m += share * (tick.position_m - column.position_m);
  if (column.ticks == 1 || std::abs(over_jnd) > std::abs(column.over_jnd)) column.over_jnd = over_jnd;
  if (std::abs(over_jnd) <= largest_) return;
  largest_ = std::abs(over_jnd);
  largest_at_ = at;
}

ExhibitLineUp ExhibitGame::line_up_of(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force) {
  ExhibitLineUp line_up{{}, ready};
  std::vector<ExhibitModel>& models = line_up.levels;
  std::ranges::stable_sort(
      models, {}, [](const ExhibitModel& one) { return one.paper ? one.centres : std::numeric_limits<int>::max(); });
  while (models.size() > kExhibitLevels) models.erase(models.end() - 2);
  if (!models.empty() && (has_force || !has_reference)) {
    line_up.truth = models.back();
    models.pop_back();
  }
  return line_up;
}

bool ExhibitGame::begin(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force) {
  ExhibitLineUp line_up = line_up_of(ready, has_reference, has_force);
  if (line_up.levels.empty()) return false;
  line_up_ = std::move(line_up);
  rounds_.assign(line_up_.levels.size(), {});
  for (ExhibitRound& round : rounds_) round.computer_is_left = random_.index(2) == 1;
  has_force_ = has_force;
  level_ = 0;
  largest_ = {};
  begin_round();
  return true;
}

void ExhibitGame::reset() {
  state_ = State::attract;
  rounds_.clear();
  trace_ = {};
}

void ExhibitGame::begin_round() {
  trace_ = {};
  chosen_left_ = true;
  pressed_s_ = {};
  lifted_ = false;
  state_ = State::press;
}

const ExhibitModel& ExhibitGame::rendered() const noexcept {
  const bool of_truth = has_force_ && chosen_left_ != round().computer_is_left;
  return of_truth && line_up_.truth ? *line_up_.truth : computer();
}

void ExhibitGame::answer(bool left) {
  if (!can_answer()) return;
  rounds_[level_].said_left = left;
  state_ = State::reveal;
}

void ExhibitGame::add(const HistoryPoint& tick) {
  const double step_s = std::clamp(tick.loop_time_s - std::exchange(last_s_, tick.loop_time_s), 0.0, kColumnOfTicks_s);
  lifted_ = lifted_ || !tick.in_contact;
  if (state_ != State::press || !lifted_) return;
  trace_.add(tick, line_up_, level_);
  if (!tick.in_contact) return;
  for (const bool left : {true, false})
    if (!has_force_ || chosen_left_ == left) pressed_s_[left ? 0 : 1] += step_s;
  if (tick.out_of_domain) return;
  for (std::size_t i = 0; i < line_up_.levels.size(); ++i) {
    const double over_jnd = line_up_.over_jnd(tick, i);
    if (std::isfinite(over_jnd)) largest_[i] = std::max(largest_[i], std::abs(over_jnd));
  }
}

void ExhibitGame::go_on() {
  if (state_ != State::reveal) return;
  if (level_ + 1 == rounds_.size()) {
    state_ = State::score;
    return;
  }
  ++level_;
  begin_round();
}

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
  return replaced(replaced(found->second, "%1", one), "%2", two);
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
  for (std::size_t i = 0; i < kExhibitLevels; ++i)
    if (!(file >> tally.answers[i] >> tally.fooled[i]) || tally.fooled[i] > tally.answers[i]) return {};
  return tally;
}

Status write_tally(const std::string& path, const ExhibitTally& tally) {
  std::string text;
  for (std::size_t i = 0; i < kExhibitLevels; ++i)
    text += std::to_string(tally.answers[i]) + " " + std::to_string(tally.fooled[i]) + "\n";
  return write_file_atomically(path, text, true);
}

}  // namespace palpate
