// The verbs (subcommands) of the headless program. Each has a source file, which adds the subcommand and the function
// to run. A failed Status ends the program with one "error: ..." block on stderr and exit code 1. Wrong usage that
// CLI11 does not detect throws CLI::ValidationError, during parsing or the run: exit code 2. Main thread only.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace palpate::cli {

using Verbs = std::vector<std::pair<CLI::App*, std::function<Status()>>>;

void add_synth(CLI::App& app, Verbs& verbs);
void add_import(CLI::App& app, Verbs& verbs);
void add_check(CLI::App& app, Verbs& verbs);
void add_fit(CLI::App& app, Verbs& verbs);
void add_replay(CLI::App& app, Verbs& verbs);
void add_export(CLI::App& app, Verbs& verbs);
void add_record(CLI::App& app, Verbs& verbs);
void add_scenes(CLI::App& app, Verbs& verbs);
void add_devices(CLI::App& app, Verbs& verbs);
void add_report(CLI::App& app, Verbs& verbs);
void add_paper(CLI::App& app, Verbs& verbs);
void add_hard(CLI::App& app, Verbs& verbs);
void add_study(CLI::App& app, Verbs& verbs);

}  // namespace palpate::cli
