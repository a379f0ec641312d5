// The clock on the wall, for names of files and for notes in them.
#pragma once

#include <ctime>
#include <string>

namespace palpate {

// Now, in the machine's time zone, as strftime writes `format`: at most 63 bytes.
// Any thread.
inline std::string local_time_text(const char* format) {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  char text[64] = {};
  std::strftime(text, sizeof text, format, &local);
  return text;
}

}  // namespace palpate
