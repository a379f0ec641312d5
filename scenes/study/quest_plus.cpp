#include "scenes/study/quest_plus.h"

#include <cmath>
#include <memory>

namespace palpate {
namespace {

constexpr std::size_t kSigmas = 43;  // a tenth apart
constexpr double kLeastSigma = 0.03;
constexpr double kLargestSigma = 2.0;
constexpr std::array<double, 5> kOrderBiases = {-0.6, -0.3, 0.0, 0.3, 0.6};
constexpr std::array<double, 3> kLapses = {0.0, 0.02, 0.05};
constexpr std::size_t kPerSigma = kOrderBiases.size() * kLapses.size();
constexpr std::size_t kParameters = kSigmas * kPerSigma;
constexpr std::size_t kMagnitudes = 16;
constexpr double kMagnitudeStep = 0.025;

double sigma_step() noexcept { return std::log(kLargestSigma / kLeastSigma) / static_cast<double>(kSigmas - 1); }
double sigma_at(double place) noexcept { return kLeastSigma * std::exp(place * sigma_step()); }

double probability(std::size_t parameter, double difference, bool comparison_first) noexcept {
  PsychometricFunction function;
  function.slope = 1.0 / sigma_at(static_cast<double>(parameter / kPerSigma));
  function.order_bias = kOrderBiases[parameter % kPerSigma / kLapses.size()];
  function.lapse = kLapses[parameter % kLapses.size()];
  return function.at(difference, comparison_first);
}

// Of a yes or no, in nats.
double entropy(double p) noexcept {
  if (p <= 0.0 || p >= 1.0) return 0.0;
  return -p * std::log(p) - (1.0 - p) * std::log1p(-p);
}

// What every trial needs of every parameter combination, computed once.
struct Table {
  Table() {
    for (std::size_t kind = 0; kind < 4; ++kind) {
      for (std::size_t m = 0; m < kMagnitudes; ++m) {
        const double difference = (kind & 2 ? 1.0 : -1.0) * kMagnitudeStep * static_cast<double>(m + 1);
        for (std::size_t i = 0; i < kParameters; ++i) {
          p[kind][m][i] = probability(i, difference, (kind & 1) != 0);
          h[kind][m][i] = entropy(p[kind][m][i]);
        }
      }
    }
  }
  using PerKind = std::array<std::array<std::array<double, kParameters>, kMagnitudes>, 4>;
  PerKind p;  // kind: 2 x larger + first
  PerKind h;
};

const Table& table() {
  static const auto kTable = std::make_unique<const Table>();
  return *kTable;
}

}  // namespace

QuestPlus::QuestPlus() : weights_(kParameters, 1.0 / static_cast<double>(kParameters)) {}

double QuestPlus::next_difference(bool comparison_larger, bool comparison_first) const {
  const std::size_t kind = (comparison_larger ? 2u : 0u) + (comparison_first ? 1u : 0u);
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t m = 0; m < kMagnitudes; ++m) {
    double p = 0.0, h = 0.0;
    for (std::size_t i = 0; i < kParameters; ++i) {
      p += weights_[i] * table().p[kind][m][i];
      h += weights_[i] * table().h[kind][m][i];
    }
    const double information = entropy(p) - h;
    if (information <= most) continue;
    most = information;
    best = m;
  }
  return kMagnitudeStep * static_cast<double>(best + 1);
}

void QuestPlus::answered(double difference, bool comparison_first, bool comparison_judged_larger) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kParameters; ++i) {
    const double p = probability(i, difference, comparison_first);
    weights_[i] *= comparison_judged_larger ? p : 1.0 - p;
    sum += weights_[i];
  }
  for (double& weight : weights_) weight /= sum;
}

// Each sigma of the grid stands for half a step to both sides.
double QuestPlus::quantile(double share) const {
  double below = 0.0;
  for (std::size_t s = 0; s < kSigmas; ++s) {
    double here = 0.0;
    for (std::size_t i = 0; i < kPerSigma; ++i) here += weights_[s * kPerSigma + i];
    if (below + here >= share && here > 0.0) {
      return sigma_at(static_cast<double>(s) - 0.5 + (share - below) / here);
    }
    below += here;
  }
  return sigma_at(static_cast<double>(kSigmas) - 0.5);
}

Estimate QuestPlus::relative_jnd(double criterion, double level) const {
  const double deviations = normal_quantile(criterion);
  return {deviations * quantile(0.5), deviations * quantile(0.5 * (1.0 - level)),
          deviations * quantile(0.5 * (1.0 + level)), true};
}

}  // namespace palpate
