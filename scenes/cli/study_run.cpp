// palpate study run: a session in a terminal, with a person at a device.
#include <poll.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <string>

#include "devices/bridge/bridge_target.h"
#include "engine/base/signals.h"
#include "scenes/cli/study_options.h"
#include "scenes/scene/user_folders.h"
#include "scenes/study/live_study.h"

namespace palpate::cli {
namespace {

constexpr int kPause_ms = 10;

// What may be typed now, by StudyState; Enter ends a line.
constexpr const char* kChoices[] = {" [y: I have read this and agree]",
                                    " [Enter: go on]",
                                    "",
                                    " [1 or 2]",
                                    " [r: try again]",
                                    " [Enter: go on]",
                                    "",
                                    ""};

void obey(LiveStudy& study, const std::string& line) {
  StudySession& session = study.session();
  switch (line.empty() ? '\n' : std::tolower(static_cast<unsigned char>(line.front()))) {
    case 'y':
      return session.accept_consent(local_time_text("%Y-%m-%d %H:%M"));
    case '\n':
      return session.proceed();
    case '1':
    case '2':
      return session.answer(line.front() == '2');
    case 'r':
      return session.retry();
    case 'z':
      return study.start_zeroing();
    case 'q':
      return session.abort();
    default:
      return;
  }
}

// A line of standard input, where there is one; false: there will be none.
bool read_line(std::string& typed, bool& whole) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  whole = false;
  if (poll(&input, 1, kPause_ms) <= 0) return true;
  char letter = '\0';
  if (::read(STDIN_FILENO, &letter, 1) != 1) return false;
  whole = letter == '\n';
  if (!whole && typed.size() < 80) typed += letter;
  return true;
}

// What there is to say, each time that it changes.
std::string words_of(LiveStudy& study) {
  const StudyView view = study.session().view();
  std::string words;
  if (view.trials > 0 && view.state == StudyState::answering) {
    words = std::string(view.training ? "training " : "") + std::to_string(view.answered + 1) + " of " +
            std::to_string(view.trials) + ": ";
  }
  words += view.message + kChoices[static_cast<std::size_t>(view.state)];
  if (const std::string device = study.device_words(); !device.empty()) words += "\n" + device;
  if (study.newest().device.zeroing == Zeroing::needed) words += " [z: zero here]";
  return words;
}

void converse(LiveStudy& study) {
  std::string said, typed;
  const auto over = [&] {
    return study.session().state() == StudyState::done || study.session().state() == StudyState::aborted;
  };
  for (bool input = true; !over();) {
    study.update();
    if (const std::string words = words_of(study); words != said) std::printf("%s\n", (said = words).c_str());
    std::fflush(stdout);
    bool whole = false;
    input = read_line(typed, whole);
    if (whole) obey(study, typed);
    if (whole) typed.clear();
    if (!input || stop_requested() != 0) study.session().abort();
  }
  std::printf("%s\n", study.session().view().message.c_str());
}

}  // namespace

Status run_study_session(const StudyOptions& options) {
  const StopListener listener;
  Result<StudyHeader> header = study_header(options);
  if (!header) return header.error();
  LiveStudyRequest request;
  request.device = options.bridge_remote ? with_remote_bridge(options.device) : options.device;
  request.header = *header;
  request.header.subject = options.subject;
  request.path = options.out + (options.discriminates ? "/discriminate-" : "/study-") + options.subject + ".csv";
  const auto study = LiveStudy::open(request);
  if (!study) return study.error();
  if (!(*study)->device_pushes()) std::printf("%s\n", kRehearsal);
  converse(**study);
  std::printf("%s\n", request.path.c_str());
  return {};
}

}  // namespace palpate::cli
