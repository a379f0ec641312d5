// Host and device in simulated time, without threads. The host is a LiveTick with a
// DeviceEndpoint; the device runs the reference firmware or is a model of an OpenFFBoard.
// A test may delay, change or drop the reports between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_firmware.h"
#include "devices/hid/hidapi_bus.h"
#include "devices/link/device_link.h"
#include "engine/live/live_tick.h"
#include "tests/support/live_doubles.h"

namespace palpate::test {

using Report = std::vector<std::uint8_t>;

inline DeviceCalibration example_calibration(const DeviceProtocol* protocol) {
  DeviceCalibration calibration;
  calibration.protocol = protocol;
  calibration.counts_per_metre = 50000.0;
  calibration.rest_position_m = -0.01;
  calibration.fastest_m_per_s = 5.0;
  calibration.force_N_per_unit = 0.0003;
  calibration.stuck_after_s = 0.5;
  calibration.limits = {5.0, 200.0, 0.1};
  calibration.limits.continuous_N = 4.5;
  calibration.limits.stale_after_s = 0.008;
  if (protocol->absolute) {
    calibration.counts_per_metre = 1e9;
    calibration.rest_position_m = 0.0;
    calibration.force_N_per_unit = 1e-6;
  }
  return calibration;
}

// The device. Time is in microseconds; `step` is called every SimulatedDevice::step_us, 250 us by default.
class DeviceModel {
 public:
  virtual ~DeviceModel() = default;
  virtual void hear(const Report& report) = 0;  // `report` excludes the report id 0
  virtual void step(std::uint32_t now_us, std::int32_t counts) = 0;
  virtual void restart() {}
  virtual double force_units() const = 0;  // force at the motor
  std::deque<Report> outbox;
};

// The effects manager of an OpenFFBoard, as in its source: each `new` makes another effect. It
// has no end until it gets a duration, which is then measured from its last start.
class OpenFfBoardModel final : public DeviceModel {
 public:
  void hear(const Report& report) override {
    if (report.size() != 25 || report[0] != 0xA1) return;
    const std::uint16_t object = wire::read16(report.data() + 2);
    const std::uint32_t command = wire::read32(report.data() + 5);
    const auto value = static_cast<std::int32_t>(wire::read32(report.data() + 9));
    if (object == 0xA03) hear_effect(command, value);
    if (object != 0xA01) return;
    Report answer = report;
    answer[1] = 10;
    wire::write32(answer.data() + 9, static_cast<std::uint32_t>(counts_));
    wire::write32(answer.data() + 13, counts_ < 0 ? 0xFFFFFFFFu : 0u);
    outbox.push_back(answer);
  }
  // Receives a request of the host for the position.
  void be_asked() {
    const OutReports asking = kOpenFfBoardProtocol.encode_command({});
    hear(Report(asking.bytes[0].begin(), asking.bytes[0].begin() + static_cast<std::ptrdiff_t>(asking.sizes[0])));
  }
  void step(std::uint32_t now_us, std::int32_t counts) override {
    now_ms_ = now_us / 1000;
    counts_ = counts;
    if (duration_ms_ != kNoEnd && now_ms_ - started_ms_ > duration_ms_) runs_ = false;
  }
  double force_units() const override { return active_ && exists_ && runs_ ? units_ : 0.0; }

 private:
  static constexpr std::uint32_t kNoEnd = 0xFFFF;

  void hear_effect(std::uint32_t command, std::int32_t value) {
    if (command == 0) active_ = value != 0;
    if (command == 1) active_ = exists_ = runs_ = false;
    if (command == 2) exists_ = value == 1;
    if (command == 2) duration_ms_ = kNoEnd;
    if (command == 4) units_ = value;
    if (command == 5) runs_ = value != 0;
    if (command == 5) started_ms_ = now_ms_;
    if (command == 7) duration_ms_ = static_cast<std::uint32_t>(value);
  }

  bool active_ = false, exists_ = false, runs_ = false;
  std::uint32_t now_ms_ = 0, started_ms_ = 0, duration_ms_ = kNoEnd;
  std::int32_t counts_ = 0;
  double units_ = 0.0;
};

// The reference firmware on a simulated board: one sample per millisecond, or every `period_us`.
class BridgeModel final : public DeviceModel {
 public:
  BridgeModel() { restart(); }
  void restart() override { firmware_ = std::make_unique<bridge::Firmware<BridgeModel>>(*this, 5'000'000); }
  void hear(const Report& report) override { inbox_.insert(inbox_.end(), report.begin(), report.end()); }
  void step(std::uint32_t now_us, std::int32_t counts) override {
    now_us_ = now_us;
    counts_ = counts;
    firmware_->loop();
  }
  double force_units() const override { return -pushed_uN_; }
  std::uint32_t period_us = 1000;
  std::function<std::uint32_t()> next_period_us;  // for irregular samples
  std::uint32_t samples = 0;
  double clock_drift = 0.0;  // relative error of the clock in its frames
  std::uint32_t clock_offset_us = 0;
  std::int32_t measured_uN = 250'000;  // of its force sensor

  // The functions of a board that bridge_firmware.h requires.
  std::uint32_t now_us() const { return now_us_; }
  bool receive(std::uint8_t& byte) {
    if (inbox_.empty()) return false;
    byte = inbox_.front();
    inbox_.pop_front();
    return true;
  }
  bool sample(std::uint32_t& time_us, std::int32_t& position_nm, std::int32_t& force_uN) {
    if (now_us_ - sampled_us_ < period_us) return false;
    sampled_us_ = now_us_;
    time_us = static_cast<std::uint32_t>(std::llround((1.0 + clock_drift) * now_us_)) + clock_offset_us;
    ++samples;
    if (next_period_us) period_us = next_period_us();
    position_nm = counts_;
    force_uN = measured_uN;
    return true;
  }
  std::uint8_t condition() const { return conditions; }
  std::uint8_t conditions = 0;
  void push(std::int32_t force_uN) { pushed_uN_ = force_uN; }
  void send(const std::uint8_t* frame) { outbox.emplace_back(frame, frame + bridge::kDeviceBytes); }

 private:
  std::unique_ptr<bridge::Firmware<BridgeModel>> firmware_;
  std::deque<std::uint8_t> inbox_;
  std::uint32_t now_us_ = 0, sampled_us_ = 0;
  std::int32_t counts_ = 0;
  std::int32_t pushed_uN_ = 99;  // until the firmware switches the motor off
};

inline std::unique_ptr<DeviceModel> device_model(const DeviceProtocol* protocol) {
  if (protocol == &kBridgeProtocol) return std::make_unique<BridgeModel>();
  return std::make_unique<OpenFfBoardModel>();
}

// Disturbances of the line, for SimulatedDevice::on_the_way_in.
using Reports = std::vector<Report>;
inline Reports lost(const Report&) { return {}; }
// Repeats the first report instead of each later one.
inline auto first_again() {
  return [first = Report()](const Report& report) mutable {
    if (first.empty()) first = report;
    return Reports{first};
  };
}
// Delivers each report only after `count` further ones.
inline auto late_by(std::size_t count) {
  return [count, queue = std::deque<Report>()](const Report& report) mutable {
    queue.push_back(report);
    if (queue.size() <= count) return Reports{};
    Reports oldest{queue.front()};
    queue.pop_front();
    return oldest;
  };
}
template <typename Change>
auto changed(Change change) {
  return [change](Report report) {
    change(report);
    return Reports{report};
  };
}

class SimulatedDevice {
 public:
  static constexpr double kStiffness_N_per_m = 650.0;  // 3.9 N at kHeld_m
  static constexpr double kHeld_m = 6e-3;
  static constexpr double kStart_s = 100.0;

  explicit SimulatedDevice(const DeviceProtocol* protocol) : SimulatedDevice(example_calibration(protocol)) {}
  explicit SimulatedDevice(const DeviceCalibration& of)
      : calibration(of), device(calibration), model(device_model(calibration.protocol)), live(device, slot_) {
    slot_.publish(std::make_unique<LiveModels>(1, device.sensor(), std::vector{spring(kStiffness_N_per_m)}));
    live.warm_up();
    device.connected(kStart_s);
    hear(calibration.protocol->encode_start());
  }

  // The position of the tool in the hand, with tremor.
  double position_m() const {
    const double tremor_m = 1e-4 * std::sin(2.0 * 3.14159265358979 * 9.0 * (now_s - kStart_s));
    return calibration.rest_position_m + inside_ * (kHeld_m + tremor_m - calibration.rest_position_m);
  }
  // The spring force, reduced by the stability limit for a late or slow line.
  double spring_N(double depth_m) const { return snapshot.stiffness_share * kStiffness_N_per_m * depth_m; }
  double motor_N() const { return std::abs(model->force_units() * calibration.force_N_per_unit); }

  // One haptics tick, with the work of the device and of the two I/O threads in that time.
  const LoopSnapshot& tick() {
    inside_ = rest ? 0.0 : std::min(1.0, inside_ + 0.02);
    for (int i = 0; i < 1000 / step_us; ++i) {
      now_us += step_us;
      now_s = kStart_s + 1e-6 * static_cast<double>(now_us);
      const double counts = calibration.counts_per_metre * (position_m() - calibration.rest_position_m);
      if (!encoder_frozen) counts_ = static_cast<std::int32_t>(std::lround(counts)) + counts_offset;
      model->step(static_cast<std::uint32_t>(now_us), counts_);
      deliver();
    }
    snapshot = live.run(now_s, controls);
    if (!writer_hangs) {
      const OutReports reports = device.next(now_s);
      if (reports.count > 0) device.written(now_s);
      hear(reports);
    }
    return snapshot;
  }
  void run_s(double span_s) {
    for (int i = 0; i < static_cast<int>(std::lround(1e3 * span_s)); ++i) tick();
  }
  void unplug() {
    unplugged = true;
    device.unplugged();
  }
  // Ends every disturbance.
  void mend() {
    on_the_way_in = nullptr;
    on_the_way_out = nullptr;
    encoder_frozen = writer_hangs = false;
    if (std::exchange(unplugged, false)) device.connected(now_s);
  }
  // The model of a bridge device.
  BridgeModel& board() { return dynamic_cast<BridgeModel&>(*model); }
  // Zeroes the device at rest, then presses into the block until the force is steady.
  void press() {
    rest = true;
    run_s(0.1);
    device.start_zeroing();
    run_s(0.3);
    rest = false;
    run_s(1.0);
  }

  std::int32_t counts() const { return counts_; }

  DeviceCalibration calibration;
  DeviceEndpoint device;
  std::unique_ptr<DeviceModel> model;
  LoopControls controls;
  LoopSnapshot snapshot;
  double now_s = kStart_s;
  std::int64_t now_us = 0;
  int step_us = 250;  // time step of the device; 1000 is a multiple of it
  bool rest = true;
  bool encoder_frozen = false;
  bool writer_hangs = false;
  bool unplugged = false;
  std::int32_t counts_offset = 0;
  // May change, drop or delay reports from the device: the host gets the returned ones.
  // Empty: no disturbance.
  std::function<Reports(const Report&)> on_the_way_in;
  std::function<bool(Report&)> on_the_way_out;  // false: the report is lost

 private:
  void deliver() {
    while (!model->outbox.empty()) {
      const Report report = model->outbox.front();
      model->outbox.pop_front();
      if (unplugged) continue;
      for (const Report& one : on_the_way_in ? on_the_way_in(report) : Reports{report}) {
        arrive(one);
      }
    }
  }
  // Bridge frames are sent as a stream of bytes.
  void arrive(const Report& one) {
    if (calibration.protocol != &kBridgeProtocol) return device.report_arrived(one.data(), one.size(), now_s);
    const std::uint8_t* at = one.data();
    std::uint8_t report[bridge::kDeviceBytes];
    while (const int size = frames_.next(at, one.data() + one.size(), report)) {
      device.report_arrived(report, static_cast<std::size_t>(size), now_s);
    }
  }
  void hear(const OutReports& reports) {
    for (std::size_t i = 0; i < reports.count; ++i) {
      const std::uint8_t* from = reports.bytes[i].data();
      const std::size_t skip = from[0] == 0 ? 1 : 0;
      Report report(from + skip, from + reports.sizes[i]);
      if (!unplugged && (!on_the_way_out || on_the_way_out(report))) model->hear(report);
    }
  }

  ModelSlot<LiveModels> slot_;
  BridgeReports frames_;
  std::int32_t counts_ = 0;
  double inside_ = 0.0;  // 0 at rest, 1 pressed in

 public:
  LiveTick live;
};

}  // namespace palpate::test
