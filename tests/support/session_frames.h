// Frames of a live session without a window.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "scenes/live/live_session.h"

namespace palpate::test {

// Without real-time priority, which tests do not need.
inline SessionRequest session_request(const std::string& scene, const std::string& device,
                                      const std::vector<std::string>& models) {
  SessionRequest request;
  request.scene = scene;
  request.device = device;
  request.models = models;
  request.realtime = false;
  return request;
}

// Runs frames until `done` and calls `each` after every frame. False after a long timeout.
inline bool frames_until(LiveSession& session, const std::function<bool()>& done,
                         const std::function<void()>& each = {}) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    session.update();
    if (each) each();
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  return true;
}

}  // namespace palpate::test
