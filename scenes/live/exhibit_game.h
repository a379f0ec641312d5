// The exhibit without graphics: its texts, the score of the day, and the rules of its game.
// In each of up to three rounds of rising difficulty, the visitor presses two blocks without names, left and right in
// random order: one renders the true force (or the best model, where none is known or a device has to render it), the
// other a model. Then the visitor says which one is the computer's, and the press of the largest difference is shown:
//   attract -> press -> reveal -> press ... -> score
// With a force device the visitor chooses which block is rendered, and has to press each; else one stroke presses both.
// At the end all models are judged by the same presses, those of the whole game: by the largest magnitude of the mean
// over 50 ms of difference / JND (HistoryPoint) within the models' training domain.
// The same seed and the same models give the same rounds.
// Thread guarantee: one thread, slow side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "scenes/live/comparison.h"

namespace palpate {

inline constexpr std::size_t kExhibitLevels = 3;

struct ExhibitModel {
  std::size_t slot = 0;
  int centres = 0;
  bool paper = false;  // a method on the measured force, as in the paper (2009)
};

// The models of a game: that of each level, from obvious to impossible.
struct ExhibitLineUp {
  std::optional<ExhibitModel> truth;  // empty: the reference
  std::vector<ExhibitModel> levels;

  double true_N(const HistoryPoint& tick) const { return truth ? tick.force_N[truth->slot] : tick.reference_N; }
  // The mean over 50 ms of (model of the level - truth) / JND, signed; NaN: none.
  double over_jnd(const HistoryPoint& tick, std::size_t level) const {
    const double of_level = tick.sustained_over_jnd[levels[level].slot];
    return truth ? of_level - tick.sustained_over_jnd[truth->slot] : of_level;
  }
};

// Both forces of one level from the first contact on, averaged over intervals of 25 ms (columns).
class ExhibitTrace {
 public:
  static constexpr double kColumn_s = 0.025;
  struct Column {
    double true_N = 0.0, position_m = 0.0;                       // means
    double over_jnd = std::numeric_limits<double>::quiet_NaN();  // the value of largest magnitude, signed; NaN: a gap
    int ticks = 0;                                               // within the training domain
  };

  void add(const HistoryPoint& tick, const ExhibitLineUp& line_up, std::size_t level);
  double seconds() const noexcept { return seconds_; }  // since the first contact
  const std::vector<Column>& columns() const noexcept { return columns_; }
  // The largest magnitude so far, and its column.
  double largest_over_jnd() const noexcept { return largest_; }
  std::size_t largest_at() const noexcept { return largest_at_; }

 private:
  std::vector<Column> columns_;
  double began_s_ = -1.0;  // loop time of the first contact; below 0: none yet
  double seconds_ = 0.0;
  double largest_ = 0.0;
  std::size_t largest_at_ = 0;
};

struct ExhibitRound {
  bool computer_is_left = false;
  std::optional<bool> said_left;  // the answer: the left block is the computer's
  bool correct() const noexcept { return said_left && *said_left == computer_is_left; }
};

class ExhibitGame {
 public:
  enum class State : std::uint8_t { attract, press, reveal, score };
  static constexpr double kLeastPress_s = 0.4;  // contact with each block before the answer

  explicit ExhibitGame(std::uint64_t seed) : random_(seed, kStream) {}

  // The paper's models by their number of centres, then those with a trend, of which the last is the best and always
  // takes part. It is the truth when `has_force` or without a reference.
  static ExhibitLineUp line_up_of(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force);
  // Starts a game. Returns false and changes nothing when there are no two forces to compare.
  bool begin(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force);
  void reset();

  State state() const noexcept { return state_; }
  bool has_force() const noexcept { return has_force_; }
  const ExhibitLineUp& line_up() const noexcept { return line_up_; }
  const std::vector<ExhibitRound>& rounds() const noexcept { return rounds_; }
  const ExhibitRound& round() const noexcept { return rounds_[level_]; }  // not in the state attract
  std::size_t level() const noexcept { return level_; }                   // of the round, from 0
  const ExhibitModel& computer() const noexcept { return line_up_.levels[level_]; }
  const ExhibitTrace& trace() const noexcept { return trace_; }  // of this round
  // The largest error over the JND of a level in all presses of this game.
  double largest_over_jnd(std::size_t level) const noexcept { return largest_[level]; }

  // With a force device: which block is rendered.
  void choose(bool left) noexcept { chosen_left_ = left; }
  bool chosen_left() const noexcept { return chosen_left_; }
  const ExhibitModel& rendered() const noexcept;  // the model to render
  // Whether the tool was out of contact in this round; what it does before is not the visitor's.
  bool lifted() const noexcept { return lifted_; }
  bool can_answer() const noexcept {
    return state_ == State::press && pressed_s_[0] > kLeastPress_s && pressed_s_[1] > kLeastPress_s;
  }
  void answer(bool left);              // ends the round, if `can_answer`
  void add(const HistoryPoint& tick);  // call it in every tick
  // Leaves `reveal` for the next round, or for `score` after the last one.
  void go_on();

 private:
  static constexpr std::uint64_t kStream = 21;  // number of this game's random stream of the seed
  void begin_round();

  RandomStream random_;
  State state_ = State::attract;
  bool has_force_ = false;
  ExhibitLineUp line_up_;
  std::vector<ExhibitRound> rounds_;
  std::size_t level_ = 0;
  ExhibitTrace trace_;
  std::array<double, kExhibitLevels> largest_{};
  bool chosen_left_ = true;
  bool lifted_ = false;
  std::array<double, 2> pressed_s_{};  // contact with the left and the right block in this round
  double last_s_ = 0.0;                // loop time of the last tick
};

// The texts in one language: a JSON file in assets/exhibit with a text for each key.
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

// How many visitors have answered in each level today, and how many the computer has fooled; kept across restarts.
struct ExhibitTally {
  std::array<std::uint64_t, kExhibitLevels> answers{}, fooled{};
};
// Zero where the file is missing or invalid.
ExhibitTally read_tally(const std::string& path);
Status write_tally(const std::string& path, const ExhibitTally& tally);

}  // namespace palpate
