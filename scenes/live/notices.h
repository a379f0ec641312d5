// Messages of a session to the user, oldest first.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct Notice {
  std::string text;
  bool problem = false;
};
using Notices = std::vector<Notice>;

}  // namespace palpate
