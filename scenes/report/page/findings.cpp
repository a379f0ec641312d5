#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/report/measure/recommendation.h"
#include "scenes/report/page/tables.h"

namespace palpate {
namespace {

std::string percent_text(double share) { return fixed(100.0 * share, 2) + " %"; }

std::string figures(const ErrorSummary& errors) {
  return percent_text(errors.within_jnd) + " within the JND, 99 % of the errors up to " +
         three_digits(errors.p99_error_over_jnd) + " JND";
}

const ModelResult* find_model(const ReportData& data, const std::string& name) {
  for (const ModelResult& model : data.models) {
    if (model.plan.name == name) return &model;
  }
  return nullptr;
}

// The last main model of a rung stands for it.
const ModelResult* of_rung(const ReportData& data, Rung rung) {
  const ModelResult* last = nullptr;
  for (const ModelResult& model : data.models) {
    if (model.plan.main && model.plan.rung == rung) last = &model;
  }
  return last;
}

// "1, 2 and 3".
std::string enumerated(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  }
  return text;
}

// What the centres are worth beside the trend, as far as the test can tell.
std::string about_centres(const ModelResult* trend, const ModelResult* own) {
  if (trend == nullptr || own == nullptr || own->pooled.samples == 0) return {};
  if (tied(trend->pooled, own->pooled)) {
    return " What the centres gain over the trend alone, this test cannot tell: the two are tied.";
  }
  const bool better = own->pooled.p99_error_over_jnd < trend->pooled.p99_error_over_jnd;
  return std::string(better ? " Over the trend alone the centres gain " : " Against the trend alone the centres lose ") +
         three_digits(std::abs(own->pooled.p99_error_over_jnd - trend->pooled.p99_error_over_jnd)) + " JND of that.";
}

std::string about_ladder(const ReportData& data) {
  std::vector<std::string> shares;
  std::vector<std::string> limits;
  for (const Rung rung : {Rung::no_force, Rung::trend, Rung::paper, Rung::palpate}) {
    const ModelResult* model = of_rung(data, rung);
    if (model == nullptr || model->pooled.samples == 0) continue;
    const std::string name = rung == Rung::no_force ? std::string("a model that always says 0 N")
                             : rung == Rung::trend  ? std::string("the trend alone")
                                                    : std::string(rung_name(rung)) + " (" + model->plan.name + ")";
    shares.push_back(name + " has " + percent_text(model->pooled.within_jnd));
    limits.push_back(three_digits(model->pooled.p99_error_over_jnd));
  }
  if (shares.empty()) return {};
  return "Within the JND of the test: " + enumerated(shares) + " of the samples. 99 % of the errors are up to " +
         enumerated(limits) + " JND." + about_centres(of_rung(data, Rung::trend), of_rung(data, Rung::palpate));
}

std::string about_recommendation(const ReportData& data) {
  const Recommendation& choice = data.recommendation;
  if (choice.reason.empty()) return {};
  return (choice.recommended.empty() ? "" : "Recommended: " + choice.recommended + ". ") + choice.reason;
}

// Who cannot be told from the recommended model on the test.
std::string about_ties(const ReportData& data) {
  const ModelResult* chosen = find_model(data, data.recommendation.recommended);
  if (chosen == nullptr || chosen->pooled.samples == 0) return {};
  std::size_t count = 0;
  std::size_t better = 0;
  for (const ModelResult& model : data.models) {
    if (&model == chosen || model.plan.rung == Rung::no_force) continue;
    if (tied(model.pooled, chosen->pooled)) ++count;
    else if (model.pooled.p99_error_over_jnd < chosen->pooled.p99_error_over_jnd) ++better;
  }
  const std::size_t others = data.models.size() - 2;  // without 0 N and the chosen one
  std::string text = "On the test " +
                     (count == others ? "all " + std::to_string(others) + " other models are"
                                      : std::to_string(count) + " of the " + std::to_string(others) + " other models " +
                                            (count == 1 ? "is" : "are")) +
                     " tied with it (their 95 % intervals overlap)";
  text += better > 0 ? ", and " + std::to_string(better) + (better == 1 ? " is better." : " are better.")
                     : ", and none is better.";
  const Evidence& evidence = chosen->pooled;
  if (evidence.strokes < kFewStrokes) {
    text += " The test has few strokes (" + std::to_string(evidence.strokes) +
            "): its intervals are too narrow to be believed.";
  }
  if (evidence.beyond_samples > 0 && evidence.beyond_strokes < 3) {
    text += " Few samples decide: the " + std::to_string(evidence.beyond_samples) +
            (evidence.beyond_samples == 1 ? " sample" : " samples") + " beyond the JND lie in " +
            (evidence.beyond_strokes == 1 ? std::string("one stroke.") : std::to_string(evidence.beyond_strokes) + " strokes.");
  }
  return text;
}

std::string about_floors(const ReportData& data) {
  if (data.test_names.empty()) return {};
  const NoiseFloor& floor = data.pooled_floor;
  std::string text = "With a force noise of " + three_digits(1e3 * floor.force_noise_N) +
                     " mN a perfect model would have " + percent_text(floor.within_jnd) +
                     " within the JND and 99 % of its errors up to " + three_digits(floor.p99_error_over_jnd) + " JND.";
  const ModelResult* model = of_rung(data, Rung::palpate);
  if (model == nullptr) model = of_rung(data, Rung::paper);
  const bool moved = std::any_of(data.surface_offset_m.begin(), data.surface_offset_m.end(),
                                 [](double offset_m) { return offset_m != 0.0; });
  if (moved && model != nullptr) {
    std::vector<std::string> offsets;
    for (const double offset_m : data.surface_offset_m) offsets.push_back(fixed(1e3 * offset_m, 2));
    text += " For these models the surface of the test lies at " + enumerated(offsets) + " mm; moved there, " +
            model->plan.name + " has " + percent_text(model->pooled_moved.within_jnd) + " within the JND (as recorded " +
            percent_text(model->pooled.within_jnd) + ") and 99 % of its errors up to " +
            three_digits(model->pooled_moved.p99_error_over_jnd) + " JND (as recorded " +
            three_digits(model->pooled.p99_error_over_jnd) + ").";
  }
  return text;
}

std::string about_coverage(const ReportData& data) {
  for (const CoverageErrors& errors : data.coverage.errors) {
    if (errors.model != data.coverage.reference) continue;
    const double all = static_cast<double>(errors.inside.samples + errors.outside.samples);
    if (errors.outside.samples == 0) {
      return errors.model + " found no test sample away from its training data.";
    }
    std::string text = percent_text(static_cast<double>(errors.outside.samples) / all) +
                       " of the test samples lie away from the training data; there " + errors.model + " has " +
                       percent_text(errors.outside.within_jnd) + " within the JND";
    if (errors.inside.samples > 0) text += ", near the data " + percent_text(errors.inside.within_jnd);
    return text + ".";
  }
  return {};
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
    text += (text.empty() ? "Over " + std::to_string(counts[model]) + " seeds the RMS error of " : ", that of ") + model +
            (three_digits(range.first) == three_digits(range.second)
                 ? " is always " + three_digits(range.first) + " mN"
                 : " lies between " + three_digits(range.first) + " and " + three_digits(range.second) + " mN");
  }
  return text.empty() ? text : text + ".";
}

std::vector<std::string> time_findings(const ReportData& data) {
  std::vector<std::string> sentences;
  const ModelResult* chosen = find_model(data, data.recommendation.recommended);
  if (chosen != nullptr && chosen->time.measured) {
    sentences.push_back("One evaluation of " + chosen->plan.name + " takes " + three_digits(chosen->time.median_ns) +
                        " ns, " + three_digits(100.0 * chosen->time.median_ns / kBudget_ns) +
                        " % of a tick of 1 ms: " + figures(chosen->pooled) + ".");
  }
  const auto slow = std::count_if(data.models.begin(), data.models.end(), [](const ModelResult& model) {
    return model.time.measured && model.time.p99_ns > kBudget_ns;
  });
  sentences.push_back(slow == 0 ? "Every model, the direct one with all its centres included, fits a tick of 1 ms."
                                : std::to_string(slow) + " models do not fit a tick of 1 ms on this machine.");
  return sentences;
}

}  // namespace

std::vector<std::string> findings(const ReportData& data, bool with_times) {
  if (data.models.empty()) return {};
  if (with_times) return time_findings(data);
  std::vector<std::string> sentences;
  for (std::string sentence : {about_ladder(data), about_recommendation(data), about_ties(data), about_floors(data),
                               about_coverage(data), about_seeds(data)}) {
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  }
  return sentences;
}

}  // namespace palpate
