// The outcome of a study as a file that a scene names in place of its own line.
//
// JSON: "format": "palpate-jnd", "version": 1, "offset_N" (above 0, up to 100) and
// "weber_fraction" (0 to 1) of the conservative line, which is all that a scene uses;
// besides, for the reader: criterion, subjects, the fitted line before the shift and
// the points with their sources. Other fields are kept out of the way: ignored.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/scene/jnd_line_fit.h"

namespace palpate {

// The text of the file; numbers read back as they are.
std::string jnd_file_text(const JndLines& lines, const std::vector<JndPoint>& points, double criterion,
                          const std::vector<std::string>& subjects);

// Errors: not JSON, another format or version, a field missing or out of range; the
// first one, as "path:line:column: found ..., expected ...".
Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path);
// And: not readable.
Result<JndLine> read_jnd_file(const std::string& path);

}  // namespace palpate
