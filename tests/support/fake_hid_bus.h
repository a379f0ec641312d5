// A bus with one device in real time: the reference firmware, or reports that a
// test made up; it can be unplugged, refuse to be opened and be slow to write to.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "devices/hid/hid_bus.h"
#include "tests/support/simulated_device.h"

namespace palpate::test {

inline HidDeviceInfo found_teensy() { return {"/dev/hidraw7", "Teensyduino RawHID", 0x16C0, 0x0486, 0xFFAB, 0x0200}; }
inline HidDeviceInfo found_space_mouse() { return {"/dev/hidraw8", "SpaceNavigator", 0x046D, 0xC626, 1, 8}; }

class FakeHidBus final : public HidBus {
 public:
  explicit FakeHidBus(HidDeviceInfo found = found_teensy()) : found_(std::move(found)) {}

  std::vector<HidDeviceInfo> list() override {
    return plugged_in ? std::vector<HidDeviceInfo>{found_} : std::vector<HidDeviceInfo>{};
  }
  Result<std::unique_ptr<HidConnection>> open(const HidDeviceInfo&) override {
    ++opened;
    if (refusals > 0) {
      --refusals;
      return Error{found_.path + ": no permission"};
    }
    return Result<std::unique_ptr<HidConnection>>(std::make_unique<Line>(*this));
  }

  // Any thread.
  double motor_mA() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return paddle_.force_units();
  }

  std::atomic<bool> plugged_in{true};
  std::atomic<int> refusals{0};
  std::atomic<int> opened{0};
  std::atomic<int> writes{0};
  std::atomic<int> write_ms{0};  // how long each takes
  std::atomic<int> counts{0};    // of the encoder
  std::atomic<bool> silent{false};
  Report report;  // instead of the firmware's; before the threads start

 private:
  class Line final : public HidConnection {
   public:
    explicit Line(FakeHidBus& bus) : bus_(bus) {}
    int read(std::uint8_t* bytes, std::size_t) noexcept override {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!bus_.plugged_in) return -1;
      if (bus_.silent) return 0;
      const std::lock_guard<std::mutex> lock(bus_.mutex_);
      const Report next = bus_.report.empty() ? bus_.from_paddle() : bus_.report;
      std::copy(next.begin(), next.end(), bytes);
      return static_cast<int>(next.size());
    }
    bool write(const std::uint8_t* bytes, std::size_t size) noexcept override {
      std::this_thread::sleep_for(std::chrono::milliseconds(bus_.write_ms));
      if (!bus_.plugged_in) return false;
      ++bus_.writes;
      const std::lock_guard<std::mutex> lock(bus_.mutex_);
      bus_.paddle_.hear(Report(bytes + 1, bytes + size));
      return true;
    }

   private:
    FakeHidBus& bus_;
  };

  Report from_paddle() {
    while (paddle_.outbox.empty()) {
      const auto since = std::chrono::steady_clock::now() - start_;
      const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since).count();
      paddle_.step(static_cast<std::uint32_t>(us), counts);
      if (paddle_.outbox.empty()) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    const Report newest = paddle_.outbox.back();
    paddle_.outbox.clear();
    return newest;
  }

  HidDeviceInfo found_;
  std::mutex mutex_;
  PaddleModel paddle_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace palpate::test
