#include "scenes/hard/hard_case.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"
#include "engine/live/pacer.h"
#include "scenes/scene/folders.h"

namespace palpate {

namespace {

HardExpectation expectation_of(const nlohmann::json& limits) {
  HardExpectation expected;
  if (limits.is_string()) {
    expected.refusal = limits;
    return expected;
  }
  double* const values[] = {&expected.within_jnd, &expected.worst_error_N, &expected.worst_step_N, &expected.energy_J};
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (!limits[i].is_null()) *values[i] = limits[i];
  return expected;
}

}  // namespace

Result<std::vector<HardCase>> hard_cases() {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/hard/cases.json";
  const auto text = read_plain_file(path, "the reasons and expectations of the hard cases");
  if (!text) return text.error();
  const auto document = parse_json(*text, path, 3, {});
  if (!document) return document.error();
  std::vector<HardCase> cases = site_cases();
  std::ranges::move(recording_cases(), std::back_inserter(cases));
  std::ranges::move(material_cases(), std::back_inserter(cases));
  for (HardCase& one : cases) {
    const auto found = document->find(one.name);
    if (found == document->end()) return Error{path + ": found no case \"" + one.name + "\", expected one"};
    for (const auto& [key, value] : found->items()) {
      if (key == "why") {
        one.why = value;
      } else {
        one.expected[key] = expectation_of(value);
      }
    }
  }
  return cases;
}

Result<HardTraining::Fit> HardTraining::fit(const ModelPlan& plan, const FitControl& control) {
  const std::string name = plan_name(plan);
  if (const auto made = made_.find(name); made != made_.end()) return made->second;
  ModelPlan asked = common_;
  asked.base = plan.base;
  asked.method = plan.method;
  const double start_s = steady_now_s();
  auto fitted = fits_.fit(asked, control);
  Fit fit;
  fit.seconds = steady_now_s() - start_s;
  if (fitted) {
    fit.model = std::make_shared<const FittedModel>(std::move(fitted->data));
    fit.rank = fitted->rank;
    fit.condition_number = fitted->condition_number;
  } else if (fitted.error().message == interrupted().message) {
    return interrupted();
  } else {
    fit.refusal = fitted.error().message;
  }
  return made_[name] = fit;
}

const HardExpectation& HardCase::expectation(const ModelPlan& plan) const {
  if (const auto own = expected.find(plan_name(plan)); own != expected.end()) return own->second;
  return expected.at(plan.base == Base::force ? "force" : "corrected");
}

void HardMeasure::add(double force_N, double true_N, bool counts, double position_m) {
  if (std::isfinite(last_m_)) {
    // The trapezoidal rule. A force that pushes the tool out (towards smaller positions) gives out energy.
    const double way_m = position_m - last_m_;
    given_J_ -= 0.5 * (force_N + last_N_) * way_m;
    truly_given_J_ -= 0.5 * (true_N + last_true_N_) * way_m;
    energy_J_ = std::max(energy_J_, given_J_ - std::max(0.0, truly_given_J_));
  }
  last_m_ = position_m;
  last_true_N_ = true_N;
  // A force that is not finite is never within the JND, and an infinite error.
  const double error_N = std::isfinite(force_N) ? std::abs(force_N - true_N) : HardExpectation::kAny;
  if (counts) {
    ++counted_;
    if (error_N <= JndLine{}.at(true_N)) ++within_;
    worst_N_ = std::max(worst_N_, error_N);
  }
  const double step_N = std::abs(force_N - last_N_);
  if (ticks_ > 0) step_N_ = std::max(step_N_, std::isfinite(step_N) ? step_N : HardExpectation::kAny);
  last_N_ = force_N;
  ++ticks_;
}

HardFigures HardMeasure::figures() const {
  HardFigures figures;
  if (counted_ > 0) {
    figures.within_jnd = static_cast<double>(within_) / static_cast<double>(counted_);
    figures.worst_error_N = worst_N_;
  }
  if (ticks_ > 1) figures.worst_step_N = step_N_;
  if (std::isfinite(last_m_)) figures.energy_J = energy_J_;
  return figures;
}

}  // namespace palpate
