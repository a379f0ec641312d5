// palpate devices: which devices there are, and why one cannot be opened.
#include <iostream>

#include "scenes/cli/verbs.h"

namespace palpate::cli {

void add_devices(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("devices", "List the devices and say why one cannot be opened");
  verbs.emplace_back(command, []() -> Status {
    std::cout << "no device support in this build yet; the window program brings hand, mouse and replay\n";
    return {};
  });
}

}  // namespace palpate::cli
