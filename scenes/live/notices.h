// What happened in a session, for people, oldest first.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct Notice {
  std::string text;
  bool problem = false;  // else: good news
};
using Notices = std::vector<Notice>;

}  // namespace palpate
