#include "tests/bench/peer_scipy.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace palpate::bench {
namespace {

constexpr const char* kRepetitions = "3";

void write_rows(const std::filesystem::path& path, const Eigen::MatrixXd& columns) {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    for (Eigen::Index k = 0; k < columns.rows(); ++k) file << (k > 0 ? "," : "") << columns(k, i);
    file << '\n';
  }
}

void write_data(const std::filesystem::path& folder) {
  const PeerData& data = peer_data();
  const Sites& sites = data.forces.sites;
  const std::vector<bool> left_out = left_out_sites(data.forces);
  Eigen::MatrixXd train(sites.dimension() + 3, sites.count());
  train.topRows(sites.dimension()) = sites.points;
  train.row(sites.dimension()) = sites.target_N.transpose();
  train.row(sites.dimension() + 1) = data.remainder.sites.target_N.transpose();
  for (Eigen::Index i = 0; i < sites.count(); ++i)
    train(sites.dimension() + 2, i) = left_out[static_cast<std::size_t>(i)];
  write_rows(folder / "train.csv", train);
  write_rows(folder / "test.csv", data.test_points);
}

Result<std::string> run_script(const std::filesystem::path& folder) {
  const std::string command =
      std::string("'" PALPATE_PYTHON "' '" PALPATE_SCIPY_SCRIPT "' '") + folder.string() + "' " + kRepetitions;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return Error{"cannot start " + command};
  std::string output;
  char part[4096];
  for (std::size_t got; (got = std::fread(part, 1, sizeof part, pipe)) > 0;) output.append(part, got);
  if (pclose(pipe) != 0) return Error{"failed: " + command};
  return output;
}

Result<Eigen::VectorXd> read_output(const std::filesystem::path& path, Eigen::Index count) {
  std::ifstream file(path);
  Eigen::VectorXd output(count);
  for (Eigen::Index i = 0; i < count; ++i)
    if (!(file >> output[i])) return Error{path.string() + ": fewer than " + std::to_string(count) + " numbers"};
  return output;
}

Result<std::map<std::string, ScipyPeer>> run() {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  write_data(folder);
  const Result<std::string> said = run_script(folder);
  if (!said) return said.error();
  std::map<std::string, ScipyPeer> peers;
  for (const nlohmann::json& row : nlohmann::json::parse(*said)) {
    const auto name = row.at("name").get<std::string>();
    const auto target = row.at("target").get<std::string>();
    const auto output = read_output(folder / (name + "_" + target + ".csv"), peer_data().test_force_N.size());
    if (!output) return output.error();
    ScipyPeer& peer = peers[name];
    if (target == "remainder") {
      peer.result.remainder = error_of_remainder(*output);
      continue;
    }
    peer.result.forces = error_of_forces(*output);
    peer.result.setting = row.at("setting").get<std::string>();
    peer.result.fit_s = row.at("fit_s").get<double>();
    peer.query_s = row.at("query_s").get<double>();
  }
  return peers;
}

}  // namespace

const Result<std::map<std::string, ScipyPeer>>& scipy_peers() {
  static const Result<std::map<std::string, ScipyPeer>> done = run();
  return done;
}

}  // namespace palpate::bench
