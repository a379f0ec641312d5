// The session's answer: which model to take, by the ranking that reports use too, whether a hand can notice its
// error, and what it costs.
// Thread guarantee: values; LiveJudge: one thread, and a thread of its own.
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

// A model that was judged on the same samples as the others.
struct JudgedModel {
  std::size_t slot = 0;
  Timing tick;
  Evidence evidence;
};

struct Verdict {
  std::optional<std::size_t> chosen;  // slot; nothing: `headline` says why there is none yet
  std::vector<std::size_t> tied;      // slots that are not inferior, the chosen among them
  bool noticeable = false;            // the 99 % error of the chosen is above one JND
  std::string headline;               // one line
  std::string detail;                 // a second, smaller one; may be empty
};

// A second of contact makes a verdict.
inline constexpr double kJudged_s = 1.0;

// `off_from`: the model that the others are compared with, where there is no true force; empty: there is one.
// `models`: for names and times. `judged`: one at least, all with samples.
Verdict judge(const std::vector<const JudgedModel*>& judged, const SessionModels& models, const std::string& off_from);

// "0.04 %" of the tick's millisecond.
std::string tick_share(double tick_ns);

// The evidence of a live session, resampled in the background from time to time.
class LiveJudge {
 public:
  // Once a frame.
  void update(const SessionModels& models, const Comparison& comparison, double now_s);
  const std::vector<JudgedModel>& judged() const noexcept { return judged_; }
  void forget();

 private:
  std::vector<JudgedModel> judged_;
  std::future<std::vector<JudgedModel>> running_;
  bool discard_ = false;  // what runs was forgotten meanwhile
  double next_s_ = 0.0;
};

}  // namespace palpate
