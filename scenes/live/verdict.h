// The verdict of a session: the recommended model (scenes/evaluation/ranking.h), whether a hand can notice its
// error, and its computation time.
// Thread guarantee: values; BackgroundEvaluation: one thread, beside its own background thread.
#pragma once

#include <cstddef>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

class Comparison;
class SessionModels;

// Time and errors of one model; the errors of all are over the same samples.
struct EvaluatedSlot {
  std::size_t slot = 0;
  Timing tick;
  UnitErrors unit_errors;  // decide which model is recommended
  // The newest 99 % error, which the list of models shows too: what the verdict says about the models.
  double p99_error_over_jnd = 0.0;
};

struct Verdict {
  std::optional<std::size_t> chosen;  // slot of the recommended model; empty: `headline` says why there is none yet
  bool noticeable = false;            // the 99 % error of the chosen model exceeds one JND
  std::string headline;               // one line
  std::string detail;                 // a second line; may be empty
};

// Contact that a verdict needs at least.
inline constexpr double kLeastContact_s = 1.0;

// `reference_name`: name of the reference model; empty: the true force is known.
// `models`: for names and times. `evaluated`: at least one, each with samples.
Verdict judge(const std::vector<EvaluatedSlot>& evaluated, const SessionModels& models,
              const std::string& reference_name);

// The share of the tick's period of 1 ms, as "0.04 %".
std::string tick_share(double tick_ns);

// Computes the UnitErrors of a live session in the background, every 2 s or, if that is longer, every tenth of the
// duration of contact so far.
class BackgroundEvaluation {
 public:
  // Call it once a frame.
  void update(const SessionModels& models, const Comparison& comparison, double now_s);
  const std::vector<EvaluatedSlot>& evaluated() const noexcept { return evaluated_; }
  void reset();

 private:
  std::vector<EvaluatedSlot> evaluated_;
  std::future<std::vector<EvaluatedSlot>> running_;
  bool discard_ = false;  // `reset` was called while the computation ran
  double next_s_ = 0.0;
};

}  // namespace palpate
