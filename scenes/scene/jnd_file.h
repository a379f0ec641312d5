// The file with a study's outcome (scenes/study/jnd_lines.h), which a scene names in place of its own line.
// JSON: "format": "palpate-jnd", "version": 1, "offset_N" (above 0, up to 100) and
// "weber_fraction" (0 to 1) of the conservative line, which is all that a scene uses.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/tick/jnd.h"

namespace palpate {

// Errors: not JSON, another format or version, a field missing or out of range; the
// first one, as "path:line:column: found ..., expected ...".
Result<JndLine> parse_jnd_file(std::string_view text, const std::string& path);
// And: not readable.
Result<JndLine> read_jnd_file(const std::string& path);

}  // namespace palpate
