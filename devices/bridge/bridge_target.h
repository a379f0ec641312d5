// What follows `bridge:`: where the byte stream of a device is.
// Thread guarantee: slow side; pure.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

struct BridgeTarget {
  enum class Kind { serial, unix_socket, tcp, command };
  Kind kind = Kind::serial;
  std::string path;  // of a serial line or socket; the command
  std::string host;
  int port = 0;
  bool remote = false;  // may be another computer
  int baud = 1'000'000;
};

// "/dev/TTY[,BAUD]", "unix:PATH", "tcp:HOST:PORT", "exec:COMMAND". Errors: none of these,
// a baud rate or port that is none.
Result<BridgeTarget> parse_bridge_target(const std::string& text);

// What --bridge-remote makes of --device: bridge:tcp: becomes bridge:remote-tcp:, which may
// name another computer; anything else stays.
std::string with_remote_bridge(std::string device);

}  // namespace palpate
