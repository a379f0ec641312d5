// An emulated OpenFFBoard: sysfs entries and a hidraw node made by umockdev, which
// the real libhidapi enumerates, opens, reads and writes. A model of its firmware
// (tests/support/simulated_device.h) answers.
//
// Limitation of umockdev 0.17: poll() never reports its node as readable, so that
// only a blocking hid_read gets a report.
#pragma once

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/simulated_device.h"

namespace palpate::test {

class EmulatedBoard {
 public:
  EmulatedBoard();
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;
  ~EmulatedBoard();

  // Called by the node, on the thread of umockdev.
  bool ioctl(UMockdevIoctlClient* client);
  bool read(UMockdevIoctlClient* client);
  bool write(UMockdevIoctlClient* client);

  std::atomic<bool> gone{false};  // reads and writes fail
  std::atomic<double> motor_units{0.0};
  std::atomic<int> told_units{0};  // the last force written
  std::atomic<int> reads{0};
  std::atomic<int> writes{0};
  std::atomic<std::size_t> last_write_size{0};

 private:
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  OpenFfBoardModel board_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace palpate::test
