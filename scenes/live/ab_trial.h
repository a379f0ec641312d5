// "Can you feel the difference?": two models under the keys 1 and 2, which one
// is which hidden, and the verdict afterwards. Pure logic, no session, no drawing.
//
//   idle --begin--> exploring --answer--> answered --begin or reset--> ...
//
// One of the pair is the greedy model (else the direct one, else the first); the
// other is drawn from the rest: half of the time one that is nearly the same
// (direct), otherwise one that is noticeably different (position only), as far as
// there are such. What can be felt is predicted from the forces that this visitor
// met, whatever the models: |F1 - F2| / JND((F1 + F2) / 2) over the ticks in contact.
// A difference counts as one that can be felt when it was above one JND in at least
// 5 % of them, that is, when the 95th percentile is above 1.
// Deterministic: the same seed and the same slots give the same trials.
// Thread guarantee: one thread; constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"
#include "engine/base/random_stream.h"

namespace palpate {

// A model that is ready, as SlotView has it.
struct TrialModel {
  std::size_t slot = 0;
  std::string name;
  std::string method;  // "position": knows the depth alone
};

class AbTrial {
 public:
  enum class State : std::uint8_t { idle, exploring, answered };

  explicit AbTrial(std::uint64_t seed) : random_(seed, kStream) {}

  // A new trial among the models that are ready. False, and idle: fewer than two.
  bool begin(const std::vector<TrialModel>& ready);
  void reset();

  State state() const noexcept { return state_; }
  // The slot under key 1 or 2, to put into the hand; only in a trial.
  std::size_t slot_under(int key) const noexcept { return pair_[key == 2 ? 1 : 0].slot; }
  const TrialModel& under(int key) const noexcept { return pair_[key == 2 ? 1 : 0]; }
  // Whether the block was pressed at all in this trial.
  bool touched() const noexcept { return samples_ > 0; }
  // A key was pressed: remembered while exploring. Other numbers are ignored.
  void press(int key) noexcept;
  // The key pressed last; 1 at the beginning.
  int pressed() const noexcept { return pressed_; }
  // Whether both have been active: only then an answer means anything.
  bool tried_both() const noexcept { return tried_[0] && tried_[1]; }

  // One tick while exploring: the forces of the slots under 1 and 2. Ignored out of
  // contact and when a force is not finite.
  void update(double force_1_N, double force_2_N, bool in_contact, const JndLine& jnd) noexcept;

  // Multiples of the JND; 0 without contact. The percentile is right to 0.02, and
  // at most kMostJnd.
  double largest_over_jnd() const noexcept { return largest_; }
  double p95_over_jnd() const noexcept;
  bool predicts_difference() const noexcept { return p95_over_jnd() > 1.0; }

  // The visitor's answer; ignored unless exploring.
  void answer(bool different) noexcept;
  bool answered_different() const noexcept { return different_; }

  // Which was which, how large the difference was and whether the answer agrees
  // with the prediction, in plain sentences; empty unless answered.
  std::string verdict() const;

  static constexpr double kMostJnd = 20.0;

 private:
  static constexpr std::uint64_t kStream = 21;  // of the seed, its own
  static constexpr std::size_t kBins = 1000;
  const TrialModel* draw_other(const std::vector<TrialModel>& ready, const TrialModel& one);

  RandomStream random_;
  State state_ = State::idle;
  std::array<TrialModel, 2> pair_;
  std::array<bool, 2> tried_{};
  int pressed_ = 1;
  bool different_ = false;
  double largest_ = 0.0;
  std::uint64_t samples_ = 0;
  std::array<std::uint64_t, kBins> counts_{};
};

}  // namespace palpate
