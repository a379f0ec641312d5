// The target of --device bridge:TARGET: where the byte stream of a device is.
// Thread guarantee: pure functions, slow side.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

struct BridgeTarget {
  enum class Kind { serial, unix_socket, tcp, command };
  Kind kind = Kind::serial;
  std::string path;  // of a serial line or Unix socket; or the command
  std::string host;
  int port = 0;
  bool remote = false;  // another computer is allowed
  int baud = 1'000'000;
};

// "/dev/TTY[,BAUD]", "unix:PATH", "[remote-]tcp:HOST:PORT", "exec:COMMAND". Errors: another form, an invalid baud rate
// or port.
Result<BridgeTarget> parse_bridge_target(const std::string& text);

// Applies --bridge-remote to the value of --device: bridge:tcp: becomes bridge:remote-tcp:, which may name another
// computer. Other values are unchanged.
std::string with_remote_bridge(std::string device);

}  // namespace palpate
