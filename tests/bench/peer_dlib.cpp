// dlib's kernel ridge regression with a Gaussian kernel. dlib selects its basis, a
// linearly independent subset of the samples, and its ridge by leave-one-out
// cross-validation. The kernel width is chosen here.
#include <dlib/svm/krr_trainer.h>

#include <cmath>
#include <cstdio>

#include "tests/bench/peer_dlib.h"

namespace palpate::bench {
namespace {

using Kernel = dlib::radial_basis_kernel<DlibSample>;

Result<Function> train(const Sites& sites, double gamma, unsigned long basis_size) {
  const std::vector<double> targets(sites.target_N.begin(), sites.target_N.end());
  dlib::krr_trainer<Kernel> trainer;
  trainer.set_kernel(Kernel(gamma));
  trainer.set_max_basis_size(basis_size);
  return dlib_function(trainer.train(dlib_samples(sites), targets), sites.dimension());
}

}  // namespace

std::vector<Peer> dlib_peers() {
  std::vector<Peer> peers;
  for (const unsigned long basis_size : {100UL, 400UL}) {  // 400: its default
    Peer peer{"dlib_krr-" + std::to_string(basis_size), {}};
    for (const double gamma : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0}) {
      char text[64];
      std::snprintf(text, sizeof text, "basis %lu, gamma %g, lambda by its leave-one-out", basis_size, gamma);
      peer.settings.push_back(
          {text, [=](const PreparedTraining& prepared) { return train(prepared.sites, gamma, basis_size); }});
    }
    peers.push_back(std::move(peer));
  }
  return peers;
}

}  // namespace palpate::bench
