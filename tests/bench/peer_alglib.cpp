// ALGLIB's radial basis functions, as its manual recommends for many dimensions:
// DDM-RBF (every point a centre, a domain decomposition solver) and hierarchical
// RBF (compact kernels of ever smaller radius).
#include <interpolation.h>

#include <memory>
#include <string>

#include "engine/base/text.h"
#include "tests/bench/peer.h"

namespace palpate::bench {
namespace {

// A fit with 6,830 sites in 4-D did not finish within 200 s.
constexpr Eigen::Index kMostDdmSites = 1000;

struct AlglibModel {
  alglib::rbfmodel model;
  alglib::rbfcalcbuffer buffer;
  alglib::real_1d_array x;
  alglib::real_1d_array y;
};

using Choice = std::function<void(alglib::rbfmodel& model)>;

Result<Function> build(const Sites& sites, const Choice& choose) {
  const alglib::ae_int_t d = sites.dimension();
  const alglib::ae_int_t n = sites.count();
  const auto built = std::make_shared<AlglibModel>();
  try {
    alglib::real_2d_array xy;
    xy.setlength(n, d + 1);
    for (alglib::ae_int_t i = 0; i < n; ++i) {
      for (alglib::ae_int_t k = 0; k < d; ++k) xy[i][k] = sites.points(k, i);
      xy[i][d] = sites.target_N[i];
    }
    alglib::rbfcreate(d, 1, built->model);
    alglib::rbfsetpoints(built->model, xy);
    choose(built->model);
    alglib::rbfreport report;
    alglib::rbfbuildmodel(built->model, report);
    if (report.terminationtype != 1) return Error{"ALGLIB ended with " + std::to_string(report.terminationtype)};
    alglib::rbfcreatecalcbuffer(built->model, built->buffer);
    built->x.setlength(d);
    built->y.setlength(1);
  } catch (const alglib::ap_error& error) {
    return Error{"ALGLIB: " + error.msg};
  }
  return Function([built, d](const double* x) {
    for (alglib::ae_int_t k = 0; k < d; ++k) built->x[k] = x[k];
    alglib::rbftscalcbuf(built->model, built->buffer, built->x, built->y);
    return built->y[0];
  });
}

PeerSetting setting(const std::string& text, const Choice& choose) {
  return {text, [choose](const PreparedTraining& prepared) { return build(prepared.sites, choose); }};
}

}  // namespace

std::vector<Peer> alglib_peers() {
  Peer polyharmonic{"alglib_ddm", {}, kMostDdmSites};
  for (const double lambda : {1e-6, 1e-3}) {
    polyharmonic.settings.push_back(
        setting("thin plate spline, lambda " + general(lambda, 6),
                [lambda](alglib::rbfmodel& model) { alglib::rbfsetalgothinplatespline(model, lambda); }));
  }
  Peer hierarchical{"alglib_hierarchical", {}};
  // The manual recommends a radius of several point distances. Of 0.06, 0.12, 0.25
  // and 0.5 (where a fit takes a minute), the last had the smallest error on the
  // test recording of silicone.
  hierarchical.settings.push_back(setting("base radius 0.5, 5 layers, no smoothing", [](alglib::rbfmodel& model) {
    alglib::rbfsetalgohierarchical(model, 0.5, 5, 0.0);
  }));
  return {polyharmonic, hierarchical};
}

}  // namespace palpate::bench
