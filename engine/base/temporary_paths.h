// What has to vanish when a signal ends the program: files and folders that are not
// yet whole.
//
// Thread guarantee: slow side, any thread; the clean-up reads them in a signal handler.
#pragma once

#include <string>

namespace palpate {

// Registers the file or folder of that name (up to 4095 bytes) before it exists or
// after; returns its slot, -1 when all 32 are taken: it is then merely not removed.
// A forked child never removes its parent's.
int register_temporary(const std::string& path) noexcept;
// It is whole, or gone. -1 is ignored.
void unregister_temporary(int slot) noexcept;

}  // namespace palpate
