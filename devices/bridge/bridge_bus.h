// A bus with one device, that of a `bridge:` target. Its reports are the frames in the byte stream.
// Thread guarantee: as DeviceBus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "devices/firmware/bridge_protocol.h"
#include "devices/link/device_link.h"
#include "engine/base/result.h"

namespace palpate {

// An open bidirectional byte stream: a serial line, a socket, or a child program's standard input and output.
// Connecting waits at most kConnect_ms for each address; `read` waits as long as its argument says, `write` not at all.
// Thread guarantee: slow side; one thread may call `read` and another one `write`.

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

// A count is 1 nm. A unit of force is 1 uN and positive towards increasing positions. Decodes reports of BridgeReports.
extern const DeviceProtocol kBridgeProtocol;

// Divides the byte stream into reports: a frame with a valid checksum; one byte for a gap, which is a run of bytes that
// belong to no frame; the first four bytes of a frame of another version with a valid checksum. One thread; wait-free,
// never throws.
class BridgeReports {
 public:
  // Consumes bytes from `at` until `report` has a report of at most kDeviceBytes. Returns its size; 0: all bytes were
  // consumed without one.
  int next(const std::uint8_t*& at, const std::uint8_t* end, std::uint8_t* report) noexcept {
    while (at != end) {
      const bridge::Found found = finder_.add(*at++);
      if (found == bridge::Found::nothing) continue;
      // The stream may begin within a frame, so bytes before the first frame are no gap.
      const bool in_gap = std::exchange(in_gap_, found == bridge::Found::skipped) || !any_frame_;
      if (in_gap_ && in_gap) continue;
      any_frame_ = any_frame_ || found == bridge::Found::frame;
      const unsigned size = in_gap_ ? 1 : (found == bridge::Found::frame ? bridge::kDeviceBytes : 4);
      std::memcpy(report, finder_.frame(), size);
      return static_cast<int>(size);
    }
    return 0;
  }
  bool any_frame() const noexcept { return any_frame_; }

 private:
  bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice> finder_;
  bool any_frame_ = false;
  bool in_gap_ = false;  // the last bytes were skipped
};

class BridgeBus final : public DeviceBus {
 public:
  // `target`: see ByteStream::open.
  explicit BridgeBus(std::string target);

  std::vector<DeviceNode> list() override { return {info_}; }
  // Does not wait for a frame.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode&) override;

  // Opens the device and measures the rate of its first frames. Waits for them up to 4 s (20 s for a program), because
  // a board that resets when its port is opened takes two seconds. Errors: those of ByteStream; no frames, fewer than
  // 100 or more than 10000 a second, a clock that does not count us, a sequence that does not count, another version, a
  // program that ended; interrupted.
  Result<OpenedDevice> open_and_identify();

 private:
  std::string target_;
  DeviceNode info_;
};

// Tests the watchdog of a device without force: it drives with force 0, then stops the frames, later only the
// heartbeat. Each time the status of the device must report the stop within 100 ms. Returns the measurements as text.
// Errors: those of open_and_identify; the requirement that was not met.
Result<std::string> test_bridge(const std::string& target);

}  // namespace palpate
