#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/text.h"
#include "scenes/report/tables.h"

namespace palpate {
namespace {

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100.0 * share);
  return text;
}

std::string figures(const ModelResult& model) {
  return percent(model.pooled.within_jnd) + " within the JND, RMS " + three_digits(1e3 * model.pooled.rms_error_N) +
         " mN, worst error " + three_digits(model.pooled.max_error_over_jnd) + " JND";
}

std::string size_of(const ModelResult& model) {
  const bool grid = model.plan.request.method->can_take(kTakesGrid);
  return std::to_string(model.size) + (grid ? " nodes" : " centres");
}

const ModelResult* smallest_good(const ReportData& data) {
  const ModelResult* best = nullptr;
  for (const ModelResult& model : data.models) {
    if (model.pooled.within_jnd < kGoodShare) continue;
    const bool better = best == nullptr || model.size < best->size ||
                        (model.size == best->size && model.pooled.rms_error_N < best->pooled.rms_error_N);
    if (better) best = &model;
  }
  return best;
}

template <typename Accept>
const ModelResult* most_accurate(const ReportData& data, Accept accept) {
  const ModelResult* best = nullptr;
  for (const ModelResult& model : data.models) {
    if (accept(model) && (best == nullptr || model.pooled.rms_error_N < best->pooled.rms_error_N)) best = &model;
  }
  return best;
}

std::string about_smallest(const ReportData& data) {
  if (const ModelResult* small = smallest_good(data)) {
    return "The smallest model with at least 99.9 % of the samples within the JND is " + small->plan.name + " (" +
           size_of(*small) + "): " + figures(*small) + ".";
  }
  const ModelResult* best = nullptr;
  for (const ModelResult& model : data.models) {
    if (best == nullptr || model.pooled.within_jnd > best->pooled.within_jnd) best = &model;
  }
  return "No model keeps 99.9 % of the samples within the JND; " + best->plan.name + " comes nearest: " +
         figures(*best) + ".";
}

std::string about_coverage(const ReportData& data) {
  if (data.coverage.errors.empty()) return {};
  const CoverageErrors& reference = data.coverage.errors.back();
  const double all = static_cast<double>(reference.inside.samples + reference.outside.samples);
  if (reference.outside.samples == 0) return "The test never left the training data.";
  std::string text = percent(static_cast<double>(reference.outside.samples) / all) +
                     " of the test samples lie away from the training data; there " + reference.model + " has " +
                     percent(reference.outside.within_jnd) + " within the JND";
  if (reference.inside.samples > 0) text += ", near the data " + percent(reference.inside.within_jnd);
  return text + ".";
}

// Where the surface of a test recording decides the figures of the best model.
std::string about_surface(const ReportData& data) {
  double farthest_m = 0.0;
  std::size_t which = 0;
  for (std::size_t r = 0; r < data.surface_offset_m.size(); ++r) {
    if (std::abs(data.surface_offset_m[r]) <= std::abs(farthest_m)) continue;
    farthest_m = data.surface_offset_m[r];
    which = r;
  }
  if (farthest_m == 0.0) return {};
  const ModelResult* best = nullptr;
  for (const ModelResult& model : data.models) {
    if (best == nullptr || model.pooled_moved.within_jnd > best->pooled_moved.within_jnd) best = &model;
  }
  const auto moved = std::count_if(data.surface_offset_m.begin(), data.surface_offset_m.end(),
                                   [](double offset_m) { return offset_m != 0.0; });
  return std::to_string(moved) + " of " + std::to_string(data.surface_offset_m.size()) +
         " test recordings have their surface elsewhere than the models (" + data.test_names[which] + " farthest, by " +
         fixed(1e3 * farthest_m, 3) + " mm). With the surface moved " + best->plan.name + " has " +
         percent(best->pooled_moved.within_jnd) + " within the JND and RMS " +
         three_digits(1e3 * best->pooled_moved.rms_error_N) + " mN, as recorded " + percent(best->pooled.within_jnd) +
         " and " + three_digits(1e3 * best->pooled.rms_error_N) + " mN.";
}

std::string about_seeds(const ReportData& data) {
  std::map<std::string, std::pair<double, double>> ranges;  // smallest and largest RMS
  std::map<std::string, std::size_t> counts;
  for (const SeedResult& seed : data.seeds) {
    const double rms = 1e3 * seed.errors.rms_error_N;
    auto [at, fresh] = ranges.try_emplace(seed.model.name, rms, rms);
    at->second = {std::min(at->second.first, rms), std::max(at->second.second, rms)};
    ++counts[seed.model.name];
  }
  std::string text;
  for (const auto& [model, range] : ranges) {
    text += (text.empty() ? "Over " + std::to_string(counts[model]) + " seeds the RMS error of " : ", of ") + model +
            " lies between " + three_digits(range.first) + " and " + three_digits(range.second) + " mN";
  }
  return text.empty() ? text : text + ".";
}

}  // namespace

std::vector<std::string> findings(const ReportData& data, bool with_times) {
  std::vector<std::string> sentences;
  if (data.models.empty()) return sentences;
  if (with_times) {
    const ModelResult* quick = most_accurate(data, [](const ModelResult& model) {
      return model.time.measured && model.time.median_ns <= kQuick_ns;
    });
    if (quick != nullptr) {
      sentences.push_back("The most accurate model within 1 µs an evaluation is " + quick->plan.name + " (" +
                          three_digits(quick->time.median_ns) + " ns): " + figures(*quick) + ".");
    } else {
      sentences.push_back("No model takes less than 1 µs an evaluation on this machine.");
    }
    const auto slow = std::count_if(data.models.begin(), data.models.end(), [](const ModelResult& model) {
      return model.time.measured && model.time.p99_ns > kBudget_ns;
    });
    sentences.push_back(slow == 0 ? "Every model, the direct one with all its centres included, fits a tick of 1 ms."
                                  : std::to_string(slow) + " models do not fit a tick of 1 ms on this machine.");
    return sentences;
  }
  sentences.push_back(about_smallest(data));
  for (std::string sentence : {about_coverage(data), about_surface(data), about_seeds(data)}) {
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  }
  return sentences;
}

}  // namespace palpate
