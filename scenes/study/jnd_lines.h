// The result of a study: a line through JNDs, and its file.
// As in Hoever & Harders (2009), section 4.1 and figure 3, a line is fitted to the JNDs over the reference force by
// least squares with equal weights, and then shifted down until no point is below it. A model error below that
// conservative line is below every measured threshold.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct JndPoint {
  double reference_N = 0.0;
  double jnd_N = 0.0;
  double standard_error_N = 0.0;  // 0: not known
  std::string source;             // "study", or a publication
};

struct JndLines {
  JndLine fitted;
  JndLine conservative;
};

// Errors: fewer than two reference forces; JNDs that decrease with the force; a conservative line that is not
// positive at 0 N.
Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points);

// The only value of X.-D. Pang, H. Z. Tan & N. I. Durlach (1991), "Manual discrimination of force using active finger
// motion", Perception & Psychophysics 49(6), 531-540, within the range of this study: 9 % at 2.5 N, as quoted by
// Hoever & Harders. (The abstract of Pang et al. summarises 2.5 to 10 N as "roughly 7 %".)
std::vector<JndPoint> pang_tan_durlach_points();

// The text of the file that scenes/scene/jnd_file.h reads: the conservative line and, for information, criterion,
// subjects, the fitted line before the shift, and the points with their sources. Numbers are in full precision.
std::string jnd_file_text(const JndLines& lines, const std::vector<JndPoint>& points,
                          const std::vector<std::string>& subjects);

}  // namespace palpate
