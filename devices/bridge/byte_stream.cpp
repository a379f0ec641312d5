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
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "engine/base/text.h"
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

}  // namespace palpate
