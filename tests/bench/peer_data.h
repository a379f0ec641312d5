// The recordings that all peers train on and are tested on, and what their
// forces are worth there.
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
  // Two fits see the same normalised features: `forces` asks for the measured
  // forces themselves, `remainder` for what Palpate's trend leaves of them.
  PreparedTraining forces;
  PreparedTraining remainder;
  // In contact, in the recordings not trained on.
  Eigen::MatrixXd test_points;  // normalised
  Eigen::VectorXd test_force_N;
  Eigen::VectorXd test_trend_N;
  Eigen::VectorXd test_trust;
};

struct PeerError {
  double rms_N = 0.0;
  double within_jnd = 0.0;  // share
};

// Virtual materials, always there; "skin" and "press" where the real recordings are.
// Made once each.
std::vector<std::string> peer_data_names();
const PeerData& peer_data(const std::string& name);

// `output_N`: what the function says at each test point. The force is that,
// bounded to what every model of Palpate is bounded to.
PeerError error_of_forces(const PeerData& data, const Eigen::VectorXd& output_N);
// The force is the trend and, as far as data are near, the output (fitted_model.h).
PeerError error_of_remainder(const PeerData& data, const Eigen::VectorXd& output_N);

Eigen::VectorXd output_N(const Function& function, const Eigen::MatrixXd& points);

// The setting of `peer` with the least RMS error on every fifth stroke when
// fitted to the others. Without a choice nothing is fitted.
std::size_t best_setting(const Peer& peer, const PreparedTraining& prepared);

// `count` of the sites, evenly spread, for a library that cannot take all; 0 or
// more than there are: all. (Of `set.sites` all are kept.)
PreparedTraining with_some_sites(const PreparedTraining& prepared, Eigen::Index count);

// Whether each site belongs to a stroke that best_setting leaves out.
std::vector<bool> left_out_sites(const PreparedTraining& prepared);

}  // namespace palpate::bench
