#include "devices/link/device_link.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "engine/base/files.h"
#include "engine/base/signals.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr int kOpenTries = 6;
constexpr auto kBetweenTries = std::chrono::milliseconds(100);
// A device that takes no report for this time has stopped by its own watchdog.
constexpr double kStopTaken_s = 0.05;
// Real-time priority below the 80 of the haptics thread.
constexpr int kPriority = 70;

// Searches the bus once, as open_first.
Result<OpenedDevice> try_open(DeviceBus& bus, const std::vector<const DeviceProtocol*>& protocols) {
  std::string problems;
  for (const DeviceNode& info : bus.list()) {
    const auto needed =
        std::find_if(protocols.begin(), protocols.end(), [&](const DeviceProtocol* one) { return one->matches(info); });
    if (needed == protocols.end()) continue;
    Result<std::unique_ptr<DeviceConnection>> connection = bus.open(info);
    if (connection) return OpenedDevice{info, *needed, std::move(*connection)};
    problems += (problems.empty() ? "" : "; ") + connection.error().message;
  }
  if (!problems.empty()) return Error{problems};
  return OpenedDevice{};
}

constexpr int kFree = -1, kReserved = -2;

struct Slot {
  std::atomic<int> descriptor{kFree};
  OutReports reports;  // fixed while descriptor >= 0
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, 8> slots;

// The number of unfinished writes of forces, and whether new ones are refused. Both are sequentially consistent: all
// threads see their changes in the same order.
std::atomic<int> writes_under_way{0};
std::atomic<bool> no_more_forces{false};
constexpr int kLongestWrite_ms = 20;  // several times the duration of a report on USB
// A child program is ended together with this one; before, it has to take the stop: three samples at 100 Hz.
constexpr int kTaken_ms = 30;

// Async-signal-safe.
void stop_all_devices() noexcept {
  no_more_forces.store(true);
  // The wait is bounded, because this handler may have interrupted the thread that writes.
  for (int i = 0; i < kLongestWrite_ms && writes_under_way.load() > 0; ++i) poll(nullptr, 0, 1);
  bool any = false;
  for (Slot& slot : slots) {
    const int descriptor = slot.descriptor.load(std::memory_order_acquire);
    if (descriptor < 0) continue;
    any = true;
    for (std::size_t i = 0; i < slot.reports.count; ++i) {
      // A signal handler cannot react to an error.
      [[maybe_unused]] const ssize_t written = ::write(descriptor, slot.reports.bytes[i].data(), slot.reports.sizes[i]);
    }
  }
  if (any) poll(nullptr, 0, kTaken_ms);
}

}  // namespace

Result<OpenedDevice> open_first(DeviceBus& bus, const std::vector<const DeviceProtocol*>& protocols) {
  Result<OpenedDevice> opened = try_open(bus, protocols);
  for (int more = 1; !opened && more < kOpenTries; ++more) {
    std::this_thread::sleep_for(kBetweenTries);
    opened = try_open(bus, protocols);
  }
  return opened;
}

DeviceLink::DeviceLink(DeviceBus& bus, LinkListener& listener, OpenedDevice opened)
    : bus_(bus),
      listener_(listener),
      info_(std::move(opened.info)),
      protocol_(*opened.protocol),
      connection_(std::move(opened.connection)) {}

DeviceLink::~DeviceLink() { stop(); }

std::string DeviceLink::description() const {
  return std::string(protocol_.description) + ": " + printable(info_.product, 80) + ", " + info_.path + "; tested " +
         kTestedOn;
}

std::shared_ptr<DeviceConnection> DeviceLink::connection() noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connection_;
}

void DeviceLink::use(std::shared_ptr<DeviceConnection> next) noexcept {
  const int earlier = stop_slot_;
  const bool stops = next != nullptr && protocol_.renders_force && next->descriptor() >= 0;
  stop_slot_ = stops ? register_device_stop(next->descriptor(), protocol_.encode_stop()) : -1;
  std::unique_lock<std::mutex> lock(mutex_);
  connection_.swap(next);
  lock.unlock();
  unregister_device_stop(earlier);  // `next` keeps the earlier connection open until here
}

Status DeviceLink::start() {
  use(connection());
  write(*connection(), protocol_.encode_start());
  listener_.connected(steady_now_s());
  try {
    reader_ = std::thread([this] { read_all(); });
    if (protocol_.renders_force) writer_ = std::thread([this] { write_all(); });
  } catch (const std::system_error& error) {
    stop();
    return Error{std::string("cannot start a thread for the device: ") + error.what() + "; close other programs"};
  }
  return {};
}

void DeviceLink::stop() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  if (writer_.joinable()) writer_.join();
  // The stop is sent before the reader ends, because the reader may wait for an idle device.
  const double until_s = steady_now_s() + kStopTaken_s;
  for (std::shared_ptr<DeviceConnection> last = connection(); last != nullptr; last = connection()) {
    if (write(*last, protocol_.encode_stop()) || steady_now_s() >= until_s) break;
    last.reset();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  closed_.store(true, std::memory_order_relaxed);
  if (reader_.joinable()) reader_.join();
  use(nullptr);
}

void DeviceLink::read_all() noexcept {
  make_this_thread_realtime(kPriority, false);
  std::array<std::uint8_t, kLargestReport + 1> bytes{};
  while (!closed_.load(std::memory_order_relaxed)) {
    const std::shared_ptr<DeviceConnection> current = connection();
    if (current == nullptr) {
      look_again();
      continue;
    }
    const int size = current->read(bytes.data(), bytes.size());
    if (size > 0) listener_.report_arrived(bytes.data(), static_cast<std::size_t>(size), steady_now_s());
    if (size < 0 && !stop_.load(std::memory_order_relaxed)) {
      listener_.unplugged();
      use(nullptr);
    }
  }
  // A program that this thread has started gets a signal when the thread ends, so that it has to end before.
  use(nullptr);
}

void DeviceLink::look_again() noexcept {
  for (double waited_s = 0.0; waited_s < kLookAgain_s; waited_s += 0.01) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (stop_.load(std::memory_order_relaxed)) return;
  }
  Result<OpenedDevice> opened = try_open(bus_, {&protocol_});
  if (!opened || opened->connection == nullptr) return;
  write(*opened->connection, protocol_.encode_start());
  listener_.connected(steady_now_s());
  use(std::move(opened->connection));
}

bool DeviceLink::write(DeviceConnection& connection, const OutReports& reports) noexcept {
  bool good = reports.count > 0;
  for (std::size_t i = 0; i < reports.count; ++i) {
    if (!begin_force_write()) return false;
    good = connection.write(reports.bytes[i].data(), reports.sizes[i]) && good;
    end_force_write();
  }
  if (good) listener_.written(steady_now_s());
  return good;
}

void DeviceLink::write_all() noexcept {
  make_this_thread_realtime(kPriority, false);
  SteadyPacer pacer;
  Deadlines deadlines(pacer.now_ns(), kWritePeriod_ns);
  while (!stop_.load(std::memory_order_relaxed)) {
    pacer.wait_until(deadlines.next_ns());
    deadlines.wake(pacer.now_ns());
    if (const std::shared_ptr<DeviceConnection> current = connection()) write(*current, listener_.next(steady_now_s()));
  }
}

int register_device_stop(int descriptor, const OutReports& reports) noexcept {
  stop_forces_by(stop_all_devices);
  install_signal_handlers();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    int free = kFree;
    if (!slots[i].descriptor.compare_exchange_strong(free, kReserved)) continue;
    slots[i].reports = reports;
    slots[i].descriptor.store(descriptor, std::memory_order_release);
    return static_cast<int>(i);
  }
  return -1;
}

void unregister_device_stop(int slot) noexcept {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].descriptor.store(kFree, std::memory_order_release);
}

bool begin_force_write() noexcept {
  writes_under_way.fetch_add(1);
  if (!no_more_forces.load()) return true;
  end_force_write();
  return false;
}

void end_force_write() noexcept { writes_under_way.fetch_sub(1); }

DeviceEndpoint::DeviceEndpoint(const DeviceCalibration& calibration, std::string name) noexcept
    : calibration_(calibration), name_(std::move(name)), monitor_(calibration) {
  publish_state();
}

SensorSpec DeviceEndpoint::sensor() const noexcept {
  return {.encoder_step_m = std::max(calibration_.encoder_step_m, 1.0 / calibration_.counts_per_metre)};
}

void DeviceEndpoint::connected(double now_s) noexcept {
  last_written_s_.store(now_s, std::memory_order_relaxed);
  connected_at_s_.store(now_s, std::memory_order_relaxed);
  connected_ = true;
  publish_state();
}

void DeviceEndpoint::unplugged() noexcept {
  monitor_.unplugged();
  connected_ = false;
  publish_state();
}

void DeviceEndpoint::publish_state() noexcept {
  MonitorState state = monitor_.state();
  if (!connected_) state.health.faults = device_fault::kUnplugged;
  state_.write(state);
}

void DeviceEndpoint::report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept {
  if (zeroing_asked_.exchange(false, std::memory_order_relaxed)) monitor_.start_zeroing();
  const MonitorState before = monitor_.state();
  DeviceReading reading;
  const ReportVerdict verdict = calibration_.protocol->decode(bytes, size, reading);
  monitor_.update(verdict, reading, now_s, commanded_N_.load(std::memory_order_relaxed));
  if (monitor_.state().samples != before.samples) publish_sample(reading, now_s);
  publish_state();
}

// By the confirmed command, in the device's own clock: exact, however samples and commands were delayed, held or
// grouped. A new command may have replaced the one before just before this sample. Without confirmations, the force of
// a sample acts at most until the command that follows the next one. Commands of an earlier stream do not count.
ForceAge DeviceEndpoint::force_age(const DeviceReading& reading, double now_s) noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (!calibration_.protocol->confirms) {
    const double gap_s = now_s - std::exchange(arrived_s_, now_s);
    if (!(gap_s < StreamMonitor::kLongestSilence_s)) return {kUnknown, kUnknown};
    return {kUsb_s, gap_s + kUsb_s + kWaits_s};
  }
  if (std::exchange(aged_stream_, monitor_.state().streams) != monitor_.state().streams) began_us_ = reading.time_us;
  const std::uint64_t sent = sent_[reading.confirmed % sent_.size()].load(std::memory_order_relaxed);
  const auto from_us = static_cast<std::uint32_t>(sent);
  const bool known = (sent >> 32) == ((kFromSample >> 32) | (reading.confirmed & 0xFFFF)) &&
                     static_cast<std::int32_t>(from_us - began_us_) >= 0;
  const std::uint32_t before_us = std::exchange(acted_from_us_, from_us);
  if (!std::exchange(acted_known_, known) || !known) return {kUnknown, kUnknown};
  const auto since_s = [&](std::uint32_t us) { return 1e-6 * static_cast<std::int32_t>(reading.time_us - us); };
  return {since_s(from_us), since_s(before_us)};
}

void DeviceEndpoint::publish_sample(const DeviceReading& reading, double now_s) noexcept {
  const MonitorState& state = monitor_.state();
  const ForceAge age = force_age(reading, now_s);
  if (age.least_s > kWriteStalled_s) monitor_.fault(device_fault::kWriteStalled, now_s);
  if (state.lost != 0 || !state.health.may_push()) return;
  DeviceSample sample;
  sample.force_age = age;
  sample.tool.time_s = state.sample_time_s;
  const double counts = static_cast<double>(state.counts) - state.zero_counts;
  sample.tool.position_m =
      calibration_.rest_position_m + calibration_.direction * counts / calibration_.counts_per_metre;
  sample.measured_N = state.measured_N;
  sample.restart = state.streams != streams_published_;
  if (samples_.push({sample, state.samples, reading.time_us})) streams_published_ = state.streams;
}

OutReports DeviceEndpoint::next(double now_s) noexcept {
  const Command command = command_.newest();
  const bool fresh = command.heartbeat != last_heartbeat_;
  if (fresh) {
    last_heartbeat_ = command.heartbeat;
    last_beat_s_ = now_s;
  }
  const bool due = !calibration_.protocol->timed || command.sample != answered_;
  const double repeat_s = calibration_.protocol->timed ? kSlowestSample_s : kRepeat_s;
  // A change to no force is sent at once.
  const bool lets_go = fresh && command.force_N == 0.0 && commanded_N_.load(std::memory_order_relaxed) != 0.0;
  if (!(due && fresh) && !lets_go && last_sent_s_ >= 0.0 && now_s - last_sent_s_ < repeat_s) return {};
  last_sent_s_ = now_s;
  answered_ = command.sample;
  const bool haptics_live = now_s - last_beat_s_ < kHapticsSilent_s;
  const double peak_N = calibration_.limits.largest_N;
  const bool drives = haptics_live && std::isfinite(command.force_N);
  const double safe_N = drives ? std::clamp(command.force_N, -peak_N, peak_N) : 0.0;
  commanded_N_.store(safe_N, std::memory_order_relaxed);
  ++sequence_;
  const std::uint64_t from = (command.sample > 0 ? kFromSample : 0U) | std::uint64_t{sequence_ & 0xFFFF} << 32;
  sent_[sequence_ % sent_.size()].store(from | command.from_us, std::memory_order_relaxed);
  return calibration_.protocol->encode_command(
      {.sequence = sequence_,
       .heartbeat = last_heartbeat_,
       .drive = safe_N != 0.0,
       .units = -calibration_.direction * safe_N / calibration_.force_N_per_unit});
}

// After a pause of the haptics thread, skips old samples; `restart` is set if any of them began a new stream.
bool DeviceEndpoint::read(double, DeviceSample& sample) noexcept {
  bool restart = false;
  TimedSample next;
  do {
    if (!samples_.pop(next)) return false;
    restart = restart || next.sample.restart;
  } while (samples_.size() >= static_cast<std::size_t>(kMaxSamplesPerTick));
  sample = next.sample;
  sample.restart = restart;
  next_command_.sample = next.number;
  next_command_.from_us = next.time_us;
  return true;
}

void DeviceEndpoint::write(double force_N) noexcept {
  // Before the first sample, the force is 0 in any case. Later, the limiter ramps it down where necessary.
  next_command_.force_N = next_command_.sample > 0 ? force_N : 0.0;
  ++next_command_.heartbeat;
  command_.write(next_command_);
}

// `health` reports late samples; the limiter's own limit is the longest possible one.
ForceLimits DeviceEndpoint::limits() const noexcept {
  ForceLimits limits = calibration_.limits;
  if (calibration_.protocol->timed) limits.stale_after_s = StreamMonitor::kLongestSilence_s;
  return limits;
}

bool DeviceEndpoint::stalled(const MonitorState& state, double now_s) const noexcept {
  if (now_s - last_written_s_.load(std::memory_order_relaxed) > kWriteStalled_s) return true;
  if (!calibration_.protocol->confirms) return false;
  const double confirmed_s = std::max(state.confirmed_at_s, connected_at_s_.load(std::memory_order_relaxed));
  return now_s - confirmed_s > kWriteStalled_s;
}

DeviceHealth DeviceEndpoint::health(double now_s) noexcept {
  const MonitorState& state = state_.newest();
  DeviceHealth health = state.health;
  if (state.samples > 0) health.sample_age_s = std::max(0.0, now_s - state.sample_time_s);
  if (health.faults == 0) {
    if (health.sample_age_s > state.late_after_s)
      health.faults |= device_fault::kLate | (state.corrupt > 0 ? device_fault::kCorrupt : 0U);
    if (stalled(state, now_s)) health.faults |= device_fault::kWriteStalled;
  }
  health.faults |= state.lost;
  if (now_s < state.transient_until_s) health.faults |= state.transient;
  return health;
}

namespace {

// The largest depth of nesting; the format needs one level.
constexpr int kCalibrationNesting = 4;

// Reads what only a device that renders force has.
void read_force(JsonFields& fields, const JsonNode& top, DeviceCalibration& calibration) {
  const auto number = [&](const char* key, double low, double high) { return fields.number(top, key, {low, high}); };
  ForceLimits& limits = calibration.limits;
  const std::size_t before = fields.error_count();
  calibration.fastest_m_per_s = number("fastest_m_per_s", 0.01, 100.0);
  calibration.force_N_per_unit = calibration.protocol->absolute ? 1e-6 : number("force_N_per_unit", 1e-9, 1e3);
  calibration.stuck_after_s = number("stuck_after_s", 0.05, 60.0);
  limits.largest_N = number("peak_N", 1e-3, 100.0);
  limits.continuous_N = number("continuous_N", 1e-3, 100.0);
  limits.thermal_time_s = number("thermal_time_s", 0.1, 1e4);
  limits.fastest_N_per_s = number("fastest_N_per_s", 1.0, 1e6);
  limits.ramp_s = number("ramp_s", 0.05, 10.0);
  limits.stale_after_s = number("stale_after_s", 0.002, 0.01);
  if (fields.error_count() == before && limits.continuous_N > limits.largest_N) {
    fields.complain("/continuous_N", found(top.value->at("continuous_N")) + ", expected at most peak_N");
  }
}

}  // namespace

Result<DeviceCalibration> read_calibration(const std::string& folder, const DeviceProtocol& protocol) {
  const std::string path = folder + "/" + protocol.name + ".json";
  const std::optional<std::string> text = read_whole_file(path);
  if (!text) return Error{path + ": cannot be read; set PALPATE_ASSETS to the assets folder (with assets/devices/)"};
  const Result<nlohmann::json> document = parse_json(*text, path, kCalibrationNesting, {});
  if (!document) return document.error();
  JsonFields fields(*text, path, "");
  const JsonNode top{&*document, ""};
  DeviceCalibration calibration;
  calibration.protocol = &protocol;
  fields.choice(fields.member(top, "kind", "the kind of device"), {protocol.name});
  if (protocol.absolute) {
    calibration.counts_per_metre = 1e9;
    calibration.encoder_step_m = fields.number(top, "encoder_step_m", {1e-9, 1e-3});
  } else {
    calibration.counts_per_metre = fields.number(top, "counts_per_metre", {1.0, 1e9});
  }
  calibration.direction = fields.number(top, "direction", {-1.0, 1.0});
  const JsonNode direction = fields.optional_member(top, "direction");
  if (direction.value != nullptr && std::abs(calibration.direction) != 1.0)
    fields.complain(direction.pointer, found(*direction.value) + ", expected 1 or -1");
  calibration.rest_position_m = fields.number(top, "rest_position_m", {-1.0, 1.0});
  if (protocol.renders_force) read_force(fields, top, calibration);
  fields.refuse_unknown(top);
  if (std::optional<Error> wrong = fields.error()) return *wrong;
  return calibration;
}

// Tolerance of a step beyond the fastest motion, in steps of the sensor.
constexpr double kNoiseSteps = 4.0;
// The speed is computed with at least this time step, because two reports may arrive in quick succession.
constexpr double kShortestStep_s = 1e-3;
// The least difference between the times of two samples.
constexpr double kLeastStep_s = 1e-6;

StreamMonitor::StreamMonitor(const DeviceCalibration& calibration) noexcept
    : calibration_(calibration), protocol_(*calibration.protocol) {
  state_.late_after_s = calibration.limits.stale_after_s;
  state_.health.zeroing = protocol_.absolute ? Zeroing::not_needed : Zeroing::needed;
}

void StreamMonitor::fault(std::uint32_t bit, double now_s) noexcept {
  if (now_s >= state_.transient_until_s) {
    state_.transient = 0;
    hold_s_ = now_s < state_.transient_until_s + kOften_s ? kOften_s : kHold_s;
  }
  state_.transient |= bit;
  state_.transient_until_s = now_s + hold_s_;
}

void StreamMonitor::lose(std::uint32_t bit, double now_s) noexcept {
  if (protocol_.absolute) {
    fault(bit, now_s);
    if (bit == device_fault::kJump) ++state_.streams;
    return;
  }
  state_.lost |= bit;
  state_.health.zeroing = Zeroing::needed;
  state_.health.zeroing_progress = 0.0F;
}

void StreamMonitor::unplugged() noexcept {
  connected_ = false;
  // A device with an absolute position keeps it; the link reports the loss of the connection.
  if (!protocol_.absolute) lose(device_fault::kUnplugged, 0.0);
}

void StreamMonitor::start_zeroing() noexcept {
  if (state_.health.zeroing == Zeroing::not_needed) return;
  state_.health.zeroing = Zeroing::hold_still;
  state_.health.zeroing_progress = 0.0F;
  zeroing_since_s_ = -1.0;
}

bool StreamMonitor::accept_untimed(double now_s) noexcept {
  const bool together = now_s - arrivals_s_[2] < kTogether_s;
  std::copy_backward(arrivals_s_, arrivals_s_ + 2, arrivals_s_ + 3);
  arrivals_s_[0] = now_s;
  read_time_s_ = now_s;
  if (together) fault(device_fault::kBurst, now_s);
  return !together;
}

bool StreamMonitor::accept_timed(const DeviceReading& reading, double now_s) noexcept {
  if (connected_ && static_cast<std::int32_t>(reading.sequence - last_.sequence) <= 0) {
    // A repeated report is ignored; the age of the sample grows until it is late.
    if (reading.sequence == last_.sequence) return false;
    refused_in_order_ = reading.sequence == refused_ + 1 ? refused_in_order_ + 1 : 0;
    refused_ = reading.sequence;
    if (refused_in_order_ < kStartedAgain) {
      fault(device_fault::kOutOfOrder, now_s);
      return false;
    }
    lose(device_fault::kReset, now_s);
    connected_ = false;
  }
  // After a pause, or when the device's clock was set back, a new stream begins: neither the fit of the clock nor the
  // motion continues.
  if (connected_) {
    const bool set_back = static_cast<std::int32_t>(reading.time_us - last_.time_us) <= 0;
    if (set_back) fault(device_fault::kReset, now_s);
    connected_ = !set_back && now_s - state_.sample_time_s <= kLongestSilence_s;
  }
  if (!connected_ && first_s_ < 0.0) {
    clock_ = {};
    first_s_ = now_s;
  }
  read_time_s_ = clock_.host_time_s(reading.time_us, now_s);
  if (!connected_ && now_s - first_s_ < kSettling_s) return false;
  late_ = now_s - read_time_s_ > (late_ ? kOnTimeAgain : 1.0) * state_.late_after_s;
  if (late_) fault(device_fault::kLate, now_s);
  return !late_;
}

// Unwraps the counter and checks the step for a jump.
void StreamMonitor::move(const DeviceReading& reading, double now_s) noexcept {
  if (!connected_) {
    state_.counts = reading.counts;
    speed_ = 0.0;
    return;
  }
  const std::int64_t step =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(reading.counts) - static_cast<std::uint32_t>(last_.counts));
  const double step_s = std::max(kShortestStep_s, read_time_s_ - state_.sample_time_s);
  const double quickest = speed_ + calibration_.counts_per_metre * kQuickest_m_per_s2 * step_s;
  const double fastest = std::min(quickest, calibration_.counts_per_metre * calibration_.fastest_m_per_s);
  const double noise = kNoiseSteps * std::max(1.0, calibration_.encoder_step_m * calibration_.counts_per_metre);
  const double distance = std::abs(static_cast<double>(step));
  const bool jumped = distance > fastest * step_s + noise;
  if (jumped) lose(device_fault::kJump, now_s);
  speed_ = jumped ? 0.0 : distance / step_s;
  state_.counts += step;
}

// No hand keeps a tool within a count for seconds against kFirm_N, nor while a smaller force changes; a small constant
// force is no evidence.
void StreamMonitor::watch_stuck(double now_s, double force_N) noexcept {
  const bool pushing = std::abs(force_N) >= kPushing_N;
  if (!pushing || !pushed_ || still_since_s_ == now_s) least_N_ = most_N_ = force_N;
  pushed_ = pushing;
  least_N_ = std::min(least_N_, force_N);
  most_N_ = std::max(most_N_, force_N);
  const bool evident = pushing && (std::abs(force_N) >= kFirm_N || most_N_ - least_N_ >= kPushing_N);
  // For a device without zeroing, only motion ends the fault: a small force does not.
  if (!evident && !(stuck_ && protocol_.absolute)) still_since_s_ = now_s;
  stuck_ = now_s - still_since_s_ > calibration_.stuck_after_s;
  if (stuck_) lose(device_fault::kStuck, now_s);
}

void StreamMonitor::watch_zeroing(double now_s) noexcept {
  if (state_.health.zeroing != Zeroing::hold_still) return;
  zeroing_from_ = std::min(zeroing_from_, state_.counts);
  zeroing_to_ = std::max(zeroing_to_, state_.counts);
  const double most = std::max(2.0, kRest_m * calibration_.counts_per_metre);
  if (zeroing_since_s_ < 0.0 || static_cast<double>(zeroing_to_ - zeroing_from_) > most) {
    zeroing_since_s_ = now_s;
    zeroing_from_ = zeroing_to_ = state_.counts;
  }
  const double share = (now_s - zeroing_since_s_) / kZeroing_s;
  state_.health.zeroing_progress = static_cast<float>(std::min(1.0, share));
  if (share < 1.0) return;
  state_.zero_counts = 0.5 * static_cast<double>(zeroing_from_ + zeroing_to_);
  state_.health.zeroing = Zeroing::done;
  state_.lost = 0;
  ++state_.streams;
}

void StreamMonitor::update(ReportVerdict verdict, const DeviceReading& reading, double now_s, double force_N) noexcept {
  if (verdict == ReportVerdict::corrupt) ++state_.corrupt;
  if (verdict == ReportVerdict::wrong_version) fault(device_fault::kWrongFirmware, now_s);
  if (reading.own_fault) fault(device_fault::kOwn, now_s);
  if (reading.stopped) fault(device_fault::kWriteStalled, now_s);
  if (verdict != ReportVerdict::position) return;
  if (!(protocol_.timed ? accept_timed(reading, now_s) : accept_untimed(now_s))) return;
  const std::int64_t before = state_.counts;
  move(reading, now_s);
  if (!connected_ && protocol_.absolute) ++state_.streams;
  if (!connected_ || state_.counts != before) still_since_s_ = now_s;
  if (!connected_ || reading.confirmed != last_.confirmed) state_.confirmed_at_s = now_s;
  const double before_s = state_.sample_time_s;
  state_.sample_time_s = std::max(read_time_s_, before_s + kLeastStep_s);
  if (connected_) {
    rate_.add(std::min(state_.sample_time_s - before_s, kHold_s));
    state_.health.interval_s = rate_.interval_s();
    if (rate_.too_slow()) fault(device_fault::kSlow, now_s);
  }
  if (protocol_.timed) {
    state_.late_after_s =
        std::clamp(kLateIntervals * state_.health.interval_s, calibration_.limits.stale_after_s, kLongestSilence_s);
  }
  state_.measured_N = reading.measured_N;
  state_.health.grip_held = reading.grip;
  ++state_.samples;
  state_.corrupt = 0;
  last_ = reading;
  connected_ = true;
  first_s_ = -1.0;
  watch_stuck(now_s, force_N);
  watch_zeroing(now_s);
}

}  // namespace palpate
