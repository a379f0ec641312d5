// One open byte stream in both directions: a serial line, a socket, a child program's
// standard input and output. Opening waits at most kConnect_ms; reading and writing
// never longer than they are told.
// Thread guarantee: slow side; `read` belongs to one thread and `write` to one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "devices/bridge/bridge_target.h"

namespace palpate {

class ByteStream {
 public:
  static constexpr int kConnect_ms = 3000;

  // Errors: why not, and what to do.
  static Result<std::unique_ptr<ByteStream>> open(const BridgeTarget& target);
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  // Ends a child program: SIGTERM, half a second later SIGKILL.
  ~ByteStream();

  // Bytes that came within `wait_ms`; 0: none; below 0: the other end is gone.
  int read(std::uint8_t* bytes, std::size_t capacity, int wait_ms) noexcept;
  // All of them or, when the other end takes none, none: what was taken of a piece goes
  // first the next time, so that pieces stay whole. False: not taken.
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept;
  int descriptor() const noexcept { return descriptor_; }
  // Why `read` ended: "the program ended with exit code 3".
  std::string end_words() noexcept;

 private:
  ByteStream(int descriptor, int child) noexcept : descriptor_(descriptor), child_(child) {}
  bool finish_piece() noexcept;

  int descriptor_;
  int child_;  // process; 0: none
  int exit_status_ = -1;
  std::uint8_t rest_[64] = {};
  std::size_t rest_size_ = 0;
};

}  // namespace palpate
