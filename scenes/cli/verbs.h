// The verbs of the headless program: one file each. Every verb adds a
// subcommand and hands back what to run when it was chosen; main prints a
// failed Status as one "error:" line and exits 1.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "engine/result.h"

namespace palpate::cli {

using Verbs = std::vector<std::pair<CLI::App*, std::function<Status()>>>;

void add_synth(CLI::App& app, Verbs& verbs);
void add_fit(CLI::App& app, Verbs& verbs);
void add_replay(CLI::App& app, Verbs& verbs);
void add_scenes(CLI::App& app, Verbs& verbs);
void add_devices(CLI::App& app, Verbs& verbs);

}  // namespace palpate::cli
