#include "engine/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <system_error>
#include <thread>
#include <vector>

namespace palpate {
namespace {

std::atomic<int> most_threads{std::numeric_limits<int>::max()};

}  // namespace

int thread_count() {
  return std::max(1, std::min(most_threads.load(), static_cast<int>(std::thread::hardware_concurrency())));
}

void limit_threads(int most) { most_threads = most; }

void parallel_for(int count, const std::function<void(int part)>& work) {
  std::atomic<int> next{0};
  const auto take_parts = [&] {
    for (int part = next++; part < count; part = next++) work(part);
  };
  std::vector<std::thread> helpers;
  const int wanted = std::min(thread_count(), count) - 1;
  for (int i = 0; i < wanted; ++i) {
    try {
      helpers.emplace_back(take_parts);
    } catch (const std::system_error&) {
      break;  // the system has no more threads: this one does the rest
    }
  }
  take_parts();
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace palpate
