// The verdict of a session: the recommended model (scenes/evaluation/model_errors.h) in one sentence with its rival:
// the most accurate model of the other kind, of this program or of the paper (2009), else the most accurate other
// model. Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenes/evaluation/evaluate.h"

namespace palpate {

struct JudgedModel : Candidate {
  std::size_t slot = 0;
  std::string name{};
  bool paper = false;  // a method on the measured force
  Timing tick{};
};

struct Verdict {
  std::optional<std::size_t> chosen;  // slot of the recommended model; empty: `headline` says why there is none yet
  std::string headline;               // what is compared, in one or two sentences
  std::string detail;                 // a second line: why not the model of the lowest error; may be empty
};

// `judged`: at least one. `reference`: name of the model that is the reference; empty: the true force is known.
Verdict judge(const std::vector<JudgedModel>& judged, const std::string& reference);

// "1.6 times faster"; where the medians or the least times differ by at most a tenth, "as fast".
std::string time_words(const Timing& one, const Timing& other);
// The share of the period of 1 ms that a tick takes, as "0.04 %".
std::string tick_share(double tick_ns);
// An error over the JND with two digits: a quantile of a stream is rounded up by at most 1.1 % (StreamErrors).
std::string jnd_text(double error_over_jnd);

}  // namespace palpate
