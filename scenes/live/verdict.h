// The verdict of a session: the recommended model (scenes/evaluation/ranking.h), whether a hand can notice its
// error, and its computation time.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenes/evaluation/model_errors.h"

namespace palpate {

class SessionModels;

// The errors of one model; those of all are over the same samples.
struct EvaluatedSlot {
  std::size_t slot = 0;
  const UnitErrors* unit_errors = nullptr;  // for the ranking; not null
  // The 99 % error in the list of models, which the text of the verdict uses.
  double p99_error_over_jnd = 0.0;
};

struct Verdict {
  std::optional<std::size_t> chosen;  // slot of the recommended model; empty: `headline` says why there is none yet
  bool noticeable = false;            // the 99 % error of the chosen model exceeds one JND
  std::string headline;               // one line
  std::string detail;                 // a second line; may be empty
};

// `reference_name`: name of the reference model; empty: the true force is known.
// `models`: for names and times. `evaluated`: at least one, each with samples.
Verdict judge(std::vector<EvaluatedSlot> evaluated, const SessionModels& models, const std::string& reference_name);

// The share of the period of 1 ms that a tick takes, as "0.04 %".
std::string tick_share(double tick_ns);

}  // namespace palpate
