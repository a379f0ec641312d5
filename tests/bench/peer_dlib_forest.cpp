// dlib's random forest: the mean of regression trees, each grown on a bootstrap sample of
// the sites. Forests were fitted to such recordings by Cha, Bhardwaj, Park & Choi
// (AsiaHaptics 2018).
#include <dlib/random_forest.h>

#include <cstdio>

#include "tests/bench/peer_dlib.h"

namespace palpate::bench {
namespace {

using Trainer = dlib::random_forest_regression_trainer<dlib::dense_feature_extractor>;

Result<Function> train(const Sites& sites, int trees, int leaf, double fraction) {
  const std::vector<double> targets(sites.target_N.begin(), sites.target_N.end());
  Trainer trainer;
  trainer.set_num_trees(static_cast<std::size_t>(trees));
  trainer.set_min_samples_per_leaf(static_cast<std::size_t>(leaf));
  trainer.set_feature_subsampling_fraction(fraction);
  trainer.set_seed("1");
  return dlib_function(trainer.train(dlib_samples(sites), targets), sites.dimension());
}

}  // namespace

std::vector<Peer> dlib_forest_peers() {
  Peer peer{"dlib_forest", {}};
  for (const int trees : {30, 100, 300}) {
    for (const int leaf : {1, 3, 10, 30}) {
      for (const double fraction : {1.0 / 3.0, 1.0}) {  // the first is its default
        char text[80];
        std::snprintf(text, sizeof text, "%d trees, leaves of %d or more, %.2g of the features a split", trees, leaf,
                      fraction);
        peer.settings.push_back(
            {text, [=](const PreparedTraining& prepared) { return train(prepared.sites, trees, leaf, fraction); }});
      }
    }
  }
  return {peer};
}

}  // namespace palpate::bench
