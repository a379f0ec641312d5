#include "tests/support/rt_guard.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_RT_GUARD 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define PALPATE_RT_GUARD 0
#endif
#endif
#ifndef PALPATE_RT_GUARD
#define PALPATE_RT_GUARD 1
#endif

#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace palpate::test {
namespace {

// Trivial types only: an allocation during thread start must not run a constructor.
thread_local bool counting = false;
thread_local RtOffences offences;

[[maybe_unused]] void count(int RtOffences::*kind) {
  if (counting) ++(offences.*kind);
}

}  // namespace

RtGuard::RtGuard() noexcept {
  offences = {};
  counting = PALPATE_RT_GUARD != 0;
}

RtGuard::~RtGuard() { counting = false; }

RtOffences RtGuard::stop() noexcept {
  counting = false;
  return offences;
}

bool rt_guard_works() noexcept { return PALPATE_RT_GUARD != 0; }

}  // namespace palpate::test

#if PALPATE_RT_GUARD

using palpate::test::count;
using palpate::test::RtOffences;

extern "C" {

// glibc's entry points are used because dlsym would allocate.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) noexcept {
  count(&RtOffences::allocations);
  return __libc_malloc(size);
}

void* calloc(std::size_t number, std::size_t size) noexcept {
  count(&RtOffences::allocations);
  return __libc_calloc(number, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  count(&RtOffences::allocations);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count(&RtOffences::allocations);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count(&RtOffences::allocations);
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  count(&RtOffences::allocations);
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  void* result = __libc_memalign(alignment, size);
  if (result == nullptr) return ENOMEM;
  *block = result;
  return 0;
}

void free(void* block) noexcept {
  if (block != nullptr) count(&RtOffences::deallocations);
  __libc_free(block);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static Lock next = nullptr;  // a dynamically initialised static could lock
  if (next == nullptr) next = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  count(&RtOffences::locks);
  return next(mutex);
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* request, timespec* remaining) {
  count(&RtOffences::sleeps);
  return syscall(SYS_clock_nanosleep, clock, flags, request, remaining) == 0 ? 0 : errno;
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  count(&RtOffences::writes);
  return syscall(SYS_write, descriptor, bytes, size);
}

}  // extern "C"

#endif
