#include "engine/base/temporary_paths.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/base/signals.h"

namespace palpate {
namespace {

constexpr std::size_t kPathBytes = 4096;  // PATH_MAX on Linux
constexpr int kSlots = 32;
// A report is two folders deep; a link that leads in circles must not go on forever.
constexpr int kDeepest = 4;

enum SlotState : int { kFree, kFilling, kLive };

struct Slot {
  std::atomic<int> state{kFree};
  pid_t owner = 0;
  char path[kPathBytes] = {};
};
static_assert(std::atomic<int>::is_always_lock_free, "read by a signal handler");

std::array<Slot, kSlots> slots;

void remove_content(int folder, int deeper) noexcept;

// System calls only: readdir allocates, and this runs in a signal handler.
void remove_entry(int folder, const char* name, int deeper) noexcept {
  if (unlinkat(folder, name, 0) == 0 || errno != EISDIR || deeper == 0) return;
  const int inner = openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (inner < 0) return;
  remove_content(inner, deeper - 1);
  close(inner);
  unlinkat(folder, name, AT_REMOVEDIR);
}

// As getdents64 fills it: inode, offset, the entry's bytes, its type, its name.
struct EntryHead {
  std::uint64_t inode;
  std::int64_t offset;
  std::uint16_t bytes;
};
constexpr std::size_t kNameOffset = 19;

void remove_content(int folder, int deeper) noexcept {
  alignas(8) char entries[1024];
  for (long size = 1; size > 0;) {
    size = syscall(SYS_getdents64, folder, entries, sizeof entries);
    for (long at = 0; at < size;) {
      EntryHead head{};
      std::memcpy(&head.bytes, entries + at + offsetof(EntryHead, bytes), sizeof head.bytes);
      const char* const name = entries + at + kNameOffset;
      if (std::strcmp(name, ".") != 0 && std::strcmp(name, "..") != 0) remove_entry(folder, name, deeper);
      at += head.bytes;
    }
  }
}

void remove_temporary_paths() noexcept {
  for (const Slot& slot : slots) {
    if (slot.state.load() == kLive && slot.owner == getpid()) remove_entry(AT_FDCWD, slot.path, kDeepest);
  }
}

}  // namespace

int register_temporary(const std::string& path) noexcept {
  set_clean_up(CleanUp::remove_files, remove_temporary_paths);
  if (path.size() >= kPathBytes) return -1;
  for (int i = 0; i < kSlots; ++i) {
    Slot& slot = slots[static_cast<std::size_t>(i)];
    int expected = kFree;
    if (!slot.state.compare_exchange_strong(expected, kFilling)) continue;
    std::memcpy(slot.path, path.c_str(), path.size() + 1);
    slot.owner = getpid();
    slot.state.store(kLive);
    return i;
  }
  return -1;
}

void unregister_temporary(int slot) noexcept {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].state.store(kFree);
}

}  // namespace palpate
