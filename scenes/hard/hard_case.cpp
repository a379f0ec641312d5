#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"
#include "engine/live/pacer.h"
#include "models/correction/methods.h"
#include "scenes/hard/hard.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr const char* kControlName = "direct-untruncated";
// Of the negative control, whose solve takes the third power of this time.
constexpr int kMostControlSites = 1000;
// Below every singular value of a matrix of doubles: nothing is truncated.
constexpr double kNoTruncation = 1e-300;

unsigned breaks_named(const std::string& names) {
  unsigned breaks = 0;
  for (std::size_t i = 0; i < std::size(kHardBreaks); ++i)
    if (names.find(kHardBreaks[i]) != std::string::npos) breaks |= 1U << i;
  return breaks;
}

}  // namespace

unsigned HardFigures::breaks(bool error_counts) const {
  return (error_counts && within_jnd < kWithin ? kBreaksError : 0U) | (step_over_N > 0.0 ? kBreaksStep : 0U) |
         (energy_J > kHardEncoder_m * largest_N ? kBreaksEnergy : 0U);
}

std::vector<HardMethod> hard_methods() {
  std::vector<HardMethod> list;
  for (const ModelPlan& plan : all_plans()) {
    if (plan.base == Base::force || plan.method == &kTrendMethod || plan.method == ModelPlan{}.method)
      list.push_back({plan_name(plan), plan});
  }
  list.push_back({kControlName, {.base = Base::force, .method = &kRandomMethod, .centres = kMostControlSites}, true});
  return list;
}

Result<std::vector<HardCase>> hard_cases() {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/hard/cases.json";
  const auto text = read_plain_file(path, "what breaks in the hard cases");
  if (!text) return text.error();
  const auto document = parse_json(*text, path, 4, {});
  if (!document) return document.error();
  std::vector<HardCase> cases = site_cases();
  std::ranges::move(recording_cases(), std::back_inserter(cases));
  std::ranges::move(material_cases(), std::back_inserter(cases));
  const auto methods = document->value("recorded", std::vector<std::string>{});
  for (HardCase& one : cases) {
    const auto found = document->find(one.name);
    if (found == document->end()) return Error{path + ": found no case \"" + one.name + "\", expected one"};
    one.why = found->value("why", "");
    one.unknown = found->value("unknown", "");
    one.refusal = found->value("refused", "");
    const auto broken = found->value("broken", std::map<std::string, std::string>{});
    for (const std::string& method : methods)
      one.breaks[method] = broken.count(method) > 0 ? breaks_named(broken.at(method)) : 0U;
  }
  return cases;
}

Result<MethodFit> HardTraining::untruncated(const FitControl& control) {
  ModelPlan plan = common_;
  plan.base = Base::force;
  plan.method = &kRandomMethod;
  plan.centres = kMostControlSites;
  const auto prepared = fits_.prepare(plan, control);
  if (!prepared) return prepared.error();
  // With every distinct site as a centre the least squares problem of eq. 8 is the interpolation of eq. 4.
  const OpenChoices choices{.truncation = kNoTruncation};
  return fit_method(**prepared, plan, control, nullptr, &choices);
}

Result<HardTraining::Fit> HardTraining::fit(const HardMethod& method, const FitControl& control) {
  if (const auto made = made_.find(method.name); made != made_.end()) return made->second;
  ModelPlan asked = common_;
  asked.base = method.plan.base;
  asked.method = method.plan.method;
  const double start_s = steady_now_s();
  Fit fit;
  const auto keep = [&](const auto& fitted) {
    fit.seconds = steady_now_s() - start_s;
    if (!fitted) {
      fit.refusal = fitted.error().message;
      return;
    }
    fit.model = std::make_shared<const FittedModel>(fitted->data);
    fit.rank = fitted->rank;
    fit.condition_number = fitted->condition_number;
  };
  if (method.untruncated) {
    keep(untruncated(control));
  } else {
    keep(fits_.fit(asked, control));
  }
  if (fit.refusal == interrupted().message) return interrupted();
  return made_[method.name] = fit;
}

std::string missed_by(const HardCell& cell, const HardCase& of, const std::string& method) {
  if (!of.refusal.empty()) {
    if (cell.refusal.empty()) return "fitted, expected a refusal";
    return cell.refusal.find(of.refusal) != std::string::npos
               ? ""
               : "refused with another reason, expected \"" + of.refusal + "\"";
  }
  if (!cell.refusal.empty()) return "refused, expected a fit";
  if (std::isinf(cell.figures.worst_step_N)) return "a force that is not finite";
  const auto recorded = of.breaks.find(method);
  std::string text;
  for (std::size_t i = 0; recorded != of.breaks.end() && i < std::size(kHardBreaks); ++i)
    if ((cell.breaks & ~recorded->second & 1U << i) != 0)
      text += (text.empty() ? "breaks " : ", ") + std::string(kHardBreaks[i]);
  return text;
}

void HardMeasure::add(double force_N, double true_N, bool counts, double position_m) {
  if (std::isfinite(last_m_)) {
    // The trapezoidal rule. A force that pushes the tool out (towards smaller positions) gives out energy.
    const double way_m = position_m - last_m_;
    given_J_ -= 0.5 * (force_N + last_N_) * way_m;
    truly_given_J_ -= 0.5 * (true_N + last_true_N_) * way_m;
    energy_J_ = std::max(energy_J_, given_J_ - std::max(0.0, truly_given_J_));
  }
  const double jnd_N = JndLine{}.at(true_N);
  // A force that is not finite is never within the JND, and an infinite error.
  const double error_N = std::isfinite(force_N) ? std::abs(force_N - true_N) : kEndless;
  if (counts) {
    ++counted_;
    if (error_N <= jnd_N) ++within_;
    worst_N_ = std::max(worst_N_, error_N);
  }
  if (ticks_ > 0) {
    const double change_N = std::abs(force_N - last_N_), step_N = std::isfinite(change_N) ? change_N : kEndless;
    step_N_ = std::max(step_N_, step_N);
    beyond_jnd_N_ = std::max(beyond_jnd_N_, step_N - jnd_N);
    true_step_N_ = std::max(true_step_N_, std::abs(true_N - last_true_N_));
  }
  largest_N_ = std::max(largest_N_, std::abs(true_N));
  last_m_ = position_m;
  last_true_N_ = true_N;
  last_N_ = force_N;
  ++ticks_;
}

HardFigures HardMeasure::figures() const {
  HardFigures figures;
  figures.largest_N = largest_N_;
  if (counted_ > 0) {
    figures.within_jnd = static_cast<double>(within_) / static_cast<double>(counted_);
    figures.worst_error_N = worst_N_;
  }
  if (ticks_ > 1) {
    figures.worst_step_N = step_N_;
    figures.step_over_N = beyond_jnd_N_ - true_step_N_;
  }
  if (std::isfinite(last_m_)) figures.energy_J = energy_J_;
  return figures;
}

}  // namespace palpate
