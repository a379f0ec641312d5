#include "tests/bench/peer_data.h"

#include <algorithm>
#include <limits>
#include <set>

#include "engine/tick/replay.h"
#include "scenes/evaluation/error_figures.h"
#include "tests/support/fitting.h"

namespace palpate::bench {
namespace {

constexpr int kLeaveOut = 5;  // every fifth fold is left out

PreparedTraining with_forces(PreparedTraining prepared) {
  prepared.sites.target_N = prepared.sites.force_N;
  return prepared;
}

PeerData make_data() {
  const PreparedTraining prepared =
      test::prepare({test::train_recording("silicone")}, test::scene_request("silicone_block"));
  PeerData data{with_forces(prepared), prepared, {}, {}, {}, {}};
  const ModelData& common = prepared.common;
  const auto d = static_cast<Eigen::Index>(common.features.size());
  const DomainGuard guard(common.cover);
  const test::ModelPtr model = test::fit(prepared, &kRandomMethod);  // needed only for its features
  std::vector<double> points, force_N, trend_N, trust;
  replay(*test::test_recording("silicone"), {model},
         [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
           if (!snapshot.in_contact) return;
           const double* features = tick.features_of(0).values.data();
           const Eigen::VectorXd u =
               (Eigen::Map<const Eigen::VectorXd>(features, d) - common.offset).cwiseQuotient(common.scale);
           points.insert(points.end(), u.begin(), u.end());
           force_N.push_back(row.force_N);
           trend_N.push_back(common.trend.at(features, common.features));
           trust.push_back(guard.trust(u.data()));
         });
  const auto n = static_cast<Eigen::Index>(force_N.size());
  data.test_points = Eigen::Map<const Eigen::MatrixXd>(points.data(), d, n);
  data.test_force_N = Eigen::Map<const Eigen::VectorXd>(force_N.data(), n);
  data.test_trend_N = Eigen::Map<const Eigen::VectorXd>(trend_N.data(), n);
  data.test_trust = Eigen::Map<const Eigen::VectorXd>(trust.data(), n);
  return data;
}

PeerError error_of(const Eigen::VectorXd& force_N) {
  const PeerData& data = peer_data();
  const ModelData& common = data.forces.common;
  ErrorFigures figures;
  for (Eigen::Index i = 0; i < data.test_force_N.size(); ++i) {
    const double force = force_N[i] > 0.0 ? force_N[i] : 0.0;
    figures.add(std::min(force, kForceMargin * common.largest_force_N), data.test_force_N[i], false, common.jnd);
  }
  return {figures.summary(common.jnd).rms_error_N, figures.within_jnd()};
}

// Those sites of `all` for which `wanted` holds.
template <typename Wanted>
Sites some_sites(const Sites& all, const Wanted& wanted) {
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < all.count(); ++i)
    if (wanted(i)) chosen.push_back(i);
  Sites some = all;
  some.points = all.points(Eigen::all, chosen);
  some.target_N = all.target_N(chosen);
  some.row_scale = all.row_scale(chosen);
  some.force_N = all.force_N(chosen);
  some.samples = all.samples(chosen);
  some.fold.clear();
  for (const Eigen::Index i : chosen) some.fold.push_back(all.fold[static_cast<std::size_t>(i)]);
  return some;
}

}  // namespace

const PeerData& peer_data() {
  static const PeerData data = make_data();
  return data;
}

PeerError error_of_forces(const Eigen::VectorXd& output_N) { return error_of(output_N); }

PeerError error_of_remainder(const Eigen::VectorXd& output_N) {
  const PeerData& data = peer_data();
  const double limit_N = data.remainder.common.correction_limit_N;
  const Eigen::VectorXd correction_N = output_N.cwiseMax(-limit_N).cwiseMin(limit_N);
  return error_of(data.test_trend_N + data.test_trust.cwiseProduct(correction_N));
}

Eigen::VectorXd output_N(const Function& function, const Eigen::MatrixXd& points) {
  Eigen::VectorXd output(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) output[i] = function(points.col(i).data());
  return output;
}

PreparedTraining with_some_sites(const PreparedTraining& prepared, Eigen::Index count) {
  PreparedTraining some = prepared;
  const Eigen::Index all = prepared.sites.count();
  if (count <= 0 || count >= all) return some;
  const auto wanted = [&](Eigen::Index i) { return (i + 1) * count / all != i * count / all; };
  some.sites = some_sites(prepared.sites, wanted);
  return some;
}

std::vector<bool> left_out_sites(const PreparedTraining& prepared) {
  const std::set<int> folds(prepared.sites.fold.begin(), prepared.sites.fold.end());
  const int every = std::min(kLeaveOut, static_cast<int>(folds.size()));
  std::vector<bool> left_out;
  for (const int fold : prepared.sites.fold) {
    const auto rank = static_cast<int>(std::distance(folds.begin(), folds.find(fold)));
    // The middle one of each five, so that the hardest of three presses is not left out.
    left_out.push_back(rank % every == every / 2);
  }
  return left_out;
}

const PeerSetting& best_setting(const Peer& peer, const PreparedTraining& prepared) {
  if (peer.settings.size() == 1) return peer.settings.front();
  const std::vector<bool> left_out = left_out_sites(prepared);
  PreparedTraining some;
  const auto is_left_out = [&](Eigen::Index i) { return left_out[static_cast<std::size_t>(i)]; };
  some.sites = some_sites(prepared.sites, [&](Eigen::Index i) { return !is_left_out(i); });
  const Sites judged = some_sites(prepared.sites, is_left_out);
  const PeerSetting* best = &peer.settings.front();
  double least = std::numeric_limits<double>::infinity();
  for (const PeerSetting& setting : peer.settings) {
    const Result<Function> fitted = setting.fit(some);
    if (!fitted) continue;
    const double error = (output_N(*fitted, judged.points) - judged.target_N).squaredNorm();
    if (error < least) {
      least = error;
      best = &setting;
    }
  }
  return *best;
}

}  // namespace palpate::bench
