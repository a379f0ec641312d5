// A bus with one device in real time: an OpenFFBoard, or reports made by a test.
// The device can be unplugged, refuse to be opened, and be slow to write to.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include "devices/link/device_link.h"
#include "tests/support/simulated_device.h"

namespace palpate::test {

inline DeviceNode found_board() { return {"/dev/hidraw7", "FFBoard", 0x1209, 0xFFB0, 0xFF00, 1}; }
inline DeviceNode found_space_mouse() { return {"/dev/hidraw8", "SpaceNavigator", 0x046D, 0xC626, 1, 8}; }

class FakeDeviceBus final : public DeviceBus {
 public:
  explicit FakeDeviceBus(DeviceNode found = found_board()) : found_(std::move(found)) {}

  std::vector<DeviceNode> list() override {
    return plugged_in ? std::vector<DeviceNode>{found_} : std::vector<DeviceNode>{};
  }
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode&) override {
    ++opened;
    if (refusals > 0) {
      --refusals;
      return Error{found_.path + ": no permission"};
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    board_.outbox.clear();  // drops reports from before the connection
    return Result<std::unique_ptr<DeviceConnection>>(std::make_unique<Line>(*this));
  }

  // May be called on any thread.
  double motor_units() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return board_.force_units();
  }

  std::atomic<bool> plugged_in{true};
  std::atomic<int> refusals{0};
  std::atomic<int> opened{0};
  std::atomic<int> writes{0};
  std::atomic<int> write_ms{0};  // duration of each write
  std::atomic<int> counts{0};    // encoder position
  std::atomic<bool> silent{false};
  Report report;  // replaces the board's reports; set before the threads start

 private:
  class Line final : public DeviceConnection {
   public:
    explicit Line(FakeDeviceBus& bus) : bus_(bus) {}
    int read(std::uint8_t* bytes, std::size_t) noexcept override {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!bus_.plugged_in) return -1;
      if (bus_.silent) return 0;
      const std::lock_guard<std::mutex> lock(bus_.mutex_);
      const Report next = bus_.report.empty() ? bus_.from_board() : bus_.report;
      std::copy(next.begin(), next.end(), bytes);
      return static_cast<int>(next.size());
    }
    bool write(const std::uint8_t* bytes, std::size_t size) noexcept override {
      std::this_thread::sleep_for(std::chrono::milliseconds(bus_.write_ms));
      if (!bus_.plugged_in) return false;
      ++bus_.writes;
      const std::lock_guard<std::mutex> lock(bus_.mutex_);
      bus_.step();
      bus_.board_.hear(Report(bytes, bytes + size));
      return true;
    }

   private:
    FakeDeviceBus& bus_;
  };

  void step() {
    const auto since = std::chrono::steady_clock::now() - start_;
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since).count();
    board_.step(static_cast<std::uint32_t>(us), counts);
  }
  // Empty if the host did not request a report.
  Report from_board() {
    step();
    if (board_.outbox.empty()) return {};
    const Report newest = board_.outbox.back();
    board_.outbox.clear();
    return newest;
  }

  DeviceNode found_;
  std::mutex mutex_;
  OpenFfBoardModel board_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace palpate::test
