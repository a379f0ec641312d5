// gnuplot as a program beside this one: it draws, we write what it draws.
//
// Thread guarantee: slow side; starts a process.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// The program in the folders of PATH. Errors: there is none; says what to install.
Result<std::string> find_gnuplot();

// Runs `scripts` (names in `folder`) in `folder`, one after the other, and waits.
// Errors: it cannot be started or fails; with the first line it said.
Status run_gnuplot(const std::string& program, const std::string& folder, const std::vector<std::string>& scripts);

}  // namespace palpate
