// dlib's kernel ridge regression with a Gaussian kernel, and its random forest.
//
// Ridge regression: dlib selects its basis, a linearly independent subset of the samples, and
// its ridge by leave-one-out cross-validation. The kernel width is chosen here.
// Forest: the mean of regression trees, each grown on a bootstrap sample of the sites. Forests
// were fitted to such recordings by Cha, Bhardwaj, Park & Choi (AsiaHaptics 2018).
#include <dlib/random_forest.h>
#include <dlib/svm/krr_trainer.h>

#include <cstdio>
#include <utility>

#include "tests/bench/peer.h"

namespace palpate::bench {
namespace {

using Sample = dlib::matrix<double, 0, 1>;

// The function of a feature vector that the trainer finds for these sites.
template <typename Trainer>
Result<Function> train(const Trainer& trainer, const Sites& sites) {
  const long d = sites.dimension();
  std::vector<Sample> samples;
  for (Eigen::Index i = 0; i < sites.count(); ++i) {
    Sample sample(d);
    for (long k = 0; k < d; ++k) sample(k) = sites.points(k, i);
    samples.push_back(std::move(sample));
  }
  const std::vector<double> targets(sites.target_N.begin(), sites.target_N.end());
  return Function([trained = trainer.train(samples, targets), query = Sample(d)](const double* x) mutable {
    for (long k = 0; k < query.size(); ++k) query(k) = x[k];
    return trained(query);
  });
}

Result<Function> train_ridge(const Sites& sites, double gamma, unsigned long basis_size) {
  using Kernel = dlib::radial_basis_kernel<Sample>;
  dlib::krr_trainer<Kernel> trainer;
  trainer.set_kernel(Kernel(gamma));
  trainer.set_max_basis_size(basis_size);
  return train(trainer, sites);
}

Peer ridge(unsigned long basis_size) {
  Peer peer{"dlib_krr-" + std::to_string(basis_size), {}};
  for (const double gamma : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0}) {
    char text[64];
    std::snprintf(text, sizeof text, "basis %lu, gamma %g, lambda by its leave-one-out", basis_size, gamma);
    peer.settings.push_back(
        {text, [=](const PreparedTraining& prepared) { return train_ridge(prepared.sites, gamma, basis_size); }});
  }
  return peer;
}

Result<Function> train_forest(const Sites& sites, int trees, int leaf, double fraction) {
  dlib::random_forest_regression_trainer<dlib::dense_feature_extractor> trainer;
  trainer.set_num_trees(static_cast<std::size_t>(trees));
  trainer.set_min_samples_per_leaf(static_cast<std::size_t>(leaf));
  trainer.set_feature_subsampling_fraction(fraction);
  trainer.set_seed("1");
  return train(trainer, sites);
}

Peer forest() {
  Peer peer{"dlib_forest", {}};
  for (const int trees : {30, 100, 300}) {
    for (const int leaf : {1, 3, 10, 30}) {
      for (const double fraction : {1.0 / 3.0, 1.0}) {  // the first is its default
        char text[80];
        std::snprintf(text, sizeof text, "%d trees, leaves of %d or more, %.2g of the features a split", trees, leaf,
                      fraction);
        peer.settings.push_back({text, [=](const PreparedTraining& prepared) {
                                   return train_forest(prepared.sites, trees, leaf, fraction);
                                 }});
      }
    }
  }
  return peer;
}

}  // namespace

std::vector<Peer> dlib_peers() { return {ridge(100), ridge(400), forest()}; }  // 400: its default

}  // namespace palpate::bench
