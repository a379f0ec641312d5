// peer/silicone/NAME/fit and /query: Palpate's methods and other libraries, fitted to
// the same sites and tested on the same recording. A fit is timed once for both
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
  PeerResult result;
  Function function;  // for the forces
};

// Palpate's methods as peers: the correction function alone, without trend, trust and limits.
Result<Function> fit(const PreparedTraining& prepared, const Method* method) {
  const Eigen::VectorXd jnd_N = site_thresholds(prepared);
  Result<FittedCorrection> fitted = fit_correction(*method, {prepared.sites, jnd_N});
  if (!fitted) return fitted.error();
  return Function([correction = fitted->correction](const double* x) { return correction->evaluate(x); });
}

std::vector<Peer> palpate_peers() {
  std::vector<Peer> peers;
  const auto add = [&](const Method* method, const char* name, const char* text) {
    peers.push_back({name, {{text, [method](const PreparedTraining& prepared) { return fit(prepared, method); }}}});
  };
  add(&kRandomMethod, "palpate_random-100", "100 centres");
  add(&kKdTreeMethod, "palpate_kdtree-100", "100 centres");
  add(&kGreedyMethod, "palpate_greedy-100", "100 centres, 100 candidates a step");
  add(&kDirectMethod, "palpate_direct", "all sites are centres, smoothing chosen by leaving out strokes");
  add(&kVoxelMethod, "palpate_voxel", "25x11x11x11 grid (as `palpate fit` chooses it), filled from direct");
  // No function: 0 N, or the trend alone.
  const auto nothing = [](const PreparedTraining&) { return Function([](const double*) { return 0.0; }); };
  peers.push_back({"nothing", {{"0 N", nothing}}});
  return peers;
}

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

Result<Fitted> fit_both(const Peer& peer) {
  const PeerData& data = peer_data();
  Fitted fitted;
  const PreparedTraining forces = with_some_sites(data.forces, peer.most_sites);
  const PeerSetting& setting = best_setting(peer, forces);
  const Result<Function> function = timed_fit(setting, forces, fitted.result.fit_s);
  if (!function) return function.error();
  fitted.function = *function;
  fitted.result.setting = setting.text;
  fitted.result.forces = error_of_forces(output_N(*function, data.test_points));

  const PreparedTraining remainder = with_some_sites(data.remainder, peer.most_sites);
  const Result<Function> other = best_setting(peer, remainder).fit(remainder);
  if (!other) return other.error();
  fitted.result.remainder = error_of_remainder(output_N(*other, data.test_points));
  return fitted;
}

// Fits once for each peer; both rows use the result.
const Result<Fitted>& fitted_peer(const Peer& peer) {
  static std::map<std::string, Result<Fitted>> done;
  const auto found = done.find(peer.name);
  return found != done.end() ? found->second : done.emplace(peer.name, fit_both(peer)).first->second;
}

void report_result(benchmark::State& state, Eigen::Index most_sites, const PeerResult& result) {
  const Eigen::Index all = peer_data().forces.sites.count();
  for (auto _ : state) state.SetIterationTime(result.fit_s);
  state.counters["sites"] = static_cast<double>(most_sites > 0 ? std::min(most_sites, all) : all);
  state.counters["rms_mN"] = 1e3 * result.forces.rms_N;
  state.counters["within_jnd_pct"] = 100.0 * result.forces.within_jnd;
  state.counters["with_trend_rms_mN"] = 1e3 * result.remainder.rms_N;
  state.counters["with_trend_within_jnd_pct"] = 100.0 * result.remainder.within_jnd;
  state.SetLabel(result.setting);
}

void fit_row(benchmark::State& state, const Peer& peer) {
  const Result<Fitted>& fitted = fitted_peer(peer);
  if (!fitted) return state.SkipWithError(fitted.error().message.c_str());
  report_result(state, peer.most_sites, fitted->result);
}

void query_row(benchmark::State& state, const Peer& peer) {
  const Result<Fitted>& fitted = fitted_peer(peer);
  if (!fitted) return state.SkipWithError(fitted.error().message.c_str());
  run_queries(state, peer_data().test_points, fitted->function);
}

void register_peer(const Peer& peer) {
  const std::string name = "peer/silicone/" + peer.name;
  benchmark::RegisterBenchmark((name + "/fit").c_str(), fit_row, peer)
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark((name + "/query").c_str(), query_row, peer)
      ->Repetitions(kQueryRepetitions)
      ->MinTime(kQuerySeconds)
      ->ReportAggregatesOnly();
}

#ifdef PALPATE_PYTHON
// The times are those measured by the script.
void scipy_row(benchmark::State& state, const std::string& name, bool query) {
  const auto& peers = scipy_peers();
  if (!peers) return state.SkipWithError(peers.error().message.c_str());
  const ScipyPeer& peer = peers->at(name);
  if (!query) return report_result(state, 0, peer.result);
  for (auto _ : state) state.SetIterationTime(peer.query_s);
}

void register_scipy() {
  for (const std::string peer : kScipyPeers)
    for (const bool query : {false, true})
      benchmark::RegisterBenchmark(("peer/silicone/" + peer + (query ? "/query" : "/fit")).c_str(), scipy_row, peer,
                                   query)
          ->Iterations(1)
          ->UseManualTime()
          ->Unit(query ? benchmark::kMicrosecond : benchmark::kMillisecond);
}
#endif

const int registered = [] {
  for (const Peer& peer : palpate_peers()) register_peer(peer);
#ifdef PALPATE_WITH_ALGLIB
  for (const Peer& peer : alglib_peers()) register_peer(peer);
#endif
#ifdef PALPATE_WITH_DLIB
  for (const Peer& peer : dlib_peers()) register_peer(peer);
#endif
#ifdef PALPATE_PYTHON
  register_scipy();
#endif
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
