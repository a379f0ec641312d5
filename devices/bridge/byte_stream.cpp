#include "devices/bridge/byte_stream.h"

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
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

namespace palpate {
namespace {

// Parses a whole number from 1 to `most`; 0 if it is none.
int whole_number(const std::string& text, int most) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc() && read.ptr == end && value >= 1 && value <= most ? value : 0;
}

bool take_prefix(std::string& text, const std::string& prefix) {
  if (text.rfind(prefix, 0) != 0) return false;
  text.erase(0, prefix.size());
  return true;
}

Error wrong(const std::string& text, const std::string& expected) {
  return Error{"--device bridge:" + text + ": expected " + expected + " (devices/README.md#bridge)"};
}

// A small send buffer, for about 50 commands, because commands that wait in it are late.
constexpr int kQueueBytes = 1024;
// Time that a child program has to end before it is killed.
constexpr int kEnd_ms = 500;

struct Speed {
  int baud;
  speed_t code;
};
constexpr std::array<Speed, 11> kSpeeds = {{{9600, B9600},
                                            {19200, B19200},
                                            {38400, B38400},
                                            {57600, B57600},
                                            {115200, B115200},
                                            {230400, B230400},
                                            {460800, B460800},
                                            {500000, B500000},
                                            {921600, B921600},
                                            {1000000, B1000000},
                                            {2000000, B2000000}}};

using Opened = Result<std::pair<int, int>>;  // file descriptor, process id of the child (0: none)

Error failure(const std::string& what, int error_number, const std::string& advice) {
  return Error{what + ": " + std::strerror(error_number) + "; " + advice};
}

Error close_with(int descriptor, Error error) {
  ::close(descriptor);
  return error;
}

Opened open_serial(const BridgeTarget& target) {
  const auto speed =
      std::find_if(kSpeeds.begin(), kSpeeds.end(), [&](const Speed& s) { return s.baud == target.baud; });
  if (speed == kSpeeds.end()) {
    std::string known;
    for (const Speed& one : kSpeeds) known += (known.empty() ? "" : ", ") + std::to_string(one.baud);
    return Error{target.path + ": found " + std::to_string(target.baud) + " baud, expected one of " + known};
  }
  const int line = ::open(target.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (line < 0) {
    const bool denied = errno == EACCES || errno == EPERM;
    return failure(target.path, errno,
                   denied ? "join the group that owns it (sudo adduser $USER dialout), then log in again"
                          : "check that the device is plugged in; ls /dev/tty* lists the ports");
  }
  if (flock(line, LOCK_EX | LOCK_NB) != 0) {
    return close_with(line, Error{target.path + ": in use by another program; close it"});
  }
  termios settings{};
  if (tcgetattr(line, &settings) != 0)
    return close_with(line, Error{target.path + ": is not a serial line; name a tty"});
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | HUPCL);  // so that closing the line does not reset the board
  cfsetspeed(&settings, speed->code);
  if (tcsetattr(line, TCSANOW, &settings) != 0) {
    return close_with(line, failure(target.path, errno, "choose another baud rate"));
  }
  // If the driver supports it, low latency: it passes bytes on at once instead of every 16 ms.
  serial_struct serial{};
  if (ioctl(line, TIOCGSERIAL, &serial) == 0) {
    serial.flags |= ASYNC_LOW_LATENCY;
    ioctl(line, TIOCSSERIAL, &serial);
  }
  tcflush(line, TCIOFLUSH);
  return std::pair(line, 0);
}

Status connect_within(int socket, const sockaddr* address, socklen_t size) {
  if (connect(socket, address, size) == 0) return {};
  if (errno != EINPROGRESS) return Error{std::strerror(errno)};
  pollfd ready{socket, POLLOUT, 0};
  int error_number = ETIMEDOUT;
  if (poll(&ready, 1, ByteStream::kConnect_ms) == 1) {
    socklen_t length = sizeof error_number;
    getsockopt(socket, SOL_SOCKET, SO_ERROR, &error_number, &length);
  }
  return error_number == 0 ? Status() : Error{std::strerror(error_number)};
}

Opened open_unix(const BridgeTarget& target) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (target.path.size() >= sizeof address.sun_path) {
    return Error{target.path + ": the path of a socket has at most " + std::to_string(sizeof address.sun_path - 1) +
                 " bytes; choose a shorter one"};
  }
  std::copy(target.path.begin(), target.path.end(), address.sun_path);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return failure(target.path, errno, "close other programs");
  const Status status = connect_within(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (status) return std::pair(descriptor, 0);
  return close_with(descriptor,
                    Error{target.path + ": " + status.error().message + "; start the device's program first"});
}

bool is_loopback(const sockaddr* address) {
  if (address->sa_family == AF_INET) {
    return (ntohl(reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr) >> 24) == 127;
  }
  return address->sa_family == AF_INET6 &&
         IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr) != 0;
}

Opened open_tcp(const BridgeTarget& target) {
  const std::string name = target.host + ":" + std::to_string(target.port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  const int looked_up = getaddrinfo(target.host.c_str(), std::to_string(target.port).c_str(), &hints, &list);
  if (looked_up != 0) return Error{name + ": " + gai_strerror(looked_up) + "; check the host's name"};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(list, freeaddrinfo);
  std::string problem = "no address";
  for (const addrinfo* one = list; one != nullptr; one = one->ai_next) {
    if (!target.remote && !is_loopback(one->ai_addr)) {
      return Error{name +
                   ": is another computer, so others on the network could move the device; use an SSH tunnel to "
                   "127.0.0.1, or allow it with --bridge-remote"};
    }
    const int descriptor = socket(one->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (descriptor < 0) continue;
    const Status status = connect_within(descriptor, one->ai_addr, one->ai_addrlen);
    if (status) {
      const int on = 1;
      setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      return std::pair(descriptor, 0);
    }
    problem = status.error().message;
    ::close(descriptor);
  }
  return Error{name + ": " + problem + "; start the device's program first"};
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

Opened open_command(const BridgeTarget& target) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return failure(target.path, errno, "close other programs");
  }
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) run_child(ends[1], target.path.c_str(), parent);
  ::close(ends[1]);
  if (child < 0) return close_with(ends[0], failure(target.path, errno, "close other programs"));
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return std::pair(ends[0], static_cast<int>(child));
}

Opened open_any(const BridgeTarget& target) {
  switch (target.kind) {
    case BridgeTarget::Kind::serial:
      return open_serial(target);
    case BridgeTarget::Kind::unix_socket:
      return open_unix(target);
    case BridgeTarget::Kind::tcp:
      return open_tcp(target);
    case BridgeTarget::Kind::command:
      return open_command(target);
  }
  return Error{"found no such kind of line"};
}

}  // namespace

Result<BridgeTarget> parse_bridge_target(const std::string& text) {
  BridgeTarget target;
  target.path = text;
  if (take_prefix(target.path, "unix:")) {
    target.kind = BridgeTarget::Kind::unix_socket;
    if (target.path.empty()) return wrong(text, "the path of a socket, unix:PATH");
  } else if (take_prefix(target.path, "exec:")) {
    target.kind = BridgeTarget::Kind::command;
    if (target.path.find_first_not_of(' ') == std::string::npos) return wrong(text, "a program, exec:COMMAND");
  } else if ((target.remote = take_prefix(target.path, "remote-")), take_prefix(target.path, "tcp:")) {
    target.kind = BridgeTarget::Kind::tcp;
    const std::size_t colon = target.path.rfind(':');
    target.host = target.path.substr(0, colon);
    target.port = colon == std::string::npos ? 0 : whole_number(target.path.substr(colon + 1), 65535);
    if (target.host.empty() || target.port == 0) return wrong(text, "tcp:HOST:PORT, a port from 1 to 65535");
  } else if (!target.path.empty() && target.path.front() == '/') {
    const std::size_t comma = target.path.rfind(',');
    if (comma != std::string::npos) {
      target.baud = whole_number(target.path.substr(comma + 1), 4'000'000);
      if (target.baud == 0) return wrong(text, "a baud rate after the comma, as in /dev/ttyACM0,1000000");
      target.path.resize(comma);
    }
  } else {
    return wrong(text, "/dev/TTY[,BAUD], unix:PATH, tcp:HOST:PORT or exec:COMMAND");
  }
  return target;
}

std::string with_remote_bridge(std::string device) {
  constexpr std::string_view kBridge = "bridge:";
  if (device.rfind("bridge:tcp:", 0) == 0) device.insert(kBridge.size(), "remote-");
  return device;
}

Result<std::unique_ptr<ByteStream>> ByteStream::open(const BridgeTarget& target) {
  const Opened opened = open_any(target);
  if (!opened) return opened.error();
  setsockopt(opened->first, SOL_SOCKET, SO_SNDBUF, &kQueueBytes, sizeof kQueueBytes);  // only of a socket
  return std::unique_ptr<ByteStream>(new ByteStream(opened->first, opened->second));
}

ByteStream::~ByteStream() {
  ::close(descriptor_);  // a program that reads its input now ends by itself
  if (child_ == 0 || exit_status_ >= 0) return;
  kill(-child_, SIGTERM);
  for (int waited_ms = 0; waited_ms < kEnd_ms; waited_ms += 10) {
    if (waitpid(child_, nullptr, WNOHANG) != 0) return;
    poll(nullptr, 0, 10);
  }
  kill(-child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

int ByteStream::read(std::uint8_t* bytes, std::size_t capacity, int wait_ms) noexcept {
  pollfd ready{descriptor_, POLLIN, 0};
  if (poll(&ready, 1, wait_ms) <= 0) return 0;
  const ssize_t count = ::read(descriptor_, bytes, capacity);
  if (count > 0) return static_cast<int>(count);
  return count < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

bool ByteStream::finish_piece() noexcept {
  if (rest_size_ == 0) return true;
  const ssize_t taken = ::write(descriptor_, rest_, rest_size_);
  if (taken <= 0) return false;
  rest_size_ -= static_cast<std::size_t>(taken);
  std::memmove(rest_, rest_ + taken, rest_size_);
  return rest_size_ == 0;
}

bool ByteStream::write(const std::uint8_t* bytes, std::size_t size) noexcept {
  if (size > sizeof rest_ || !finish_piece()) return false;
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

}  // namespace palpate
