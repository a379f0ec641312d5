#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr double kDriven_s = 1.0;
constexpr double kStep_s = 0.002;
// The watchdog stops 50 ms after the last frame and reports it with the next sample (10 ms at 100 Hz); the rest allows
// for delays of the line and of a busy computer.
constexpr double kStopsWithin_s = 0.1;
constexpr double kPatience_s = 0.5;

class BridgeTest {
 public:
  explicit BridgeTest(OpenedDevice opened) : opened_(std::move(opened)) {}

  Result<std::string> run() {
    step_until(kDriven_s, Host::alive, [] { return false; });
    const auto silence_s = time_to_stop(Host::silent);
    const bool woke = wakes();
    const auto stands_still_s = silence_s && woke ? time_to_stop(Host::hung) : std::nullopt;
    wakes();
    const std::string& path = opened_.info.path;
    const std::string stopped = path + ": the device did not report within 100 ms that its watchdog stopped it after ";
    const std::string advice = " (status bit 2); do not touch the device before this works";
    if (gone_) return Error{path + ": the line ended during the test; run the test again"};
    if (round_trips_s_.empty()) {
      return Error{path +
                   ": the device confirms no frame of the host; bytes 22 and 23 must be the low half of its sequence"};
    }
    if (!silence_s) return Error{stopped + "the last frame" + advice};
    if (!woke) {
      return Error{path + ": the device stays stopped after valid frames return; clear status bit 2 when they return"};
    }
    if (!stands_still_s) return Error{stopped + "the heartbeat stood still" + advice};
    const auto ms = [](double s) { return fixed(1e3 * s, 2) + " ms"; };
    const double interval_s = part(intervals_s_, 0.5);
    return path + "\n  samples     " + fixed(interval_s > 0.0 ? 1.0 / interval_s : 0.0, 0) +
           " a second by the device's clock\n  round trip  median " + ms(part(round_trips_s_, 0.5)) +
           ", 99th percentile " + ms(part(round_trips_s_, 0.99)) + "\n  position    " + fixed(1e-6 * last_.counts, 3) +
           " mm\n  force       " +
           (std::isfinite(last_.measured_N) ? fixed(last_.measured_N, 3) + " N measured" : "not measured") +
           "\n  drive       " +
           (driving_ ? "yes, it got a force of 0" : "no, the device never reported that it drives (status bit 1)") +
           "\n  watchdog    stopped " + ms(*silence_s) + " after the last frame (limit 50 ms, reported with a sample)" +
           "\n  heartbeat   stopped " + ms(*stands_still_s) + " after it stood still (limit 50 ms)\n";
  }

 private:
  // What the host sends: no frames; frames with a constant heartbeat, as when its haptics thread hangs; valid frames.
  enum class Host { silent, hung, alive };

  void send(Host host) {
    if (host == Host::alive) ++heartbeat_;
    const OutReports reports =
        kBridgeProtocol.encode_command({.sequence = ++sequence_, .heartbeat = heartbeat_, .drive = drive_});
    opened_.connection->write(reports.bytes[0].data(), reports.sizes[0]);
    last_sent_s_ = steady_now_s();
    sent_at_s_[sequence_ & 0xFFFF] = last_sent_s_;
  }

  void take(const DeviceReading& reading) {
    driving_ = driving_ || reading.driving;
    stopped_ = reading.stopped;
    intervals_s_.push_back(1e-6 * (reading.time_us - last_.time_us));
    if (reading.confirmed != last_.confirmed && sent_at_s_[reading.confirmed] > 0.0)
      round_trips_s_.push_back(steady_now_s() - sent_at_s_[reading.confirmed]);
    last_ = reading;
  }

  // Sends and reads for `span_s`. Returns true if `done` ended it.
  bool step_until(double span_s, Host host, const auto& done) {
    double next_s = steady_now_s();
    for (const double until_s = next_s + span_s; steady_now_s() < until_s && !gone_;) {
      if (host != Host::silent && steady_now_s() >= next_s) {
        send(host);
        next_s += kStep_s;
      }
      std::uint8_t bytes[kLargestReport];
      const int size = opened_.connection->read(bytes, sizeof bytes);
      gone_ = size < 0;
      DeviceReading reading;
      const auto bytes_read = static_cast<std::size_t>(std::max(0, size));
      if (kBridgeProtocol.decode(bytes, bytes_read, reading) == ReportVerdict::position) take(reading);
      if (done()) return true;
    }
    return false;
  }

  std::optional<double> time_to_stop(Host host) {
    const double since_s = last_sent_s_;
    const bool shown = step_until(kPatience_s, host, [&] { return stopped_; });
    const double after_s = steady_now_s() - since_s;
    return shown && after_s <= kStopsWithin_s ? std::optional<double>(after_s) : std::nullopt;
  }

  // Sends valid frames again, first without `drive`. Returns whether the device leaves its stop.
  bool wakes() {
    drive_ = false;
    const bool woke = step_until(kPatience_s, Host::alive, [&] { return !stopped_; });
    step_until(0.05, Host::alive, [] { return false; });
    drive_ = true;
    return woke;
  }

  static double part(std::vector<double>& values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }

  OpenedDevice opened_;
  std::uint32_t sequence_ = 0;
  std::uint16_t heartbeat_ = 0;
  std::vector<double> sent_at_s_ = std::vector<double>(65536, 0.0);  // indexed by the low half of the sequence
  std::vector<double> intervals_s_, round_trips_s_;
  DeviceReading last_;
  double last_sent_s_ = 0.0;
  bool drive_ = true, driving_ = false, stopped_ = false, gone_ = false;
};

}  // namespace

Result<std::string> test_bridge(const std::string& target) {
  BridgeBus bus(target);
  Result<OpenedDevice> opened = bus.open_and_identify();
  if (!opened) return opened.error();
  return BridgeTest(std::move(*opened)).run();
}

}  // namespace palpate
