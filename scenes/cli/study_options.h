// What the verbs of palpate study are told.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/study/simulated_subject.h"
#include "scenes/study/study_analysis.h"

namespace palpate::cli {

struct StudyOptions {
  int resamples = 999;  // of the subjects, for the interval of all together
  bool with_published = false;
  std::string out = ".";
  bool force = false;
  std::vector<std::string> files;  // analyse
  bool rehearsals = false;         // also answers that nobody could feel
  int subjects = 12;               // simulate
  std::uint64_t seed = 1;
  SubjectTraits traits{{0.05, 0.113}, 0.0, 0.01};  // 13.3 % at 2.5 N, as the paper's
  double spread = 0.15;
  bool discriminates = false;
  std::string recording;  // to discriminate; empty: virtual
  std::string strokes_scene = "silicone_block";
  std::vector<std::string> models;
  std::string device = "auto";  // run
  std::string subject;
  bool bridge_remote = false;
};

// What the headers of all subjects have in common.
Result<StudyHeader> study_header(const StudyOptions& options);
Status run_study_session(const StudyOptions& options);

}  // namespace palpate::cli
