// A bridge device in real time: a peer process, and a loop that renders a spring.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/registry/device_registry.h"
#include "engine/live/haptics_loop.h"
#include "tests/support/live_doubles.h"

namespace palpate::test {

// A child process; the destructor kills it.
class ChildProcess {
 public:
  explicit ChildProcess(const std::vector<std::string>& command)
      : ChildProcess([&command] {
          std::vector<char*> words;
          for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
          words.push_back(nullptr);
          execvp(words[0], words.data());
        }) {}
  explicit ChildProcess(const std::function<void()>& run) : pid_(fork()) {
    if (pid_ != 0) return;
    run();
    _exit(127);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess() { stop(); }
  void stop() {
    if (pid_ > 0) end(SIGKILL);
  }
  // Sends `signal` and waits. Returns the exit code, or 128 + n if signal n ended the process.
  int end(int signal) {
    int status = 0;
    kill(pid_, signal);
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  pid_t pid_;
};

// Polls `done` every 10 ms. False if it is not true within `seconds`.
inline bool wait_for(const std::function<bool()>& done, int seconds = 20) {
  for (int i = 0; i < 100 * seconds; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// The loop on an open device, with a spring or another model.
class SpringSession {
 public:
  static constexpr double kStiffness_N_per_m = 1000.0;

  explicit SpringSession(std::unique_ptr<Device> device,
                         const std::shared_ptr<const ForceModel>& model = spring(kStiffness_N_per_m))
      : device_(std::move(device)), loop_(*device_) {
    loop_.publish_models(std::make_unique<LiveModels>(1, device_->sensor(), std::vector{model}));
    started_ = loop_.start().ok();
  }
  ~SpringSession() {
    loop_.stop();
    device_->close();
  }
  bool started() const { return started_; }
  HapticsLoop& loop() { return loop_; }
  // All snapshots since the last call.
  std::vector<LoopSnapshot> snapshots() {
    std::vector<LoopSnapshot> all(kSnapshotRing);
    all.resize(loop_.read_snapshots(all.data(), all.size()));
    return all;
  }

 private:
  std::unique_ptr<Device> device_;
  HapticsLoop loop_;
  bool started_ = false;
};

inline Result<std::unique_ptr<Device>> open_bridge(const std::string& target) {
  DeviceRequest request;
  request.calibrations = std::string(PALPATE_SOURCE_DIR) + "/assets/devices";
  return open_device("bridge:" + target, request);
}

}  // namespace palpate::test
