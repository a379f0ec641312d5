#include "scenes/report/answer.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/plot/inline_svg.h"
#include "scenes/report/table.h"

namespace palpate {
namespace {

constexpr double kBudget_ns = 1e6;
// No model is recommended if less than this share of the test samples is within the JND.
constexpr double kGoodShare = 0.9;
// The answer mentions the surface only if moving it changes the share within the JND by more.
constexpr double kShareThatMatters = 0.005;

SentencePart number(const ModelResult& model, const char* figure, const std::string& text) {
  return {text, model.plan.name, figure};
}

SentencePart name(const ModelResult& model) { return {model.plan.name, model.plan.name}; }

SentencePart tick(const ModelResult& model) {
  return number(model, "tick_ns", with_thousands(fixed(model.time.tick.median_ns, 0)) + " ns");
}

std::string unit_words(const UnitErrors& errors) {
  return std::to_string(errors.units()) + " " + unit_name(errors) + (errors.units() == 1 ? "" : "s");
}

void add_errors(Sentence& sentence, const ModelResult& model) {
  const UnitErrors& errors = model.errors;
  const SentencePart beyond = number(
      model, "beyond_units", std::to_string(errors.units_above_jnd) + " of " + unit_words(errors) + " exceed it");
  sentence << number(model, "within_jnd", percent(errors.within_jnd))
           << " of the test has an error of at most one JND, which a hand cannot notice (";
  if (!errors.has_intervals()) {
    sentence << beyond << ", too few for an interval";
  } else if (errors.units_above_jnd == 0) {
    sentence << beyond << "; 95 %: at most " << number(model, "units_at_most", percent(1.0 - errors.within_at_least()))
             << " do";
  } else {
    sentence << "95 %: at least " << number(model, "within_at_least", percent(errors.within_at_least())) << "; "
             << beyond;
  }
  sentence << "), and 99 % of the errors are below "
           << number(model, "p99_error_over_jnd", three_digits(errors.p99_error_over_jnd)) << " JND";
  if (errors.has_intervals())
    sentence << " (95 %: " << number(model, "p99_at_most", three_digits(errors.p99_at_most())) << ")";
  sentence << ". ";
}

std::string changed(double jnd) { return three_digits(std::abs(jnd)) + (jnd < 0.0 ? " smaller" : " larger"); }

// Compares time and error of `other` with the recommended model.
void add_comparison(Sentence& sentence, const ModelResult& other, const ModelResult& recommended) {
  const PairedDifference difference = paired_difference(other.errors, recommended.errors);
  const double time_ratio = other.time.tick.median_ns / recommended.time.tick.median_ns;
  sentence << name(other) << " takes " << number(other, "time_ratio", three_digits(time_ratio)) << " times the time ("
           << tick(other) << "), and its 99 % error is "
           << number(other, "difference", three_digits(std::abs(difference.p99)))
           << (difference.p99 < 0.0 ? " JND smaller" : " JND larger");
  if (difference.interval.known())
    sentence << " (95 %: " + changed(difference.interval.low) + " to " + changed(difference.interval.high) + ")";
  sentence << ". ";
}

// The test recording whose surface is farthest from the models'.
const MovedSurface* farthest(const ReportData& data) {
  const auto at = std::max_element(data.tested.begin(), data.tested.end(), [](const auto& a, const auto& b) {
    return std::abs(a.offset_m) < std::abs(b.offset_m);
  });
  return at == data.tested.end() || at->offset_m == 0.0 ? nullptr : &*at;
}

void add_surface(Sentence& sentence, const ReportData& data, const ModelResult& model) {
  const MovedSurface* surface = farthest(data);
  if (surface == nullptr || model.moved.within_jnd - model.errors.within_jnd < kShareThatMatters) return;
  sentence << "The surface of " + surface->name + " is at " + three_digits(1e3 * surface->offset_m) +
                  " mm for these models; with it moved, which uses the forces of the test, " +
                  percent(model.moved.within_jnd) + " of the test is within the JND. ";
}

}  // namespace

std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

Sentence answer(const ReportData& data) {
  const ModelResult& use = data.models[data.choice.recommended];
  const bool good = use.errors.within_jnd >= kGoodShare;
  Sentence sentence;
  sentence << (good ? "Use " : "No model is good enough as recorded. The best choice is ") << name(use)
           << ": a whole tick takes " << tick(use) << ", "
           << number(use, "tick_share", three_digits(100.0 * use.time.tick.median_ns / kBudget_ns)) << " % of 1 ms; ";
  add_errors(sentence, use);
  add_surface(sentence, data, use);
  if (data.choice.correction_off)
    sentence << "The RBF correction is off on this material: all methods equal the trend. ";
  const ModelResult& best = data.models[data.choice.best];
  if (&best != &use) add_comparison(sentence, best, use);
  if (data.choice.dominating) {
    sentence << "Another size was faster and had a smaller 99 % error in this test: ";
    add_comparison(sentence, data.models[*data.choice.dominating], use);
    sentence << "A size that is chosen by a test has to be tested on another recording. ";
  }
  for (const std::size_t i : data.choice.candidates) {
    const ModelResult& one = data.models[i];
    if (one.plan.is_greedy_2009() && &one != &use && &one != &best) add_comparison(sentence, one, use);
  }
  return sentence;
}

std::string Sentence::html() const {
  std::string html;
  for (const SentencePart& words : parts_) {
    const std::string text = escape_html(words.text);
    const std::string model = "<span data-model=\"" + escape_html(words.model) + "\" data-figure=\"";
    html += words.model.empty()    ? text
            : words.figure.empty() ? "<b>" + text + "</b>"
                                   : model + words.figure + "\">" + text + "</span>";
  }
  return html;
}

std::string Sentence::plain_text() const {
  std::string text;
  for (const SentencePart& words : parts_) text += words.text;
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

}  // namespace palpate
