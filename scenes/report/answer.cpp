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

void append(Sentence& sentence, const Sentence& more) { sentence.insert(sentence.end(), more.begin(), more.end()); }

std::string unit_words(const UnitErrors& errors) {
  return std::to_string(errors.units()) + " " + unit_name(errors) + (errors.units() == 1 ? "" : "s");
}

Sentence errors_of(const ModelResult& model) {
  const UnitErrors& errors = model.errors;
  Sentence sentence{number(model, "within_jnd", percent(errors.within_jnd)),
                    {" of the test has an error of at most one JND, which a hand cannot notice ("}};
  const SentencePart beyond = number(
      model, "beyond_units", std::to_string(errors.units_above_jnd) + " of " + unit_words(errors) + " exceed it");
  if (!errors.has_intervals()) {
    append(sentence, {beyond, {", too few for an interval"}});
  } else if (errors.units_above_jnd == 0) {
    append(sentence, {beyond,
                      {"; 95 %: at most "},
                      number(model, "units_at_most", percent(1.0 - errors.within_at_least())),
                      {" do"}});
  } else {
    append(sentence,
           {{"95 %: at least "}, number(model, "within_at_least", percent(errors.within_at_least())), {"; "}, beyond});
  }
  append(sentence, {{"), and 99 % of the errors are below "},
                    number(model, "p99_error_over_jnd", three_digits(errors.p99_error_over_jnd)),
                    {" JND"}});
  if (errors.has_intervals())
    append(sentence, {{" (95 %: "}, number(model, "p99_at_most", three_digits(errors.p99_at_most())), {")"}});
  append(sentence, {{". "}});
  return sentence;
}

std::string changed(double jnd) { return three_digits(std::abs(jnd)) + (jnd < 0.0 ? " smaller" : " larger"); }

// Compares time and error of `other` with the recommended model.
Sentence compared(const ModelResult& other, const ModelResult& recommended) {
  const PairedDifference difference = paired_difference(other.errors, recommended.errors);
  Sentence sentence{
      name(other),
      {" takes "},
      number(other, "time_ratio", three_digits(other.time.tick.median_ns / recommended.time.tick.median_ns)),
      {" times the time ("},
      tick(other),
      {"), and its 99 % error is "},
      number(other, "difference", three_digits(std::abs(difference.p99))),
      {difference.p99 < 0.0 ? " JND smaller" : " JND larger"}};
  if (difference.interval.known()) {
    append(sentence,
           {{" (95 %: " + changed(difference.interval.low) + " to " + changed(difference.interval.high) + ")"}});
  }
  append(sentence, {{". "}});
  return sentence;
}

// The test recording whose surface is farthest from the models'.
const MovedSurface* farthest(const ReportData& data) {
  const auto at = std::max_element(data.tested.begin(), data.tested.end(), [](const auto& a, const auto& b) {
    return std::abs(a.offset_m) < std::abs(b.offset_m);
  });
  return at == data.tested.end() || at->offset_m == 0.0 ? nullptr : &*at;
}

Sentence moved(const ReportData& data, const ModelResult& model) {
  const MovedSurface* surface = farthest(data);
  if (surface == nullptr || model.moved.within_jnd - model.errors.within_jnd < kShareThatMatters) return {};
  return {{"The surface of " + surface->name + " is at " + three_digits(1e3 * surface->offset_m) +
           " mm for these models; with it moved, which uses the forces of the test, " +
           percent(model.moved.within_jnd) + " of the test is within the JND. "}};
}

}  // namespace

std::string percent(double share) { return share >= 1.0 ? "100 %" : fixed(std::floor(1e4 * share) / 100.0, 2) + " %"; }

Sentence answer(const ReportData& data) {
  const ModelResult& use = data.models[data.choice.recommended];
  const bool good = use.errors.within_jnd >= kGoodShare;
  Sentence sentence{{good ? "Use " : "No model is good enough as recorded. The best choice is "},
                    name(use),
                    {": a whole tick takes "},
                    tick(use)};
  append(sentence, {{", "},
                    number(use, "tick_share", three_digits(100.0 * use.time.tick.median_ns / kBudget_ns)),
                    {" % of 1 ms; "}});
  append(sentence, errors_of(use));
  append(sentence, moved(data, use));
  if (data.choice.correction_off)
    append(sentence, {{"The RBF correction is off on this material: all methods equal the trend. "}});
  const ModelResult* best = &use;
  const ModelResult* paper = nullptr;
  for (const std::size_t i : data.choice.candidates) {
    const ModelResult& one = data.models[i];
    if (one.errors.p99_error_over_jnd < best->errors.p99_error_over_jnd) best = &one;
    if (one.plan.recipe == Recipe::paper && one.plan.request.method == &kGreedyMethod) paper = &one;
  }
  if (best != &use) append(sentence, compared(*best, use));
  if (data.choice.dominating) {
    append(sentence, {{"Another size was faster and had a smaller 99 % error in this test: "}});
    append(sentence, compared(data.models[*data.choice.dominating], use));
    append(sentence, {{"A size that is chosen by a test has to be tested on another recording. "}});
  }
  if (paper != nullptr && paper != &use && paper != best) append(sentence, compared(*paper, use));
  return sentence;
}

std::string html_of(const Sentence& sentence) {
  std::string html;
  for (const SentencePart& words : sentence) {
    const std::string text = escape_html(words.text);
    const std::string model = "<span data-model=\"" + escape_html(words.model) + "\" data-figure=\"";
    html += words.model.empty()    ? text
            : words.figure.empty() ? "<b>" + text + "</b>"
                                   : model + words.figure + "\">" + text + "</span>";
  }
  return html;
}

std::string plain_text_of(const Sentence& sentence) {
  std::string text;
  for (const SentencePart& words : sentence) text += words.text;
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

}  // namespace palpate
