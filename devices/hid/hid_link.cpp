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

bool contains(const std::vector<HidKind>& kinds, HidKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// One look at the bus; what cannot be opened adds to `problems`.
std::optional<HidOpened> try_open(HidBus& bus, const std::vector<HidKind>& kinds, std::string& problems) {
  problems.clear();
  for (const HidFound& found : bus.list()) {
    const std::vector<HidKind> possible = possible_kinds(found);
    const bool wanted =
        std::any_of(possible.begin(), possible.end(), [&](HidKind kind) { return contains(kinds, kind); });
    if (!wanted) continue;
    Result<std::unique_ptr<HidLine>> line = bus.open(found);
    std::string problem;
    if (!line) {
      problem = line.error().message;
    } else {
      const Result<HidKind> kind = identify(**line, possible);
      if (kind && contains(kinds, *kind)) return HidOpened{found, *kind, std::move(*line)};
      problem = kind ? std::string() : found.path + ": " + kind.error().message;
    }
    if (!problem.empty()) problems += (problems.empty() ? "" : "; ") + problem;
  }
  return std::nullopt;
}

}  // namespace

Result<HidOpened> open_first(HidBus& bus, const std::vector<HidKind>& kinds, bool* none_found) {
  std::string problems;
  for (int i = 0; i < kOpenTries; ++i) {
    if (i > 0) std::this_thread::sleep_for(kBetweenTries);
    if (std::optional<HidOpened> opened = try_open(bus, kinds, problems)) {
      return Result<HidOpened>(std::move(*opened));
    }
    if (problems.empty()) break;
  }
  if (none_found != nullptr) *none_found = problems.empty();
  return Error{problems.empty() ? "no device that the program knows is plugged in" : problems};
}

HidLink::HidLink(HidBus& bus, HidLinkUser& user, HidOpened opened)
    : bus_(bus),
      user_(user),
      found_(std::move(opened.found)),
      kind_(opened.kind),
      line_(std::move(opened.line)) {}

HidLink::~HidLink() { stop(); }

std::shared_ptr<HidLine> HidLink::line() noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  return line_;
}

void HidLink::use(std::shared_ptr<HidLine> line) noexcept {
  if (line != nullptr) line->stop_with(encode_stop(kind_));
  const std::lock_guard<std::mutex> lock(mutex_);
  line_.swap(line);
}

Status HidLink::start() {
  use(line());
  write(*line(), encode_start(kind_));
  user_.connected(steady_now_s());
  try {
    reader_ = std::thread([this] { read_all(); });
    if (pushes(kind_)) writer_ = std::thread([this] { write_all(); });
  } catch (const std::system_error& error) {
    stop();
    return Error{std::string("cannot start a thread for the device: ") + error.what() +
                 "; close other programs"};
  }
  return {};
}

void HidLink::stop() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  if (writer_.joinable()) writer_.join();
  // Before the reader ends: an idle device may keep it waiting.
  if (const std::shared_ptr<HidLine> last = line()) write(*last, encode_stop(kind_));
  if (reader_.joinable()) reader_.join();
  use(nullptr);
}

void HidLink::read_all() noexcept {
  make_this_thread_realtime({kPriority, false});
  std::array<std::uint8_t, kLargestHidReport + 1> bytes{};
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::shared_ptr<HidLine> current = line();
    if (current == nullptr) {
      look_again();
      continue;
    }
    const int size = current->read(bytes.data(), bytes.size());
    if (size > 0) user_.take(bytes.data(), static_cast<std::size_t>(size), steady_now_s());
    if (size < 0 && !stop_.load(std::memory_order_relaxed)) {
      user_.unplugged();
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
  std::optional<HidOpened> opened = try_open(bus_, {kind_}, problems);
  if (!opened) return;
  write(*opened->line, encode_start(kind_));
  user_.connected(steady_now_s());
  use(std::move(opened->line));
}

void HidLink::write(HidLine& line, const OutReports& reports) noexcept {
  bool good = reports.count > 0;
  for (std::size_t i = 0; i < reports.count; ++i) {
    good = line.write(reports.bytes[i].data(), reports.sizes[i]) && good;
  }
  if (good) user_.written(steady_now_s());
}

void HidLink::write_all() noexcept {
  make_this_thread_realtime({kPriority, false});
  SteadyPacer pacer;
  Deadlines deadlines(pacer.now_ns(), kWritePeriod_ns);
  while (!stop_.load(std::memory_order_relaxed)) {
    pacer.wait_until(deadlines.next_ns());
    deadlines.wake(pacer.now_ns());
    if (const std::shared_ptr<HidLine> current = line()) write(*current, user_.next(steady_now_s()));
  }
}

}  // namespace palpate
