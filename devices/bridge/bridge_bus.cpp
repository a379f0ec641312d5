#include "devices/bridge/bridge_bus.h"

#include <fcntl.h>
#include <linux/serial.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "engine/base/signals.h"
#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/live/device.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

// Parses a whole number from 1 to `most`; 0 if it is none.
int whole_number(const std::string& text, int most) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc() && read.ptr == end && value >= 1 && value <= most ? value : 0;
}

// A small send buffer, for about 50 commands, because commands that wait in it are late.
constexpr int kQueueBytes = 1024;
// Time that a child program has to end, at the end of its input and again after SIGTERM; that a socket has to close.
constexpr double kEnd_s = 0.5, kClosed_s = 0.1;

using Opened = Result<std::unique_ptr<ByteStream>>;

constexpr std::size_t kLongestName = 400;  // of a target, in messages

Error wrong(const std::string& text, const std::string& expected) {
  return Error{"--device bridge:" + printable(text, kLongestName) + ": expected " + expected +
               " (devices/README.md#bridge)"};
}

// Of the last system call.
Error failure(const std::string& what, const std::string& advice) {
  return Error{printable(what, kLongestName) + ": " + std::strerror(errno) + "; " + advice};
}

// `rest`, here and below: the target without its prefix in kLines.
Opened open_serial(const std::string& rest) {
  std::string path = "/" + rest;
  int baud = 1'000'000;
  if (const std::size_t comma = path.rfind(','); comma != std::string::npos) {
    baud = whole_number(path.substr(comma + 1), 4'000'000);
    path.resize(comma);
  }
  termios settings{};
  // cfsetspeed refuses unusual rates, but takes numbers up to 4111 as its own codes of rates.
  if (baud < 9600 || cfsetspeed(&settings, static_cast<speed_t>(baud)) != 0) {
    return wrong("/" + rest,
                 "a baud rate of the system, such as 9600, 57600, 115200, 230400, 460800, 500000, 921600, 1000000 or "
                 "2000000, after the comma, as in /dev/ttyACM0,115200");
  }
  const int line = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (line < 0) {
    return failure(path, errno == EACCES || errno == EPERM
                             ? "join the group that owns it (sudo adduser $USER dialout), then log in again"
                             : "check that the device is plugged in; ls /dev/tty* lists the ports");
  }
  auto stream = std::make_unique<ByteStream>(line);
  if (flock(line, LOCK_EX | LOCK_NB) != 0)
    return Error{printable(path, kLongestName) + ": in use by another program; close it"};
  if (tcgetattr(line, &settings) != 0)
    return Error{printable(path, kLongestName) + ": is not a serial line; name a tty"};
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | HUPCL);  // so that closing the line does not reset the board
  cfsetspeed(&settings, static_cast<speed_t>(baud));
  if (tcsetattr(line, TCSANOW, &settings) != 0) return failure(path, "choose another baud rate");
  // If the driver supports it, low latency: it passes bytes on at once instead of every 16 ms.
  serial_struct serial{};
  if (ioctl(line, TIOCGSERIAL, &serial) == 0) {
    serial.flags |= ASYNC_LOW_LATENCY;
    ioctl(line, TIOCSSERIAL, &serial);
  }
  tcflush(line, TCIOFLUSH);
  return Opened(std::move(stream));
}

// A socket that is connected to `address`.
Opened connected(const std::string& name, const sockaddr* address, socklen_t size) {
  const int socket = ::socket(address->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return failure(name, "close other programs");
  auto stream = std::make_unique<ByteStream>(socket);
  int problem = connect(socket, address, size) == 0 ? 0 : errno;
  if (problem == EINPROGRESS) {
    problem = ETIMEDOUT;
    pollfd ready{socket, POLLOUT, 0};
    socklen_t length = sizeof problem;
    if (poll(&ready, 1, ByteStream::kConnect_ms) == 1) getsockopt(socket, SOL_SOCKET, SO_ERROR, &problem, &length);
  }
  if (problem == 0) return Opened(std::move(stream));
  return Error{printable(name, kLongestName) + ": " + std::strerror(problem) + "; start the device's program first"};
}

Opened open_unix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t most = sizeof address.sun_path - 1;
  if (path.empty() || path.size() > most)
    return wrong("unix:" + path, "unix:PATH, the path of a socket of 1 to " + std::to_string(most) + " bytes");
  std::copy(path.begin(), path.end(), address.sun_path);
  return connected(path, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

bool is_loopback(const sockaddr* address) {
  if (address->sa_family == AF_INET)
    return (ntohl(reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr) >> 24) == 127;
  return address->sa_family == AF_INET6 &&
         IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr) != 0;
}

bool remote_allowed = false;

Opened open_tcp(const std::string& name) {
  const std::size_t colon = std::min(name.rfind(':'), name.size());
  const std::string host = name.substr(0, colon);
  const int port = whole_number(name.substr(std::min(colon + 1, name.size())), 65535);
  if (host.empty() || port == 0) return wrong("tcp:" + name, "tcp:HOST:PORT, a port from 1 to 65535");
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int looked_up = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
  if (looked_up != 0)
    return Error{printable(name, kLongestName) + ": " + gai_strerror(looked_up) + "; check the host's name"};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(list, freeaddrinfo);
  Opened stream = Error{printable(name, kLongestName) + ": has no address; check the host's name"};
  for (const addrinfo* one = list; one != nullptr && !stream; one = one->ai_next) {
    if (!remote_allowed && !is_loopback(one->ai_addr)) {
      return Error{name +
                   ": is another computer, so others on the network could move the device; use an SSH tunnel to "
                   "127.0.0.1, or allow it with --bridge-remote"};
    }
    stream = connected(name, one->ai_addr, one->ai_addrlen);
  }
  const int on = 1;
  if (stream) setsockopt((*stream)->descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return stream;
}

// Runs in the child after `fork`, where only async-signal-safe calls are allowed.
[[noreturn]] void run_child(int line, const char* command, pid_t parent) noexcept {
  setpgid(0, 0);
  // The child ends with this program in any case, and does not inherit its real-time priority.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  const sched_param normal{};
  sched_setscheduler(0, SCHED_OTHER, &normal);
  signal(SIGPIPE, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(line, STDIN_FILENO);
  dup2(line, STDOUT_FILENO);
  execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  _exit(127);
}

Opened open_command(const std::string& command) {
  if (command.find_first_not_of(' ') == std::string::npos) return wrong("exec:" + command, "a program, exec:COMMAND");
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return failure(command, "close other programs");
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) run_child(ends[1], command.c_str(), parent);
  ::close(ends[1]);
  if (child > 0) setpgid(child, child);  // here as well, because kill(-child) may come before the child has run
  auto stream = std::make_unique<ByteStream>(ends[0], std::max(0, child));
  if (child < 0) return failure(command, "close other programs");
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Opened(std::move(stream));
}

// The kinds of lines, by the beginning of their targets.
struct Line {
  std::string_view prefix;
  Opened (*open)(const std::string& rest);
};
constexpr std::array<Line, 4> kLines = {{
    {"/", open_serial},
    {"unix:", open_unix},
    {"tcp:", open_tcp},
    {"exec:", open_command},
}};

}  // namespace

void allow_remote_bridges() noexcept { remote_allowed = true; }

Result<std::unique_ptr<ByteStream>> ByteStream::open(const std::string& target) {
  const auto line =
      std::find_if(kLines.begin(), kLines.end(), [&](const Line& one) { return target.starts_with(one.prefix); });
  if (line == kLines.end()) return wrong(target, "/dev/TTY[,BAUD], unix:PATH, tcp:HOST:PORT or exec:COMMAND");
  Opened opened = line->open(target.substr(line->prefix.size()));
  if (opened) setsockopt((*opened)->descriptor(), SOL_SOCKET, SO_SNDBUF, &kQueueBytes, sizeof kQueueBytes);
  return opened;
}

ByteStream::~ByteStream() {
  const bool socket = shutdown(descriptor_, SHUT_WR) == 0;
  if (child_ == 0) {
    if (socket) other_end_closes(kClosed_s);
  } else if (exit_status_ < 0 && !other_end_closes(kEnd_s)) {
    kill(-child_, SIGTERM);
    if (!other_end_closes(kEnd_s)) {
      kill(-child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }
  ::close(descriptor_);
}

// Reads meanwhile, so that the other end neither waits for room nor gets an error before it has read all.
bool ByteStream::other_end_closes(double within_s) noexcept {
  std::uint8_t unused[4096];
  for (const double until_s = steady_now_s() + within_s; steady_now_s() < until_s;) {
    const bool closed = read(unused, sizeof unused, 10) < 0;
    if (child_ == 0 ? closed : waitpid(child_, nullptr, WNOHANG) != 0) return true;
    if (closed) poll(nullptr, 0, 1);
  }
  return false;
}

int ByteStream::read(std::uint8_t* bytes, std::size_t capacity, int wait_ms) noexcept {
  pollfd ready{descriptor_, POLLIN, 0};
  if (poll(&ready, 1, wait_ms) <= 0) return 0;
  const ssize_t count = ::read(descriptor_, bytes, capacity);
  if (count > 0) return static_cast<int>(count);
  return count < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

bool ByteStream::write(const std::uint8_t* bytes, std::size_t size) noexcept {
  if (size > sizeof rest_) return false;
  if (rest_size_ > 0) {
    const ssize_t taken = ::write(descriptor_, rest_, rest_size_);
    if (taken <= 0) return false;
    rest_size_ -= static_cast<std::size_t>(taken);
    std::memmove(rest_, rest_ + taken, rest_size_);
    if (rest_size_ > 0) return false;
  }
  const ssize_t taken = ::write(descriptor_, bytes, size);
  if (taken <= 0) return false;
  rest_size_ = size - static_cast<std::size_t>(taken);
  std::copy(bytes + taken, bytes + size, rest_);
  return true;
}

std::string ByteStream::end_words() noexcept {
  if (child_ == 0) return "the other end closed the line";
  int status = 0;
  // The output of a program may end shortly before the program.
  for (int i = 0; exit_status_ < 0 && i < 20; ++i) {
    if (waitpid(child_, &status, WNOHANG) == child_) exit_status_ = status;
    if (exit_status_ < 0) poll(nullptr, 0, 10);
  }
  if (exit_status_ < 0) return "the program closed its output";
  if (WIFSIGNALED(exit_status_)) return "the program ended by signal " + std::to_string(WTERMSIG(exit_status_));
  return "the program ended with exit code " + std::to_string(WEXITSTATUS(exit_status_));
}

namespace {

constexpr int kRead_ms = 50;  // short, so that the reader thread ends soon after it is stopped
// A board that resets takes two seconds; a program with an SDK may search for its device first.
constexpr double kFirstFrame_s = 4.0, kFirstFrameOfProgram_s = 20.0;
// Rate, clock and sequence of the first frames are good in one of so many trials, because a program may pause while it
// starts.
constexpr int kTrials = 3, kIntervals = 8;
constexpr double kTrial_s = 0.1;
// 10000 a second with 5 % for the error of a clock.
constexpr double kShortestInterval_s = 1.0 / 10500.0;

// One trial: so many intervals between frames, and the time that they took by this computer's and the device's clock.
struct Trial {
  int intervals = -1;
  double first_s = 0.0, span_s = 0.0, device_s = 0.0;
  DeviceReading first;
  bool counts = true;  // the sequence increased by 1 with each frame, or a few were lost

  void take(const DeviceReading& reading, double now_s) {
    if (++intervals == 0) {
      first_s = now_s;
      first = reading;
    }
    span_s = now_s - first_s;
    device_s = 1e-6 * static_cast<std::int32_t>(reading.time_us - first.time_us);
    counts = static_cast<std::int32_t>(reading.sequence - first.sequence) >= intervals;
  }
  bool complete() const { return intervals >= kIntervals && std::max(span_s, device_s) >= kTrial_s; }
  // By the slower clock, because the first frames may have waited in a queue.
  double interval_s() const { return std::max(span_s, device_s) / intervals; }

  // What makes the device unusable and what to do; empty: nothing.
  std::string problem() const {
    if (!counts) return ": the sequence of its frames does not increase by 1 with each; count them in bytes 4 to 7";
    const double ratio = device_s / span_s;
    if (ratio > 0.5 && ratio < 2.0) return rate_problem(interval_s());
    std::string unit;
    for (const auto& [name, per_us] : {std::pair{"s", 1e-6}, {"ms", 1e-3}, {"ns", 1e3}})
      if (ratio > 0.5 * per_us && ratio < 2.0 * per_us) unit = std::string("; it seems to count ") + name;
    if (ratio == 0.0) unit = "; it stands still";
    return ": its clock advances by " + fixed(1e6 * device_s, 0) + " in " + fixed(span_s, 2) +
           " s, expected microseconds in bytes 8 to 11" + unit;
  }

 private:
  static std::string rate_problem(double interval_s) {
    if (interval_s > SampleRate::kLongestInterval_s) return too_slow("", interval_s).message;
    if (interval_s >= kShortestInterval_s) return {};
    return ": sends " + fixed(1.0 / interval_s, 0) +
           " samples a second, expected 100 to 10000; lower the rate of the device's program";
  }
};

// The limits of a recording; larger values are invalid.
constexpr std::int32_t kMost_nm = 1'000'000'000;
constexpr double kMost_uN = 2e9;

ReportVerdict decode_bridge(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size == 4) {
    reading.version = bytes[2];
    return ReportVerdict::wrong_version;
  }
  bridge::FromDevice in{};
  if (size != bridge::kDeviceBytes || !bridge::decode(bytes, in)) return ReportVerdict::corrupt;
  if (in.position_nm > kMost_nm || in.position_nm < -kMost_nm) return ReportVerdict::corrupt;
  reading.counts = in.position_nm;
  reading.sequence = in.sequence;
  reading.time_us = in.time_us;
  reading.confirmed = in.confirmed;
  if (in.force_uN != bridge::kNoForce) reading.measured_N = in.force_uN / 1e6;
  reading.grip = (in.status & bridge::kGrip) != 0;
  reading.own_fault = (in.status & (bridge::kMotorFault | bridge::kSensorFault)) != 0;
  reading.driving = (in.status & bridge::kDriving) != 0;
  reading.stopped = (in.status & bridge::kStopped) != 0;
  return ReportVerdict::position;
}

OutReports encode_bridge(const DeviceCommand& command) noexcept {
  bridge::FromHost out{};
  out.sequence = command.sequence;
  out.heartbeat = command.heartbeat;
  if (command.drive && std::isfinite(command.units)) {
    out.flags = bridge::kDrive;
    out.force_uN = static_cast<std::int32_t>(std::lround(std::clamp(-command.units, -kMost_uN, kMost_uN)));
  }
  OutReports reports;
  bridge::encode(out, reports.bytes[0].data());
  reports.sizes[0] = bridge::kHostBytes;
  reports.count = 1;
  return reports;
}

OutReports stop_bridge() noexcept { return encode_bridge({}); }

class BridgeConnection final : public DeviceConnection {
 public:
  explicit BridgeConnection(std::unique_ptr<ByteStream> stream) : stream_(std::move(stream)) {
    beginning_.reserve(kBeginning);
  }

  // Reads one report, see BridgeReports.
  int read(std::uint8_t* bytes, std::size_t capacity) noexcept override {
    if (capacity < bridge::kDeviceBytes) return 0;
    if (const int size = reports_.next(next_, end_, bytes); size > 0) return size;
    const int came = stream_->read(bytes_, sizeof bytes_, kRead_ms);
    if (came <= 0) return came;
    next_ = bytes_;
    end_ = bytes_ + came;
    if (!reports_.any_frame())
      beginning_.append(next_, next_ + std::min(static_cast<std::size_t>(came), kBeginning - beginning_.size()));
    return reports_.next(next_, end_, bytes);
  }
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept override { return stream_->write(bytes, size); }
  int descriptor() const noexcept override { return stream_->descriptor(); }

  // The text that the device sent before its first frame; else empty.
  std::string text() const {
    std::string text = beginning_;
    for (char& one : text) one = one == '\n' || one == '\r' ? ' ' : one;
    const auto printable = [](unsigned char one) { return std::isprint(one) != 0; };
    return std::all_of(text.begin(), text.end(), printable) ? text : "";
  }
  std::string end_words() noexcept { return stream_->end_words(); }

 private:
  static constexpr std::size_t kBeginning = 80;

  std::unique_ptr<ByteStream> stream_;
  BridgeReports reports_;
  std::uint8_t bytes_[4096] = {};
  const std::uint8_t* next_ = bytes_;
  const std::uint8_t* end_ = bytes_;
  std::string beginning_;  // the bytes until there is a frame, at most kBeginning
};

}  // namespace

const DeviceProtocol kBridgeProtocol = {
    .name = "bridge",
    .description = "bridge",
    .renders_force = true,
    .absolute = true,
    .timed = true,
    .confirms = true,
    .matches = [](const DeviceNode&) noexcept { return true; },  // a BridgeBus has no other devices
    .decode = decode_bridge,
    .encode_start = stop_bridge,
    .encode_command = encode_bridge,
    .encode_stop = stop_bridge,
};

BridgeBus::BridgeBus(std::string target) : target_(std::move(target)) {
  info_.path = "bridge:" + printable(target_, kLongestName);
}

Result<std::unique_ptr<DeviceConnection>> BridgeBus::open(const DeviceNode&) {
  Result<std::unique_ptr<ByteStream>> stream = ByteStream::open(target_);
  if (!stream) return stream.error();
  return Result<std::unique_ptr<DeviceConnection>>(std::make_unique<BridgeConnection>(std::move(*stream)));
}

Result<OpenedDevice> BridgeBus::open_and_identify() {
  ignore_broken_pipes();  // so that a write to a program that has ended returns an error
  Result<std::unique_ptr<DeviceConnection>> opened = open(info_);
  if (!opened) return opened.error();
  auto& connection = static_cast<BridgeConnection&>(**opened);
  const auto said = [&] { return connection.text().empty() ? "" : ", after \"" + connection.text() + "\""; };
  const OutReports start = kBridgeProtocol.encode_start();
  OpenedDevice result{info_, &kBridgeProtocol};
  const double patience_s = target_.starts_with("exec:") ? kFirstFrameOfProgram_s : kFirstFrame_s;
  const double until_s = steady_now_s() + patience_s;
  double last_sent_s = 0.0;
  std::string problem = ": no frame";
  Trial trial;
  for (int frames = 0, trials = 0; !problem.empty() && trials < kTrials;) {
    if (stop_requested() != 0) return Error{"interrupted"};
    // Opening the line may reset the board, which then misses the first frames of the host.
    if (steady_now_s() - last_sent_s > 0.1) {
      connection.write(start.bytes[0].data(), start.sizes[0]);
      last_sent_s = steady_now_s();
    }
    std::uint8_t bytes[kLargestReport];
    const int size = connection.read(bytes, sizeof bytes);
    if (size < 0) return Error{info_.path + ": " + connection.end_words() + said() + "; run it by itself to see why"};
    if (steady_now_s() >= until_s) {
      return Error{info_.path + ": found " + std::to_string(frames) + " frames of 28 bytes within " +
                   fixed(patience_s, 0) + " s" + said() +
                   ", expected 100 to 10000 a second; check that the device's program runs and that the baud rate is "
                   "right"};
    }
    DeviceReading reading;
    const ReportVerdict verdict = kBridgeProtocol.decode(bytes, static_cast<std::size_t>(size), reading);
    if (verdict == ReportVerdict::wrong_version) {
      return Error{info_.path + ": speaks version " + std::to_string(reading.version) +
                   " of the bridge protocol, expected " + std::to_string(bridge::kVersion) +
                   "; update the device's program (devices/README.md#bridge)"};
    }
    if (verdict != ReportVerdict::position) continue;
    ++frames;
    result.measures_force = result.measures_force || !std::isnan(reading.measured_N);
    trial.take(reading, steady_now_s());
    if (!trial.complete()) continue;
    problem = std::exchange(trial, {}).problem();
    ++trials;
  }
  if (!problem.empty()) return Error{info_.path + problem};
  result.info.product = result.measures_force ? "measures force" : "measures no force";
  result.connection = std::move(*opened);
  return Result<OpenedDevice>(std::move(result));
}

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
    const double interval_s = quantile_of(intervals_s_, 50);
    return path + "\n  samples     " + fixed(interval_s > 0.0 ? 1.0 / interval_s : 0.0, 0) +
           " a second by the device's clock\n  round trip  median " + ms(quantile_of(round_trips_s_, 50)) +
           ", 99th percentile " + ms(quantile_of(round_trips_s_, 99)) + "\n  position    " +
           fixed(1e-6 * last_.counts, 3) + " mm\n  force       " +
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
