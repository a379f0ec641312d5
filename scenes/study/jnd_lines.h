// The outcome of a study: a line through JNDs, and the file that says so.
//
// As Hoever & Harders (2009), section 4.1 and figure 3: a line is fitted to the JNDs
// over the reference force by least squares, all points alike, and then shifted down
// until no point lies below it. A model within that conservative line is within every
// measured threshold.
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

// Errors: fewer than two reference forces; JNDs that fall with the force; a
// conservative line that is not above zero at no force. Nothing could be compared with
// those.
Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points);

// X.-D. Pang, H. Z. Tan & N. I. Durlach (1991), "Manual discrimination of force using
// active finger motion", Perception & Psychophysics 49(6), 531-540: the one value
// within the range of this study, 9 % at 2.5 N, as Hoever & Harders quote it. (Their
// abstract sums up 2.5 to 10 N as "roughly 7 %".)
std::vector<JndPoint> pang_tan_durlach_points();

// The text of the file that scenes/scene/jnd_file.h reads: the conservative line and, for the reader,
// criterion, subjects, the fitted line before the shift and the points with their sources; numbers
// read back as they are.
std::string jnd_file_text(const JndLines& lines, const std::vector<JndPoint>& points,
                          const std::vector<std::string>& subjects);

}  // namespace palpate
