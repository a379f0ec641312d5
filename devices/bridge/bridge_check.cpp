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
    if (gone_) return Error{opened_.info.path + ": the line ended during the test; run the test again"};
    const std::string start = opened_.info.path + ": ";
    if (round_trips_s_.empty()) {
      return Error{start +
                   "the device confirms no frame of the host; bytes 22 and 23 must be the low half of its sequence"};
    }
    if (!silence_s) return Error{start + no_stop("after the last frame")};
    if (!woke)
      return Error{start + "the device stays stopped after valid frames return; clear status bit 2 when they return"};
    if (!stands_still_s) return Error{start + no_stop("after the heartbeat stood still")};
    return text(*silence_s, *stands_still_s);
  }

 private:
  // What the host sends: no frames; frames with a constant heartbeat, as when its haptics thread hangs; valid frames.
  enum class Host { silent, hung, alive };

  static std::string no_stop(const std::string& when) {
    return "the device did not report within 100 ms that its watchdog stopped it " + when +
           " (status bit 2); do not touch the device before this works";
  }

  void send(Host host) {
    if (host == Host::alive) ++heartbeat_;
    DeviceCommand command;
    command.sequence = ++sequence_;
    command.heartbeat = heartbeat_;
    command.drive = drive_;
    const OutReports reports = kBridgeProtocol.encode_command(command);
    opened_.connection->write(reports.bytes[0].data(), reports.sizes[0]);
    last_sent_s_ = steady_now_s();
    sent_at_s_[sequence_ & 0xFFFF] = last_sent_s_;
  }

  void take(const DeviceReading& reading) {
    driving_ = driving_ || reading.driving;
    stopped_ = reading.stopped;
    if (frames_++ > 0) intervals_s_.push_back(1e-6 * (reading.time_us - last_.time_us));
    lowest_nm_ = std::min(lowest_nm_, reading.counts);
    highest_nm_ = std::max(highest_nm_, reading.counts);
    if (reading.confirmed != last_.confirmed && sent_at_s_[reading.confirmed] > 0.0)
      round_trips_s_.push_back(steady_now_s() - sent_at_s_[reading.confirmed]);
    last_ = reading;
  }

  // Sends and reads for `span_s`. Returns true if `done` ended it.
  template <typename Done>
  bool step_until(double span_s, Host host, Done done) {
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
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }

  std::string text(double silence_s, double stands_still_s) {
    const auto ms = [](double s) { return fixed(1e3 * s, 2) + " ms"; };
    const double mean_s = part(intervals_s_, 0.5);
    return opened_.info.path + "\n  samples     " + fixed(mean_s > 0.0 ? 1.0 / mean_s : 0.0, 0) +
           " a second by the device's clock, " + ms(part(intervals_s_, 0.01)) + " to " + ms(part(intervals_s_, 0.99)) +
           " apart\n  round trip  " + "median " + ms(part(round_trips_s_, 0.5)) + ", 99th percentile " +
           ms(part(round_trips_s_, 0.99)) + "\n  position    " + fixed(1e-6 * last_.counts, 3) + " mm; it moved by " +
           fixed(1e-6 * (highest_nm_ - lowest_nm_), 3) + " mm in the test\n  force       " +
           (std::isfinite(last_.measured_N) ? fixed(last_.measured_N, 3) + " N measured" : "not measured") +
           "\n  drive       " +
           (driving_ ? "yes, it got a force of 0" : "no, the device never reported that it drives (status bit 1)") +
           "\n  watchdog    stopped " + ms(silence_s) + " after the last frame (limit 50 ms, reported with a sample)" +
           "\n  heartbeat   stopped " + ms(stands_still_s) + " after it stood still (limit 50 ms)\n";
  }

  OpenedDevice opened_;
  std::uint32_t sequence_ = 0;
  std::uint16_t heartbeat_ = 0;
  std::vector<double> sent_at_s_ = std::vector<double>(65536, 0.0);  // indexed by the low half of the sequence
  std::vector<double> intervals_s_, round_trips_s_;
  DeviceReading last_;
  int frames_ = 0;
  std::int32_t lowest_nm_ = INT32_MAX, highest_nm_ = INT32_MIN;
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
