#include "scenes/study/study_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "devices/registry/device_registry.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

// The largest allowed difference between rendered and commanded force at any tick: half the JND at 0 N. A trial that
// exceeds it is presented again.
const double kMostAway_N = 0.5 * JndLine{}.at(0.0);

double to_tenth_mN(double force_N) noexcept { return std::round(force_N * 1e4) / 1e4; }

const char* question(bool strokes) {
  return strokes ? "Which of the two pushes was like the reference?" : "Which push was larger?";
}

std::string consent_text(bool strokes) {
  return std::string(
             "In this study you hold a device that pushes gently against your hand, with at most 4 N (the weight of "
             "400\u00A0g). ") +
         (strokes ? "Each time you feel three pushes, one after the other, and say which of the last two was like the "
                    "first."
                  : "Each time you feel two pushes, one after the other, and say which was the larger.") +
         " Hold your hand still. There are breaks.\n"
         "Stored are your answers, how long they took and the code that you were given; not your name.\n"
         "Taking part is voluntary. You can stop at any time and without a reason (Esc, then E); the "
         "force then goes away at once.\n"
         "Do you agree to take part?";
}

}  // namespace

StudySession::StudySession(StudyFile file, std::uint64_t rest_ticks)
    : file_(std::move(file)), rest_ticks_(rest_ticks), trials_(plan_study(file_.header().subject, strokes())) {
  if (file_.consented()) state_ = answered() < trials_.size() ? StudyState::ready : StudyState::done;
}

void StudySession::accept_consent(const std::string& when) {
  if (state_ != StudyState::consent) return;
  const Status written = file_.consent(when);
  problem_ = written ? "" : written.error().message;
  if (written) state_ = StudyState::ready;
}

void StudySession::proceed() {
  const bool rested = state_ == StudyState::rest && presenter_.newest().tick >= rest_until_;
  if (state_ == StudyState::ready || rested) present_next();
}

void StudySession::present_next() {
  presentation_ = presenter_.present(stimuli_of(trial(), strokes()));
  state_ = StudyState::presenting;
}

void StudySession::update() {
  const PresentationState& seen = presenter_.newest();
  if (state_ != StudyState::presenting || seen.presentation != presentation_ || seen.finished_at == 0) return;
  dropped_out_ = file_.header().rendered && seen.worst_N > kMostAway_N;
  state_ = dropped_out_ ? StudyState::ready : StudyState::answering;
}

void StudySession::answer(bool second) {
  if (state_ != StudyState::answering) return;
  const PresentationState& seen = presenter_.newest();
  StudyRecord record{trial()};
  record.first_rendered_N = to_tenth_mN(seen.rendered_N[1]);
  record.second_rendered_N = to_tenth_mN(seen.rendered_N[2]);
  if (strokes() != nullptr) {
    record.reminder_rendered_N = to_tenth_mN(seen.rendered_N[0]);
    record.worst_N = to_tenth_mN(seen.worst_N);
  }
  record.limited = seen.limited;
  record.answered_second = second;
  record.response_ms = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(seen.tick - seen.finished_at, std::numeric_limits<std::uint32_t>::max()));
  const Status written = file_.append(record);
  problem_ = written ? "" : written.error().message;
  if (!written) return;
  const std::size_t block = strokes() != nullptr ? kDiscriminationBlock : kConstantBlock;
  if (answered() == trials_.size()) {
    state_ = StudyState::done;
  } else if (record.trial.training != trial().training) {
    state_ = StudyState::ready;
  } else if (!record.trial.training && record.trial.number % block == 0) {
    state_ = StudyState::rest;
    rest_until_ = seen.tick + rest_ticks_;
  } else {
    present_next();
  }
}

void StudySession::abort() {
  presenter_.stop();
  if (state_ != StudyState::done) state_ = StudyState::aborted;
}

StudyView StudySession::view() {
  const PresentationState& seen = presenter_.newest();
  StudyView view;
  view.state = state_;
  const StudyTrial& now = trials_[std::min(answered(), trials_.size() - 1)];
  view.training = now.training;
  view.answered = now.number - (answered() < trials_.size() ? 1 : 0);
  view.trials = static_cast<std::size_t>(std::ranges::count(trials_, now.training, &StudyTrial::training));
  if (answered() > 0 && file_.records().back().trial.training) {
    const StudyRecord& last = file_.records().back();
    view.was_correct = strokes() != nullptr ? last.found_reference() : last.found_larger();
  }
  if (state_ == StudyState::presenting && seen.presentation == presentation_) view.interval = seen.interval;
  if (state_ == StudyState::rest && rest_until_ > seen.tick) view.rest_ticks_left = rest_until_ - seen.tick;
  view.message = message(view);
  return view;
}

std::string StudySession::message(const StudyView& view) const {
  switch (state_) {
    case StudyState::consent:
      return problem_.empty() ? consent_text(strokes() != nullptr) : problem_;
    case StudyState::ready:
      if (dropped_out_)
        return "The device was not ready for a moment. The same pushes come again; go on when you are ready.";
      if (!view.training) return "Now the study itself. Go on when you are ready.";
      return std::string("First a few trials to learn the task. ") + question(strokes() != nullptr) +
             " Go on when you are ready.";
    case StudyState::presenting:
      return std::array{"Hold still", "The reference", "First push", "Second push"}.at(
          static_cast<std::size_t>(view.interval + 1));
    case StudyState::answering:
      if (problem_.empty()) return std::string(question(strokes() != nullptr)) + " Press 1 or 2.";
      return "Your answer could not be stored: " + problem_ + ". Call the experimenter, then answer again.";
    case StudyState::rest:
      return "A break. Relax your hand; go on when you are ready.";
    case StudyState::done:
      return "That was all. Thank you!";
    case StudyState::aborted:
      return problem_.empty() ? "The session was ended; all answers are stored."
                              : "The session was ended; the last answer could not be stored: " + problem_;
  }
  return {};
}

Result<std::unique_ptr<LiveStudy>> LiveStudy::open(const std::string& device, bool realtime, StrokesPointer strokes) {
  auto opened = open_device(device, {.calibrations = calibrations_folder()});
  if (!opened) return opened.error();
  std::unique_ptr<LiveStudy> study(new LiveStudy);
  study->realtime_ = realtime;
  study->device_ = std::move(*opened);
  study->header_ = {"", std::move(strokes), study->device_->name(), study->device_->holder() == Holder::person};
  return study;
}

LiveStudy::~LiveStudy() {
  loop_.reset();
  device_->close();
}

Status LiveStudy::begin(const std::string& code) {
  header_.subject = code;
  auto file = StudyFile::open((strokes() != nullptr ? "discriminate-" : "study-") + code + ".csv", header_);
  if (!file) return file.error();
  session_ = std::make_unique<StudySession>(std::move(*file));
  LoopSettings settings;
  settings.source = session_.get();
  settings.realtime = realtime_;
  auto loop = std::make_unique<HapticsLoop>(*device_, settings);
  if (const Status started = loop->start(); !started) return started;
  loop_ = std::move(loop);
  return {};
}

void LiveStudy::update() {
  if (loop_ == nullptr) return;
  newest_ = loop_->newest();
  session_->update();
}

std::string LiveStudy::device_words() const {
  const auto faults = device_fault_words(newest_.device.faults);
  if (!faults.empty()) return faults.front();
  const std::string zeroing = zeroing_words(newest_.device);
  return zeroing.empty() ? device_->note() : zeroing;
}

}  // namespace palpate
