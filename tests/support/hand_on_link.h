// A hand that holds a device behind a link with delay, jitter and groups, in simulated time: the program's own endpoint
// and tick, and a tool of which the device sends one sample after the other and applies the forces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "devices/bridge/bridge_bus.h"
#include "devices/link/device_link.h"
#include "engine/base/random_stream.h"
#include "engine/live/live_tick.h"
#include "scenes/hard/hard.h"

namespace palpate::test {

struct Link {
  double rate_Hz = 1000.0;
  int sample_group = 1, command_group = 1;  // so many are sent at once, when the last of them is there
  double delay_s = 0.0;                     // of the transport, half of it in each direction
  double jitter_s = 0.0;                    // largest further delay of each group
};

class HandOnLink {
 public:
  // Of the last second of the hold, in which the hand is still.
  struct Rest {
    double swing_m = 0.0;                        // peak to peak
    double given_J = 0.0;                        // energy from the device
    double least_share = 1.0, most_share = 0.0;  // of the stiffness, by StabilityLimit
    double force_N = 0.0;                        // the largest
    std::uint32_t faults = 0;                    // of the device
    double returned_J = 0.0;                     // of the whole press: what the device gave, less what it took
  };
  // `limited`: false renders the model's stiffness whatever the delay.
  HandOnLink(const Link& link, const Grip& grip, std::shared_ptr<const ForceModel> model, double encoder_m,
             bool limited = true)
      : link_(link),
        grip_(grip),
        device_(calibration(encoder_m), limited),
        live_(device_, slot_),
        encoder_m_(encoder_m) {
    slot_.publish(std::make_unique<LiveModels>(1, device_.sensor(), std::vector{std::move(model)}));
    live_.warm_up();
    device_.connected(kStart_s);
  }

  LoopControls controls;

  // Presses towards `aim_m` within 0.3 s, receives a pulse of 1 N at 0.6 s, holds still until 3 s, and leaves the
  // surface within 0.3 s.
  Rest run(double aim_m) {
    Rest result;
    double next_sample = 0.0, lowest_m = 1.0, highest_m = -1.0;
    constexpr double kLeaves_s = 3.0, kOut_s = 0.3;
    for (double time_s = 0.0; time_s < kLeaves_s + 2.0 * kOut_s; time_s = static_cast<double>(++step_) / kStepsPerS) {
      if (static_cast<double>(step_) >= next_sample) {
        next_sample += kStepsPerS / link_.rate_Hz;
        sample();
      }
      deliver();
      if (step_ % 20 == 0) tick();
      if (step_ % 10 == 5) send_command();
      const ClosedLoop::Drive drive = time_s < kLeaves_s ? minimum_jerk(-2e-3, aim_m, 0.3, time_s)
                                                         : minimum_jerk(aim_m, -2e-3, kOut_s, time_s - kLeaves_s);
      const double given_J = move(drive, time_s >= 0.6 && time_s < 0.62 ? 1.0 : 0.0);
      result.returned_J += given_J;
      if (time_s < kLeaves_s - 1.0 || time_s >= kLeaves_s) continue;
      result.given_J += given_J;
      lowest_m = std::min(lowest_m, position_m_);
      highest_m = std::max(highest_m, position_m_);
      const auto share = static_cast<double>(snapshot_.stiffness_share);
      result.least_share = std::min(result.least_share, share);
      result.most_share = std::max(result.most_share, share);
      result.faults |= snapshot_.device.faults;
      result.force_N = std::max(result.force_N, snapshot_.rendered_N);
    }
    result.swing_m = highest_m - lowest_m;
    return result;
  }

 private:
  static constexpr double kStepsPerS = 20000.0, kStart_s = 100.0;

  class Endpoint final : public DeviceEndpoint {
   public:
    Endpoint(const DeviceCalibration& calibration, bool limited) : DeviceEndpoint(calibration), limited_(limited) {}
    Holder holder() const noexcept override { return limited_ ? Holder::person : Holder::simulated; }

   private:
    bool limited_;
  };
  struct Frame {
    std::int64_t due = 0;
    bridge::FromDevice in{};
    bridge::FromHost out{};
  };
  using Frames = std::deque<Frame>;

  static DeviceCalibration calibration(double encoder_m) {
    DeviceCalibration calibration;
    calibration.protocol = &kBridgeProtocol;
    calibration.counts_per_metre = 1e9;
    calibration.encoder_step_m = encoder_m;
    calibration.fastest_m_per_s = 5.0;
    calibration.force_N_per_unit = 1e-6;
    calibration.stuck_after_s = 60.0;
    calibration.limits = {10.0, 5000.0, 0.0};
    return calibration;
  }

  // Sends a group when it is complete.
  void send(Frames& group, int size, Frames& line) {
    if (group.size() < static_cast<std::size_t>(size)) return;
    const double delay_s = 0.5 * link_.delay_s + random_.uniform(0.0, 1.0) * link_.jitter_s;
    const auto due = std::max(line.empty() ? 0 : line.back().due, step_ + std::lround(delay_s * kStepsPerS));
    for (Frame& frame : group) {
      frame.due = due;
      line.push_back(frame);
    }
    group.clear();
  }
  void sample() {
    Frame frame;
    frame.in = {++sequence_,
                static_cast<std::uint32_t>(50 * step_),
                static_cast<std::int32_t>(std::llround(1e9 * encoder_m_ * std::round(position_m_ / encoder_m_))),
                bridge::kNoForce,
                static_cast<std::uint8_t>(bridge::kDriving),
                static_cast<std::uint16_t>(confirmed_)};
    samples_.push_back(frame);
    send(samples_, link_.sample_group, up_);
  }
  void deliver() {
    const double now_s = kStart_s + static_cast<double>(step_) / kStepsPerS;
    for (; !up_.empty() && up_.front().due <= step_; up_.pop_front()) {
      std::uint8_t bytes[bridge::kDeviceBytes];
      encode(up_.front().in, bytes);
      device_.report_arrived(bytes, sizeof bytes, now_s);
    }
    for (; !down_.empty() && down_.front().due <= step_; down_.pop_front()) {
      acting_ = down_.front();
      confirmed_ = acting_.out.sequence;
    }
  }
  void tick() { snapshot_ = live_.run(kStart_s + static_cast<double>(step_) / kStepsPerS, controls); }
  void send_command() {
    const double now_s = kStart_s + static_cast<double>(step_) / kStepsPerS;
    const OutReports reports = device_.next(now_s);
    if (reports.count == 0) return;
    device_.written(now_s);
    Frame frame;
    decode(reports.bytes[0].data(), frame.out);
    commands_.push_back(frame);
    send(commands_, link_.command_group, down_);
  }
  // Returns the energy from the device.
  double move(const ClosedLoop::Drive& drive, double push_N) {
    const double force_N = (acting_.out.flags & bridge::kDrive) != 0 ? 1e-6 * acting_.out.force_uN : 0.0;
    const double drive_N = grip_.stiffness_N_per_m * (drive.aim_m - position_m_) +
                           grip_.damping_Ns_per_m * (drive.aim_m_per_s - velocity_m_per_s_) + push_N;
    const double before_m_per_s = velocity_m_per_s_;
    velocity_m_per_s_ += (drive_N - force_N) / grip_.mass_kg / kStepsPerS;
    const double way_m = 0.5 * (before_m_per_s + velocity_m_per_s_) / kStepsPerS;
    position_m_ += way_m;
    return -force_N * way_m;
  }

  Link link_;
  Grip grip_;
  Endpoint device_;
  ModelSlot<LiveModels> slot_;
  LiveTick live_;
  RandomStream random_{1, 67};
  LoopSnapshot snapshot_;
  double encoder_m_, position_m_ = -2e-3, velocity_m_per_s_ = 0.0;
  std::int64_t step_ = 0;
  std::uint32_t sequence_ = 0, confirmed_ = 0;
  Frame acting_;
  Frames samples_, up_, commands_, down_;
};

}  // namespace palpate::test
