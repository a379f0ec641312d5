// Reads the JND line from the result file of a JND study (scenes/study/study_analysis.h). A scene can name such a file.
// JSON: "format": "palpate-jnd", "version": 1, "offset_N" (above 0, up to 100) and "weber_fraction" (0 to 1) of the
// conservative line. "criterion", "subjects", "fitted" and "points" are allowed and ignored.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"

namespace palpate {

// Errors: not JSON, another format or version, an unknown or missing field, a value out of range; each as
// "path:line:column: found ..., expected ...".
Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path);
// Errors: the file is not readable; those of parse_jnd_file.
Result<JndLine> read_jnd_file(const std::string& path);

}  // namespace palpate
