// What happened in a session, for people, oldest first.
// Thread guarantee: one thread.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

struct Notice {
  std::string text;
  bool problem = false;  // else: good news
};

class Notices {
 public:
  static constexpr std::size_t kMost = 100;  // the oldest go

  void add(std::string text, bool problem) {
    if (list_.size() == kMost) list_.erase(list_.begin());
    list_.push_back({std::move(text), problem});
  }
  // What was added since the last call.
  std::vector<Notice> read() { return std::exchange(list_, {}); }

 private:
  std::vector<Notice> list_;
};

}  // namespace palpate
