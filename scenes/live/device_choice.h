// The devices that a session can be opened with, for whoever does not see them.
// Thread guarantee: slow side; opens and closes what is plugged in, which takes a while.
#pragma once

#include <string>
#include <vector>

namespace palpate {

struct DeviceChoice {
  std::string name;
  std::string summary;  // one line
  std::string problem;  // why it cannot be opened and what to do; empty: it can
};

// Those that need no more than their name.
std::vector<DeviceChoice> device_choices();

}  // namespace palpate
