#include "scenes/study/quest_plus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/tick/jnd.h"
#include "scenes/study/study_plan.h"

namespace palpate {
namespace {

constexpr int kGridSteps = 20;
constexpr std::array<double, 5> kOrderBiases = {-0.6, -0.3, 0.0, 0.3, 0.6};
constexpr std::array<double, 3> kLapses = {0.0, 0.02, 0.05};
constexpr std::size_t kPerLine = kOrderBiases.size() * kLapses.size();
constexpr std::size_t kMagnitudes = 16;
constexpr double kMagnitudeStep = 0.025;
constexpr std::size_t kReferences = kReferenceForces_N.size();

double logarithmic(double from, double to, int step) {
  return from * std::pow(to / from, static_cast<double>(step) / kGridSteps);
}

// The grid: JND lines at the criterion kJndCriterion.
std::vector<JndLine> make_lines() {
  const double weak_N = kReferenceForces_N.front(), strong_N = kReferenceForces_N.back();
  std::vector<JndLine> lines;
  for (int i = 0; i <= kGridSteps; ++i) {
    for (int k = 0; k <= kGridSteps; ++k) {
      const double weak_jnd_N = weak_N * logarithmic(0.05, 1.2, i);
      const double strong_jnd_N = strong_N * logarithmic(0.04, 0.6, k);
      const double weber_fraction = (strong_jnd_N - weak_jnd_N) / (strong_N - weak_N);
      const double offset_N = weak_jnd_N - weber_fraction * weak_N;
      if (weber_fraction >= 0.0 && offset_N >= 0.0) lines.push_back({offset_N, weber_fraction});
    }
  }
  return lines;
}

const std::vector<JndLine>& lines() {
  static const std::vector<JndLine> kLines = make_lines();
  return kLines;
}

double relative_jnd_of(const JndLine& line, std::size_t reference) {
  return line.at(kReferenceForces_N[reference]) / kReferenceForces_N[reference];
}

// Parameter combination i is line i / kPerLine with a bias and a lapse rate.
double probability(std::size_t i, std::size_t reference, double difference, bool comparison_first) {
  static const double kDeviations = normal_quantile(kJndCriterion);
  PsychometricFunction function;
  function.slope = kDeviations / relative_jnd_of(lines()[i / kPerLine], reference);
  function.order_bias = kOrderBiases[i % kPerLine / kLapses.size()];
  function.lapse = kLapses[i % kLapses.size()];
  return function.at(difference, comparison_first);
}

// Of a yes or no, in nats.
double entropy(double p) noexcept {
  if (p <= 0.0 || p >= 1.0) return 0.0;
  return -p * std::log(p) - (1.0 - p) * std::log1p(-p);
}

// The probabilities of all stimuli for all parameters, computed once. Only larger
// comparisons: a smaller one in the other order is the mirror image, p as 1 - p, which
// tells as much.
struct Table {
  Table() {
    for (std::size_t reference = 0; reference < kReferences; ++reference) {
      for (std::size_t m = 0; m < kMagnitudes; ++m) {
        for (const bool first : {false, true}) {
          std::vector<double>& row = rows[reference][m][first ? 1 : 0];
          for (std::size_t i = 0; i < lines().size() * kPerLine; ++i) {
            row.push_back(probability(i, reference, kMagnitudeStep * static_cast<double>(m + 1), first));
          }
        }
      }
    }
  }
  std::array<std::array<std::array<std::vector<double>, 2>, kMagnitudes>, kReferences> rows;
};

const Table& table() {
  static const auto kTable = std::make_unique<const Table>();
  return *kTable;
}

// How much the answer is expected to tell about the line, whatever bias and lapse rate.
double information_on_line(const std::vector<double>& weights, const std::vector<double>& p) {
  double larger = 0.0, given_line = 0.0;
  for (std::size_t from = 0; from < weights.size(); from += kPerLine) {
    double weight = 0.0, sum = 0.0;
    for (std::size_t i = from; i < from + kPerLine; ++i) {
      weight += weights[i];
      sum += weights[i] * p[i];
    }
    larger += sum;
    if (weight > 1e-9) given_line += weight * entropy(sum / weight);  // less tells nothing
  }
  return entropy(larger) - given_line;
}

// Values and their shares, in order of the value, equal values together.
using Distribution = std::vector<std::pair<double, double>>;

// Half of each share lies below its value; between values linear in the logarithm.
double quantile(const Distribution& distribution, double share) {
  double before = 0.0, at_last = 0.0, last = distribution.front().first;
  for (const auto& [value, weight] : distribution) {
    const double here = before + 0.5 * weight;
    if (here >= share) {
      if (here <= at_last || value <= last) return value;
      return last * std::pow(value / last, (share - at_last) / (here - at_last));
    }
    before += weight;
    at_last = here;
    last = value;
  }
  return last;
}

}  // namespace

QuestPlus::QuestPlus() : weights_(lines().size() * kPerLine, 1.0 / static_cast<double>(lines().size() * kPerLine)) {}

double QuestPlus::next_difference(std::size_t reference, bool comparison_larger, bool comparison_first) const {
  const bool first = comparison_larger ? comparison_first : !comparison_first;
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t m = 0; m < kMagnitudes; ++m) {
    const double information = information_on_line(weights_, table().rows[reference][m][first ? 1 : 0]);
    if (information <= most) continue;
    most = information;
    best = m;
  }
  return kMagnitudeStep * static_cast<double>(best + 1);
}

void QuestPlus::answered(std::size_t reference, double difference, bool comparison_first,
                         bool comparison_judged_larger) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const double p = probability(i, reference, difference, comparison_first);
    sum += weights_[i] *= comparison_judged_larger ? p : 1.0 - p;
  }
  for (double& weight : weights_) weight /= sum;
}

Estimate QuestPlus::relative_jnd(std::size_t reference, double criterion, double level) const {
  Distribution distribution;
  for (std::size_t line = 0; line < lines().size(); ++line) {
    double weight = 0.0;
    for (std::size_t i = line * kPerLine; i < (line + 1) * kPerLine; ++i) weight += weights_[i];
    distribution.emplace_back(relative_jnd_of(lines()[line], reference), weight);
  }
  std::sort(distribution.begin(), distribution.end());
  Distribution merged;
  for (const auto& [value, weight] : distribution) {
    if (!merged.empty() && value < merged.back().first * (1.0 + 1e-9)) {
      merged.back().second += weight;
    } else {
      merged.emplace_back(value, weight);
    }
  }
  const double factor = normal_quantile(criterion) / normal_quantile(kJndCriterion);
  return {factor * quantile(merged, 0.5), factor * quantile(merged, 0.5 * (1.0 - level)),
          factor * quantile(merged, 0.5 * (1.0 + level)), true};
}

}  // namespace palpate
