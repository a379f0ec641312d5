// The recordings for training and testing all peers, and the errors of their
// forces.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "models/fit/fit.h"
#include "scenes/evaluation/error_figures.h"
#include "tests/bench/peer.h"

namespace palpate::bench {

struct PeerData {
  std::string name;
  // Two fits to the same normalised features: `forces` has the measured forces as
  // targets, `remainder` the residuals of Palpate's trend.
  PreparedTraining forces;
  PreparedTraining remainder;
  // The samples in contact of the test recordings.
  Eigen::MatrixXd test_points;  // normalised
  Eigen::VectorXd test_force_N;
  Eigen::VectorXd test_trend_N;
  Eigen::VectorXd test_trust;
};

struct PeerError {
  double rms_N = 0.0;
  double within_jnd = 0.0;  // share
};

// Virtual materials, and "skin" and "press" if the real recordings are present.
// Each is made once.
std::vector<std::string> peer_data_names();
const PeerData& peer_data(const std::string& name);

// `output_N`: the function at each test point. The force is that, with the limits
// of every model of Palpate.
PeerError error_of_forces(const PeerData& data, const Eigen::VectorXd& output_N);
// The force is the trend plus trust times the output (fitted_model.h).
PeerError error_of_remainder(const PeerData& data, const Eigen::VectorXd& output_N);

Eigen::VectorXd output_N(const Function& function, const Eigen::MatrixXd& points);

// The setting of `peer` with the least RMS error on every fifth stroke when fitted
// to the others. If there is only one setting, nothing is fitted.
std::size_t best_setting(const Peer& peer, const PreparedTraining& prepared);

// `count` of the sites, evenly spread, for a library that cannot use all. 0, or more
// than the number of sites: all.
PreparedTraining with_some_sites(const PreparedTraining& prepared, Eigen::Index count);

// Whether each site belongs to a stroke that best_setting leaves out.
std::vector<bool> left_out_sites(const PreparedTraining& prepared);

}  // namespace palpate::bench
