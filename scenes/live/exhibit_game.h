// The exhibit without graphics: its texts, the tally of all visitors' answers, and the rules of its game: up to three
// rounds, a visitor's answers and the score.
// Without a force device the difficulty rises. The visitor guesses whether a hand would notice a difference, then
// presses two blocks with one stroke for 15 s: one renders the reference, the other a model. Then the result is shown:
//   attract -> guess -> press -> reveal -> guess ... -> score
// With a force device (`has_force`) a round is a blind comparison of two models, which the keys 1 and 2 select: are
// they the same or different? One round is a catch trial with the same model twice; the order is random:
//   attract -> press -> reveal -> press ... -> score
// A difference is noticeable when the magnitude of the mean over 50 ms of difference / JND (HistoryPoint) exceeded 1
// anywhere in the visitor's own strokes within the models' training domain. From 0.8 to 1.25 either answer is correct.
// The same seed and the same models give the same rounds.
// Thread guarantee: one thread, slow side; `add` allocates nothing after the first minute.
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

namespace palpate {

struct ExhibitTick {
  double loop_time_s = 0.0, first_N = 0.0, second_N = 0.0;
  double over_jnd = 0.0;  // mean over 50 ms of difference / JND, signed; NaN: none
  bool in_contact = false, out_of_domain = false;
  double position_m = 0.0;
};

// Both forces in the first minute from the first contact on, averaged over intervals of 25 ms (columns). Once a force
// has reached kStrong_N, the largest difference is that of such forces: a smaller one cannot be shown.
class ExhibitTrace {
 public:
  static constexpr double kColumn_s = 0.025, kStrong_N = 1.0;
  struct Column {
    double first_N = 0.0;                                        // mean
    double position_m = 0.0;                                     // mean
    double over_jnd = std::numeric_limits<double>::quiet_NaN();  // the value of largest magnitude, signed; NaN: a gap
    int ticks = 0;                                               // within the training domain
  };

  void clear();
  void add(const ExhibitTick& tick);
  double seconds() const noexcept { return seconds_; }  // since the first contact
  const std::vector<Column>& columns() const noexcept { return columns_; }
  // The largest magnitude so far, and its column.
  double largest_over_jnd() const noexcept { return largest_; }
  bool strong() const noexcept { return strong_; }
  std::size_t largest_at() const noexcept { return largest_at_; }

 private:
  std::vector<Column> columns_;
  double began_s_ = -1.0;  // loop time of the first contact; below 0: none yet
  double seconds_ = 0.0;
  bool strong_ = false;  // a force has reached kStrong_N
  double largest_ = 0.0;
  std::size_t largest_at_ = 0;
};

struct ExhibitModel {
  std::size_t slot = 0;
  int centres = 0;
  bool paper = false;  // a method on the measured force, as in the paper (2009)
};

struct ExhibitRound {
  std::optional<ExhibitModel> first;  // empty: the reference
  ExhibitModel second;
  bool answered = false;
  bool said_noticed = false;      // the answer: the difference is noticeable, or the models differ
  double largest_over_jnd = 0.0;  // set at the end of the round

  bool is_catch() const noexcept { return first && first->slot == second.slot; }
  bool noticed() const noexcept { return largest_over_jnd > 1.0; }
  // The JND is a point on a gradual psychometric function: within a factor of 1.25 of it either answer is accepted.
  bool near_jnd() const noexcept { return largest_over_jnd >= 0.8 && largest_over_jnd <= 1.25; }
  bool correct() const noexcept { return answered && (near_jnd() || said_noticed == noticed()); }
};

class ExhibitGame {
 public:
  enum class State : std::uint8_t { attract, guess, press, reveal, score };
  static constexpr double kPress_s = 15.0;
  static constexpr std::size_t kMostRounds = 3;

  explicit ExhibitGame(std::uint64_t seed) : random_(seed, kStream) {}

  // The rounds in order of rising difficulty, at most kMostRounds: the paper's models by their number of centres, then
  // those with a trend, of which the last is the best and always takes part. The other side is the best model when
  // `has_force` or without a reference, else the reference.
  static std::vector<ExhibitRound> rounds_of(const std::vector<ExhibitModel>& ready, bool has_reference,
                                             bool has_force);
  // Starts a game. Returns false and changes nothing when there are no two forces to compare. `press_s`: duration of
  // pressing when not `has_force`, from the first contact.
  bool begin(const std::vector<ExhibitModel>& ready, bool has_reference, bool has_force, double press_s = kPress_s);
  void reset();

  State state() const noexcept { return state_; }
  bool has_force() const noexcept { return has_force_; }
  const std::vector<ExhibitRound>& rounds() const noexcept { return rounds_; }
  const ExhibitRound& round() const noexcept { return rounds_[index_]; }  // not in the state attract
  std::size_t number() const noexcept { return index_ + 1; }              // of the round, from 1
  const ExhibitTrace& trace() const noexcept { return trace_; }

  // Without a force device: stores the guess whether a hand would notice a difference, and begins the pressing.
  void guess(bool noticed);
  // With a force device: key 1 or 2 chooses the rendered model. `answer` needs a contact with each.
  void choose(int key) noexcept;
  int chosen() const noexcept { return chosen_; }
  bool pressed_both() const noexcept { return pressed_[0] && pressed_[1]; }
  const ExhibitModel& rendered() const noexcept;  // the model to render
  void answer(bool different);                    // ends the round
  // Call it in every tick. Without a force device the round ends after `press_s`.
  void add(const ExhibitTick& tick);
  // Leaves `reveal` for the next round, or for `score` after the last one.
  void go_on();

  std::size_t correct_answers() const noexcept;  // number of correct answers

 private:
  static constexpr std::uint64_t kStream = 21;  // number of this game's random stream of the seed
  void begin_round();
  void end_round();

  RandomStream random_;
  State state_ = State::attract;
  bool has_force_ = false;
  double press_s_ = kPress_s;
  std::vector<ExhibitRound> rounds_;
  std::size_t index_ = 0;
  ExhibitTrace trace_;
  int chosen_ = 1;
  std::array<bool, 2> pressed_{};
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

// Answers of all visitors, kept across restarts.
struct ExhibitTally {
  std::uint64_t answers = 0, as_expected = 0;
};
// Zero where the file is missing or invalid.
ExhibitTally read_tally(const std::string& path);
Status write_tally(const std::string& path, const ExhibitTally& tally);

}  // namespace palpate
