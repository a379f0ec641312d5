// An open bidirectional byte stream: a serial line, a socket, or a child program's standard input and output.
// Connecting waits at most kConnect_ms for each address; `read` waits as long as its argument says, `write` not at all.
// Thread guarantee: slow side; one thread may call `read` and another one `write`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/result.h"

namespace palpate {

// The option --bridge-remote, before a device is opened: bridge:tcp: may name another computer, in this process.
void allow_remote_bridges() noexcept;

class ByteStream {
 public:
  static constexpr int kConnect_ms = 3000;

  // `target`: "/dev/TTY[,BAUD]", "unix:PATH", "tcp:HOST:PORT", "exec:COMMAND". The default is 1 Mbaud. Errors:
  // another form; it cannot be opened, with the reason and what to do.
  static Result<std::unique_ptr<ByteStream>> open(const std::string& target);
  // Owns the descriptor and the child process; `child`: its id, 0 for none.
  explicit ByteStream(int descriptor, int child = 0) noexcept : descriptor_(descriptor), child_(child) {}
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  // The other end gets the end of its input and time to take what was written before, the last force of 0 among it: a
  // socket 0.1 s, a child program half a second, then SIGTERM and as long again, then SIGKILL.
  ~ByteStream();

  // Returns the number of bytes that arrived within `wait_ms`; 0: none; below 0: the other end is gone.
  int read(std::uint8_t* bytes, std::size_t capacity, int wait_ms) noexcept;
  // Writes at most 64 bytes, all or none. If the system takes only a part, the next call sends the rest first, so that
  // frames stay whole. False: nothing was written.
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept;
  int descriptor() const noexcept { return descriptor_; }
  // Why the stream ended: "the program ended with exit code 3".
  std::string end_words() noexcept;

 private:
  bool other_end_closes(double within_s) noexcept;

  int descriptor_, child_, exit_status_ = -1;
  std::uint8_t rest_[64] = {};
  std::size_t rest_size_ = 0;
};

}  // namespace palpate
