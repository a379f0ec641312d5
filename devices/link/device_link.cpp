#include "devices/link/device_link.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <system_error>
#include <utility>

#include "engine/base/signals.h"
#include "engine/base/text.h"
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

}  // namespace palpate
