// What a fitted model says of the material, in the numbers that a materials person
// wants: elastic curve, stiffness, viscosity, relaxation spectrum.
//
// All of them are the trend's (models/model/trend.h): with depth d and velocity v,
//   elastic              E(d), the force of an endlessly slow press
//   stiffness            dE/dd; instantaneous: plus what every branch adds before it relaxes
//   viscosity            (T(d, v) - T(d, 0)) / v for v -> 0 and at the recording's RMS speed
//   relaxation spectrum  stiffness of each Maxwell branch at half the greatest depth
// Thread guarantee: pure function.
#pragma once

#include "scenes/report/data/report_data.h"

namespace palpate {

// Fills data.facts for the recommended model; the last main one when none is.
void add_model_facts(ReportData& data);

ModelFacts model_facts(const std::string& name, const FittedModel& model);

}  // namespace palpate
