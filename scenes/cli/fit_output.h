// What palpate fit prints of a fit.
// Thread guarantee: slow side.
#pragma once

#include <string>

#include "models/fit/fit.h"

namespace palpate::cli {

// `sensor`: behind the share within the JND in training; `out`: the file that was written.
void print_fit(const MethodFit& fit, const PreparedTraining& prepared, double seconds, const std::string& sensor,
               const std::string& out);
// One JSON object, as the contract has it.
void print_fit_json(const MethodFit& fit, const std::string& kernel, const std::string& weighting, double seconds);

}  // namespace palpate::cli
