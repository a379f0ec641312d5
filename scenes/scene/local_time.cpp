#include "scenes/scene/local_time.h"

#include <ctime>

namespace palpate {

std::string local_time_text(const char* format) {
  const std::time_t time = std::time(nullptr);
  std::tm local{};
  localtime_r(&time, &local);
  char text[64] = {};
  std::strftime(text, sizeof text, format, &local);
  return text;
}

}  // namespace palpate
