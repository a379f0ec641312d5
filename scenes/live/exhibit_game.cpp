#include "scenes/live/exhibit_game.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

constexpr double kLongest_s = 60.0;  // of a trace

void replace(std::string& text, std::string_view sign, const std::string& by) {
  if (const std::size_t at = text.find(sign); at != std::string::npos) text.replace(at, sign.size(), by);
}

}  // namespace

void ExhibitTrace::clear() {
  *this = {};
  columns_.reserve(static_cast<std::size_t>(kLongest_s / kColumn_s));
}

void ExhibitTrace::add(const ExhibitTick& tick) {
  if (began_s_ < 0.0 && !tick.in_contact) return;
  if (began_s_ < 0.0) began_s_ = tick.loop_time_s;
  seconds_ = tick.loop_time_s - began_s_;
  const auto at = static_cast<std::size_t>(seconds_ / kColumn_s);
  if (seconds_ >= kLongest_s) return;
  if (columns_.size() <= at) columns_.resize(at + 1);
  if (tick.out_of_domain || !std::isfinite(tick.first_N + tick.second_N + tick.over_jnd)) return;
  Column& column = columns_[at];
  const double share = 1.0 / ++column.ticks;
  column.first_N += share * (tick.first_N - column.first_N);
  column.position_m += share * (tick.position_m - column.position_m);
  if (column.ticks == 1 || std::abs(tick.over_jnd) > std::abs(column.over_jnd)) column.over_jnd = tick.over_jnd;
  const bool strong = std::max(tick.first_N, tick.second_N) >= kStrong_N;
  if (strong && !strong_) largest_ = 0.0;
  strong_ = strong_ || strong;
  if (strong == strong_ && std::abs(tick.over_jnd) > largest_) {
    largest_ = std::abs(tick.over_jnd);
    largest_at_ = at;
  }
}

std::vector<ExhibitRound> ExhibitGame::rounds_of(const std::vector<ExhibitModel>& ready, bool has_reference,
                                                 bool has_force) {
  std::vector<ExhibitModel> models = ready;
  std::ranges::stable_sort(
      models, {}, [](const ExhibitModel& one) { return one.paper ? one.centres : std::numeric_limits<int>::max(); });
  while (models.size() > kMostRounds) models.erase(models.end() - 2);
  std::optional<ExhibitModel> first;
  if (!models.empty() && (has_force || !has_reference)) {
    first = models.back();
    models.pop_back();
  }
  std::vector<ExhibitRound> rounds;
  for (const ExhibitModel& model : models) rounds.push_back({first, model});
  return rounds;
}

bool ExhibitGame::begin(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force, double press_s) {
  std::vector<ExhibitRound> rounds = rounds_of(ready, has_reference, has_force);
  if (rounds.empty()) return false;
  if (has_force) {
    rounds.resize(std::min(rounds.size(), kMostRounds - 1));
    rounds.push_back({rounds.back().first, *rounds.back().first});
    for (std::size_t i = rounds.size(); i > 1; --i) std::swap(rounds[i - 1], rounds[random_.index(i)]);
    for (ExhibitRound& round : rounds)
      if (random_.index(2) == 1) std::swap(*round.first, round.second);
  }
  rounds_ = std::move(rounds);
  has_force_ = has_force;
  press_s_ = press_s;
  index_ = 0;
  begin_round();
  return true;
}

void ExhibitGame::reset() {
  state_ = State::attract;
  rounds_.clear();
  trace_.clear();
}

void ExhibitGame::begin_round() {
  trace_.clear();
  chosen_ = 1;
  pressed_ = {};
  state_ = has_force_ ? State::press : State::guess;
}

void ExhibitGame::guess(bool noticed) {
  if (state_ != State::guess) return;
  rounds_[index_].answered = true;
  rounds_[index_].said_noticed = noticed;
  state_ = State::press;
}

void ExhibitGame::choose(int key) noexcept {
  if (state_ == State::press && has_force_ && (key == 1 || key == 2)) chosen_ = key;
}

const ExhibitModel& ExhibitGame::rendered() const noexcept {
  const ExhibitRound& now = round();
  return has_force_ && chosen_ == 1 ? *now.first : now.second;
}

void ExhibitGame::answer(bool different) {
  if (state_ != State::press || !has_force_ || !pressed_both()) return;
  rounds_[index_].answered = true;
  rounds_[index_].said_noticed = different;
  end_round();
}

void ExhibitGame::add(const ExhibitTick& tick) {
  if (state_ != State::press) return;
  trace_.add(tick);
  if (tick.in_contact) pressed_[chosen_ == 2 ? 1 : 0] = true;
  if (!has_force_ && trace_.seconds() >= press_s_) end_round();
}

void ExhibitGame::end_round() {
  rounds_[index_].largest_over_jnd = trace_.largest_over_jnd();
  state_ = State::reveal;
}

void ExhibitGame::go_on() {
  if (state_ != State::reveal) return;
  if (index_ + 1 == rounds_.size()) {
    state_ = State::score;
    return;
  }
  ++index_;
  begin_round();
}

std::size_t ExhibitGame::correct_answers() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(rounds_, &ExhibitRound::correct));
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
