// Counts what a haptics tick must not do: allocate, free, lock, sleep, write.
//
// The test program replaces malloc, calloc, realloc, free, posix_memalign,
// aligned_alloc, memalign (operator new and delete go through them),
// pthread_mutex_lock, clock_nanosleep and write by counting ones that pass the
// call on. They count only on a thread inside an RtGuard, so that other threads
// and the test around it may do as they like. Exceptions and large std::function
// captures show up as allocations.
#pragma once

namespace palpate::test {

struct RtOffences {
  int allocations = 0;
  int deallocations = 0;  // of something; free(nullptr) is none
  int locks = 0;
  int sleeps = 0;
  int writes = 0;

  int total() const { return allocations + deallocations + locks + sleeps + writes; }
};

// Counts from construction until `stop` or destruction, on this thread. Not to
// be nested.
class RtGuard {
 public:
  RtGuard() noexcept;
  RtGuard(const RtGuard&) = delete;
  RtGuard& operator=(const RtGuard&) = delete;
  ~RtGuard();

  // Ends the counting and returns the counts. The tests' own macros allocate:
  // stop first, then compare.
  RtOffences stop() noexcept;
};

// False in builds with a sanitizer that owns malloc or the locks (address,
// thread, memory): there a guard counts nothing, and tests skip.
bool rt_guard_works() noexcept;

}  // namespace palpate::test
