#include "devices/hid/hid_link.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/live/pacer.h"
#include "engine/live/rt_thread.h"

namespace palpate {
namespace {

constexpr int kOpenTries = 6;
constexpr auto kBetweenTries = std::chrono::milliseconds(100);
constexpr auto kPause = std::chrono::milliseconds(10);
// Below the haptics thread's 80, above everything that is not real-time.
constexpr int kPriority = 70;

bool contains(const HidDrivers& drivers, const HidDriver* driver) {
  return std::find(drivers.begin(), drivers.end(), driver) != drivers.end();
}

// One look at the bus; what cannot be opened adds to `problems`.
std::optional<HidOpened> try_open(HidBus& bus, const HidDrivers& drivers, std::string& problems) {
  problems.clear();
  for (const HidDeviceInfo& info : bus.list()) {
    const HidDriver* const driver = matching_driver(info);
    if (driver == nullptr || !contains(drivers, driver)) continue;
    Result<std::unique_ptr<HidConnection>> connection = bus.open(info);
    if (connection) return HidOpened{info, driver, std::move(*connection)};
    problems += (problems.empty() ? "" : "; ") + connection.error().message;
  }
  return std::nullopt;
}

}  // namespace

Result<HidOpened> open_first(HidBus& bus, const HidDrivers& drivers, bool* none_found) {
  std::string problems;
  for (int i = 0; i < kOpenTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kBetweenTries);
    if (std::optional<HidOpened> opened = try_open(bus, drivers, problems)) {
      return Result<HidOpened>(std::move(*opened));
    }
    if (problems.empty()) break;
  }
  if (none_found != nullptr) *none_found = problems.empty();
  return Error{problems.empty() ? "no device that the program knows is plugged in" : problems};
}

HidLink::HidLink(HidBus& bus, HidListener& listener, HidOpened opened)
    : bus_(bus),
      listener_(listener),
      info_(std::move(opened.info)),
      driver_(*opened.driver),
      connection_(std::move(opened.connection)) {}

HidLink::~HidLink() { stop(); }

std::string HidLink::description() const {
  return std::string(driver_.description) + ": " + info_.product + ", " + info_.path + "; tried " + kHidTried;
}

std::shared_ptr<HidConnection> HidLink::connection() noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connection_;
}

void HidLink::use(std::shared_ptr<HidConnection> connection) noexcept {
  if (connection != nullptr) connection->stop_with(driver_.encode_stop());
  const std::lock_guard<std::mutex> lock(mutex_);
  connection_.swap(connection);
}

Status HidLink::start() {
  use(connection());
  write(*connection(), driver_.encode_start());
  listener_.connected(steady_now_s());
  try {
    reader_ = std::thread([this] { read_all(); });
    if (driver_.renders_force) writer_ = std::thread([this] { write_all(); });
  } catch (const std::system_error& error) {
    stop();
    return Error{std::string("cannot start a thread for the device: ") + error.what() + "; close other programs"};
  }
  return {};
}

void HidLink::stop() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  if (writer_.joinable()) writer_.join();
  // Before the reader ends: an idle device may keep it waiting.
  if (const std::shared_ptr<HidConnection> last = connection()) write(*last, driver_.encode_stop());
  if (reader_.joinable()) reader_.join();
  use(nullptr);
}

void HidLink::read_all() noexcept {
  make_this_thread_realtime({kPriority, false});
  std::array<std::uint8_t, kLargestHidReport + 1> bytes{};
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::shared_ptr<HidConnection> current = connection();
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
}

void HidLink::look_again() noexcept {
  for (double waited_s = 0.0; waited_s < kLookAgain_s; waited_s += 0.01) {
    std::this_thread::sleep_for(kPause);
    if (stop_.load(std::memory_order_relaxed)) return;
  }
  std::string problems;
  std::optional<HidOpened> opened = try_open(bus_, {&driver_}, problems);
  if (!opened) return;
  write(*opened->connection, driver_.encode_start());
  listener_.connected(steady_now_s());
  use(std::move(opened->connection));
}

void HidLink::write(HidConnection& connection, const OutReports& reports) noexcept {
  bool good = reports.count > 0;
  for (std::size_t i = 0; i < reports.count; ++i) {
    good = connection.write(reports.bytes[i].data(), reports.sizes[i]) && good;
  }
  if (good) listener_.written(steady_now_s());
}

void HidLink::write_all() noexcept {
  make_this_thread_realtime({kPriority, false});
  SteadyPacer pacer;
  Deadlines deadlines(pacer.now_ns(), kWritePeriod_ns);
  while (!stop_.load(std::memory_order_relaxed)) {
    pacer.wait_until(deadlines.next_ns());
    deadlines.wake(pacer.now_ns());
    if (const std::shared_ptr<HidConnection> current = connection()) write(*current, listener_.next(steady_now_s()));
  }
}

}  // namespace palpate
