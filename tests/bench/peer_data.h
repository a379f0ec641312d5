// The recordings of virtual silicone for training and testing all peers, and the errors of
// their forces.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/fit/fit.h"
#include "tests/bench/peer.h"

namespace palpate::bench {

struct PeerData {
  // Two fits to the same normalised features: `forces` has the measured forces as
  // targets, `remainder` the residuals of Palpate's trend.
  PreparedTraining forces;
  PreparedTraining remainder;
  // The samples in contact of the test recording.
  Eigen::MatrixXd test_points;  // normalised
  Eigen::VectorXd test_force_N;
  Eigen::VectorXd test_trend_N;
  Eigen::VectorXd test_trust;
};

struct PeerError {
  double rms_N = 0.0;
  double within_jnd = 0.0;  // share
};

// What the table shows of a peer.
struct PeerResult {
  std::string setting;  // for the forces
  double fit_s = 0.0;   // to the forces, median
  PeerError forces;
  PeerError remainder;
};

// Made once.
const PeerData& peer_data();

// `output_N`: the function at each test point. The force is that, with the limits
// of every model of Palpate.
PeerError error_of_forces(const Eigen::VectorXd& output_N);
// The force is the trend plus trust times the output (fitted_model.h).
PeerError error_of_remainder(const Eigen::VectorXd& output_N);

Eigen::VectorXd output_N(const Function& function, const Eigen::MatrixXd& points);

// The setting of `peer` with the least RMS error on every fifth stroke when fitted
// to the others. If there is only one setting, nothing is fitted.
const PeerSetting& best_setting(const Peer& peer, const PreparedTraining& prepared);

// `count` of the sites, evenly spread, for a library that cannot use all. 0, or more
// than the number of sites: all.
PreparedTraining with_some_sites(const PreparedTraining& prepared, Eigen::Index count);

// Whether each site belongs to a fold that best_setting leaves out.
std::vector<bool> left_out_sites(const PreparedTraining& prepared);

}  // namespace palpate::bench
