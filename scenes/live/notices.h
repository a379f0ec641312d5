// Messages of a session to the user, oldest first. Thread guarantee: values.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct Notice {
  std::string text;
  bool problem = false;  // an error or a warning, not information
};
using Notices = std::vector<Notice>;

}  // namespace palpate
