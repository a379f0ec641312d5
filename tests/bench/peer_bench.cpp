// peer/DATA/NAME/fit and /query: Palpate's methods and other libraries, fitted to
// the same sites and tested on the same recordings. A fit is timed once for both
// rows; their loops only report that time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/bench_queries.h"
#include "tests/bench/peer_data.h"
#ifdef PALPATE_PYTHON
#include "tests/bench/peer_scipy.h"
#endif

namespace palpate::bench {
namespace {

constexpr int kFitRepetitions = 3;
constexpr double kFitSeconds = 5.0;  // no more repetitions after this time
constexpr int kQueryRepetitions = 7;
constexpr double kQuerySeconds = 0.05;

struct Fitted {
  std::string setting;  // for the forces, like all members except the last
  double fit_s = 0.0;   // median
  Function function;
  PeerError forces;
  PeerError remainder;
};

// Fits up to kFitRepetitions times and returns the median time.
Result<Function> timed_fit(const PeerSetting& setting, const PreparedTraining& training, double& median_s) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times_s;
  double spent_s = 0.0;
  for (;;) {
    const auto start = Clock::now();
    Result<Function> function = setting.fit(training);
    times_s.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    spent_s += times_s.back();
    if (function && times_s.size() < kFitRepetitions && spent_s < kFitSeconds) continue;
    std::sort(times_s.begin(), times_s.end());
    median_s = times_s[times_s.size() / 2];
    return function;
  }
}

Result<Fitted> fit_both(const Peer& peer, const PeerData& data) {
  Fitted fitted;
  const PreparedTraining forces = with_some_sites(data.forces, peer.most_sites);
  const PeerSetting& setting = peer.settings[best_setting(peer, forces)];
  const Result<Function> function = timed_fit(setting, forces, fitted.fit_s);
  if (!function) return function.error();
  fitted.setting = setting.text;
  fitted.function = *function;
  fitted.forces = error_of_forces(data, output_N(*function, data.test_points));

  const PreparedTraining remainder = with_some_sites(data.remainder, peer.most_sites);
  const Result<Function> other = peer.settings[best_setting(peer, remainder)].fit(remainder);
  if (!other) return other.error();
  fitted.remainder = error_of_remainder(data, output_N(*other, data.test_points));
  return fitted;
}

// Fits once for each peer and data; both rows use the result.
const Result<Fitted>& fitted_peer(const Peer& peer, const PeerData& data) {
  static std::map<std::string, Result<Fitted>> done;
  const std::string key = data.name + "/" + peer.name;
  const auto found = done.find(key);
  return found != done.end() ? found->second : done.emplace(key, fit_both(peer, data)).first->second;
}

void report_errors(benchmark::State& state, const PeerData& data, Eigen::Index sites, const PeerError& forces,
                   const PeerError& remainder, const std::string& setting) {
  state.counters["sites"] = static_cast<double>(sites);
  state.counters["test_samples"] = static_cast<double>(data.test_force_N.size());
  state.counters["rms_mN"] = 1e3 * forces.rms_N;
  state.counters["within_jnd_pct"] = 100.0 * forces.within_jnd;
  state.counters["with_trend_rms_mN"] = 1e3 * remainder.rms_N;
  state.counters["with_trend_within_jnd_pct"] = 100.0 * remainder.within_jnd;
  state.SetLabel(setting);
}

void fit_row(benchmark::State& state, const std::string& data_name, const Peer& peer) {
  const PeerData& data = peer_data(data_name);
  const Result<Fitted>& fitted = fitted_peer(peer, data);
  if (!fitted) return state.SkipWithError(fitted.error().message.c_str());
  for (auto _ : state) state.SetIterationTime(fitted->fit_s);
  const Eigen::Index all = data.forces.sites.count();
  report_errors(state, data, peer.most_sites > 0 ? std::min(peer.most_sites, all) : all, fitted->forces,
                fitted->remainder, fitted->setting);
}

void query_row(benchmark::State& state, const std::string& data_name, const Peer& peer) {
  const PeerData& data = peer_data(data_name);
  const Result<Fitted>& fitted = fitted_peer(peer, data);
  if (!fitted) return state.SkipWithError(fitted.error().message.c_str());
  run_queries(state, data.test_points, fitted->function);
}

void register_peer(const std::string& data, const Peer& peer) {
  const std::string name = "peer/" + data + "/" + peer.name;
  benchmark::RegisterBenchmark((name + "/fit").c_str(), fit_row, data, peer)
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark((name + "/query").c_str(), query_row, data, peer)
      ->Repetitions(kQueryRepetitions)
      ->MinTime(kQuerySeconds)
      ->ReportAggregatesOnly();
}

#ifdef PALPATE_PYTHON
// The times are those measured by the script.
void scipy_row(benchmark::State& state, const std::string& data_name, const std::string& peer_name, bool query) {
  const PeerData& data = peer_data(data_name);
  const auto& peers = scipy_peers(data);
  if (!peers) return state.SkipWithError(peers.error().message.c_str());
  const ScipyPeer& peer = peers->at(peer_name);
  for (auto _ : state) state.SetIterationTime(query ? peer.query_s : peer.fit_s);
  if (!query) report_errors(state, data, data.forces.sites.count(), peer.forces, peer.remainder, peer.setting);
}

void register_scipy(const std::string& data) {
  for (const std::string peer : kScipyPeers)
    for (const bool query : {false, true})
      benchmark::RegisterBenchmark(("peer/" + data + "/" + peer + (query ? "/query" : "/fit")).c_str(), scipy_row, data,
                                   peer, query)
          ->Iterations(1)
          ->UseManualTime()
          ->Unit(query ? benchmark::kMicrosecond : benchmark::kMillisecond);
}
#endif

const int registered = [] {
  std::vector<Peer> peers = palpate_peers();
  peers.push_back(nothing_peer());
  [[maybe_unused]] const auto add = [&](const std::vector<Peer>& more) {
    peers.insert(peers.end(), more.begin(), more.end());
  };
#ifdef PALPATE_WITH_ALGLIB
  add(alglib_peers());
#endif
#ifdef PALPATE_WITH_DLIB
  add(dlib_peers());
  add(dlib_forest_peers());
#endif
  for (const std::string& data : peer_data_names()) {
    for (const Peer& peer : peers) register_peer(data, peer);
#ifdef PALPATE_PYTHON
    register_scipy(data);
#endif
  }
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
