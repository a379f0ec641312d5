// Counts operations that are forbidden in a haptics tick: allocation, deallocation,
// locks, sleeps and writes.
//
// The test program replaces malloc, calloc, realloc, free, posix_memalign,
// aligned_alloc, memalign (which operator new and delete call),
// pthread_mutex_lock, clock_nanosleep and write by wrappers that count. They count
// only on a thread inside an RtGuard. Exceptions and large std::function captures
// appear as allocations.
#pragma once

namespace palpate::test {

struct RtOffences {
  int allocations = 0;
  int deallocations = 0;  // free(nullptr) does not count
  int locks = 0;
  int sleeps = 0;
  int writes = 0;

  int total() const { return allocations + deallocations + locks + sleeps + writes; }
};

// Counts on this thread, from construction until `stop` or destruction. Guards cannot
// be nested.
class RtGuard {
 public:
  RtGuard() noexcept;
  RtGuard(const RtGuard&) = delete;
  RtGuard& operator=(const RtGuard&) = delete;
  ~RtGuard();

  // Stops counting and returns the counts. Call it before test macros, which
  // allocate.
  RtOffences stop() noexcept;
};

// False in builds with a sanitizer that replaces malloc or the locks (address,
// thread, memory). There a guard counts nothing, and tests skip.
bool rt_guard_works() noexcept;

}  // namespace palpate::test
