#include "devices/bridge/bridge_target.h"

#include <charconv>
#include <string_view>

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

}  // namespace palpate
