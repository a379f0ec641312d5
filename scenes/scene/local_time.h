// The clock on the wall, for names of files and for notes in them.
#pragma once

#include <string>

namespace palpate {

// Now, in the machine's time zone, as strftime writes `format`: at most 63 bytes.
// Any thread.
std::string local_time_text(const char* format);

}  // namespace palpate
