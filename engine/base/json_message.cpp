#include "engine/base/json_message.h"

#include <cstdio>

namespace palpate {

std::string NumberRange::words() const {
  char text[80];
  std::snprintf(text, sizeof text, "a number %s %g up to %g", open ? "above" : "from", low, high);
  return text;
}

}  // namespace palpate
