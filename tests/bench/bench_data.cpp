#include "tests/bench/bench.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>

#include "tests/support/fitting.h"
#include "tests/support/random_points.h"

namespace palpate::bench {
namespace {

// The value of a line "name: 123 kB" in the status of this process.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(name, 0) == 0) return 1024.0 * std::stod(line.substr(name.size()));
  return 0.0;
}

}  // namespace

const PreparedTraining& recorded() {
  static const PreparedTraining prepared = [] {
    RigSettings settings;
    settings.seconds = 60.0;
    return test::prepare({test::rig_recording(settings)}, test::scene_request("silicone_block"));
  }();
  return prepared;
}

const Sites& recorded_sites() {
  static const Sites sites = even_subset(recorded().sites, kPaperSites);
  return sites;
}

const Eigen::VectorXd& recorded_jnd_N() {
  static const Eigen::VectorXd jnd_N = recorded_sites().row_scale.cwiseInverse();
  return jnd_N;
}

RbfFunction recorded_function(Eigen::Index centres) {
  const Sites& sites = recorded_sites();
  RbfFunction function = test::random_function(KernelKind::cubic, sites.dimension(), static_cast<int>(centres), 1);
  for (Eigen::Index j = 0; j < centres; ++j) function.centres.col(j) = sites.points.col(j * sites.count() / centres);
  return function;
}

Sites made_sites(int dimension, Eigen::Index count) {
  return test::smooth_sites(dimension, static_cast<int>(count), 0.005, 1);
}

VoxelGrid even_grid(const Sites& sites, const std::vector<int>& sizes) {
  VoxelGrid grid;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const auto row = sites.points.row(static_cast<Eigen::Index>(k));
    const double low = row.minCoeff();
    const double step = (row.maxCoeff() - low) / (sizes[k] - 1);
    std::vector<double> nodes;
    for (int i = 0; i < sizes[k]; ++i) nodes.push_back(low + i * step);
    grid.nodes.push_back(std::move(nodes));
  }
  return grid;
}

double peak_memory_of(const std::function<void()>& work) {
  malloc_trim(0);  // free memory left in the heap would hide new use
  const double before = status_bytes("VmRSS:");
  std::ofstream("/proc/self/clear_refs") << "5";  // Linux: resets the peak
  work();
  return std::max(0.0, status_bytes("VmHWM:") - before);
}

}  // namespace palpate::bench
