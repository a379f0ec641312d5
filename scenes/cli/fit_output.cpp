#include "scenes/cli/fit_output.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

#include "engine/base/text.h"

namespace palpate::cli {
namespace {

std::string relaxation_text(const std::vector<RelaxationTime>& times) {
  std::string text;
  for (const RelaxationTime& time : times) {
    text += (text.empty() ? "" : ", ") + general(time.time_s, 3) + " s" +
            (time.standard_error_s > 0.0 ? " +- " + general(time.standard_error_s, 2) : "");
  }
  return text.empty() ? "none" : text;
}

// One row for each feature: the cross-validated error of the trend with it and without it. The rule that selects
// (models/training/selection.h) compares these errors and their standard errors.
void print_gains(const std::vector<PartGain>& gains) {
  if (gains.empty()) return;
  std::printf("%-32s %-5s %12s %12s   cross-validated error [JND]\n", "FEATURE", "TAKEN", "WITH", "WITHOUT");
  for (const PartGain& one : gains) {
    std::printf("%-32s %-5s %12.3f %12.3f\n", one.name.c_str(), one.taken ? "yes" : "no", one.error_with,
                one.error_without);
  }
  std::fflush(stdout);
}

std::string strength_text(const StrengthChoice& strength) {
  if (strength.strength == 0.0)
    return "off: it does not lower the cross-validated error, so the model is the trend alone";
  return "strength " + fixed(strength.strength, 2) + "; cross-validated error " + fixed(strength.error_over_jnd, 3) +
         " JND, trend alone " + fixed(strength.trend_error_over_jnd, 3) + " JND";
}

void print_surfaces(const Provenance& provenance) {
  for (const RecordingSurface& surface : provenance.surfaces) {
    const std::string error = std::isfinite(surface.standard_error_m)
                                  ? " +- " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                  : std::string(" mm (not identified)");
    std::cout << "surface             " << fixed(1e3 * surface.offset_m, 3) << error << ", force zero "
              << fixed(1e3 * surface.force_zero_N, 1) << " mN"
              << (surface.lag_s != 0.0 ? ", force lag " + fixed(1e3 * surface.lag_s, 1) + " ms" : "") << ": "
              << surface.name << "\n";
  }
}

}  // namespace

void print_fit(const RecordingsFit& fitted, const std::string& sensor, const std::string& out) {
  const auto& [prepared, fit, seconds] = fitted;
  print_gains(prepared.gains);
  const Provenance& provenance = fit.data.provenance;
  std::cout << "model               " << fit.data.name << "\n"
            << "samples             " << provenance.samples << " (" << provenance.contact_samples << " in contact)\n"
            << "after reduction     " << provenance.samples_after_reduction << "\n";
  print_surfaces(provenance);
  // The depth is the first feature.
  if (const double begins_m = fit.data.features.front().surface_position_m; begins_m != 0.0)
    std::cout << "depth starts        at " << fixed(1e3 * begins_m, 3)
              << " mm, where the force of the recordings begins\n";
  std::cout << "relaxation times    " << relaxation_text(provenance.relaxation_times) << "\n"
            << "correction          " << (prepared.strength ? strength_text(*prepared.strength) : "full strength")
            << "\n"
            << "fit time            " << fixed(seconds, 2) << " s\n"
            << "training <= JND     " << fixed(100.0 * provenance.training_within_jnd, 2) << " %" << sensor << "\n";
  for (const std::string& note : fit.report.notes) std::cout << "note                " << note << "\n";
  std::cout << "written             " << out << "\n";
}

}  // namespace palpate::cli
