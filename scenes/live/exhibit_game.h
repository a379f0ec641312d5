// The exhibit's game: three rounds from obvious to impossible, a visitor's answers and the score. Pure logic.
// With a mouse, a finger or keys (seen) a round is a guess, then 15 s of pressing two blocks with one
// stroke, the reference's and a model's, then a reveal:
//   attract -> guess -> press -> reveal -> guess ... -> score
// With a force device (felt) it is a blind comparison of two models under the keys 1 and 2: the same or
// different? One pair of the three is a catch trial, the same model twice:
//   attract -> press -> reveal -> press ... -> score
// What a hand would notice is computed from the visitor's own strokes: where the difference over the JND,
// as its mean over 50 ms (HistoryPoint), was anywhere more than 1, within what the models were trained on; from
// 0.8 to 1.25 it is on the edge, where either answer is right.
// The same seed and the same models give the same rounds.
// Thread guarantee: one thread; `add` allocates nothing after the first minute.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/random_stream.h"

namespace palpate {

// One tick of both forces.
struct ExhibitTick {
  double loop_time_s = 0.0;
  double first_N = 0.0;
  double second_N = 0.0;
  double over_jnd = 0.0;  // the difference as its mean over 50 ms; signed, multiples of the JND; NaN: none
  bool in_contact = false;
  bool out_of_domain = false;
};

// Both forces since the first contact, in columns of 25 ms; the first minute of them.
class ExhibitTrace {
 public:
  static constexpr double kColumn_s = 0.025;
  struct Column {
    double first_N = 0.0;  // means
    double second_N = 0.0;
    double over_jnd = 0.0;  // the largest, signed
    int ticks = 0;          // that count; 0: none, the curve has a gap
  };

  void clear();
  void add(const ExhibitTick& tick);
  double seconds() const noexcept { return seconds_; }  // since the first contact
  const std::vector<Column>& columns() const noexcept { return columns_; }
  // NaN: a gap.
  double over_jnd(std::size_t column) const noexcept;
  // The largest of them so far, and in which column.
  double largest_over_jnd() const noexcept { return largest_; }
  std::size_t largest_at() const noexcept { return largest_at_; }

 private:
  std::vector<Column> columns_;
  double began_s_ = -1.0;  // loop time of the first contact; below 0: none yet
  double seconds_ = 0.0;
  double largest_ = 0.0;
  std::size_t largest_at_ = 0;
};

// A model that is ready.
struct ExhibitModel {
  std::size_t slot = 0;
  std::string method;  // "position": knows the depth alone
  bool paper = false;  // by the paper's recipe of 2009
};

struct ExhibitRound {
  std::optional<ExhibitModel> first;  // nothing: the reference itself
  ExhibitModel second;
  bool answered = false;
  bool said_noticed = false;
  double largest_over_jnd = 0.0;  // once it is over

  bool is_catch() const noexcept { return first && first->slot == second.slot; }
  bool noticed() const noexcept { return largest_over_jnd > 1.0; }
  // A hand's smallest difference is no sharp line: within a quarter of it some trials go either way.
  bool on_the_edge() const noexcept { return largest_over_jnd >= 0.8 && largest_over_jnd <= 1.25; }
  bool right() const noexcept { return answered && (on_the_edge() || said_noticed == noticed()); }
};

class ExhibitGame {
 public:
  enum class State : std::uint8_t { attract, guess, press, reveal, score };
  static constexpr double kPress_s = 15.0;
  static constexpr std::size_t kMostRounds = 3;

  explicit ExhibitGame(std::uint64_t seed) : random_(seed, kStream) {}

  // From obvious to impossible: the model of depth alone, the paper's recipe, the best one (greedy, else
  // direct, else the first), as far as they are there. Seen: each against the reference, or without one
  // against the first model; felt: against the best.
  static std::vector<ExhibitRound> rounds_of(const std::vector<ExhibitModel>& ready, bool has_reference, bool felt);
  // False, and nothing changes: there is nothing to compare. `press_s`: of a round that is seen.
  bool begin(const std::vector<ExhibitModel>& ready, bool has_reference, bool felt, double press_s = kPress_s);
  void reset();

  State state() const noexcept { return state_; }
  bool felt() const noexcept { return felt_; }
  const std::vector<ExhibitRound>& rounds() const noexcept { return rounds_; }
  const ExhibitRound& round() const noexcept { return rounds_[index_]; }  // not in attract
  std::size_t number() const noexcept { return index_ + 1; }              // of the round
  const ExhibitTrace& trace() const noexcept { return trace_; }

  // Seen: would a hand notice a difference? Then the pressing begins.
  void guess(bool noticed);
  // Felt: key 1 or 2 chooses what is rendered; both have to be pressed once before an answer.
  void choose(int key) noexcept;
  int chosen() const noexcept { return chosen_; }
  bool pressed_both() const noexcept { return pressed_[0] && pressed_[1]; }
  // The model to render while there is a choice.
  const ExhibitModel& rendered() const noexcept;
  void answer(bool different);
  // Every tick while pressing. What is seen ends by itself.
  void add(const ExhibitTick& tick);
  // From a reveal on to the next round or the score.
  void go_on();

  std::size_t right() const noexcept;

 private:
  static constexpr std::uint64_t kStream = 21;  // of the seed, its own
  void begin_round();
  void end_round();

  RandomStream random_;
  State state_ = State::attract;
  bool felt_ = false;
  double press_s_ = kPress_s;
  std::vector<ExhibitRound> rounds_;
  std::size_t index_ = 0;
  ExhibitTrace trace_;
  int chosen_ = 1;
  std::array<bool, 2> pressed_{};
};

}  // namespace palpate
