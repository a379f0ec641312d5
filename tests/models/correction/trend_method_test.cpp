// The smallest model: the trend alone, in fit, file and evaluation.
#include <gtest/gtest.h>

#include "models/fit/fit.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

Result<MethodFit> fit_trend_alone(Thinning thinning) {
  auto samples = make_samples({prepare_recording(test::example_recording(1500, 250.0))}, JndLine{});
  if (!samples) return samples.error();
  const ModelPlan plan{.method = &kTrendMethod, .thinning = thinning, .features = FeatureChoice::scene};
  const auto prepared = prepare_training(std::make_shared<const Samples>(std::move(*samples)),
                                         {"test", test::paper_features(), {}}, plan);
  if (!prepared) return prepared.error();
  return fit_method(*prepared, plan);
}

TEST(TrendMethod, IsTheTrendEverywhereAndHasNoCentres) {
  for (const Thinning thinning : {Thinning::coverage, Thinning::force}) {
    const auto fit = fit_trend_alone(thinning);
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    const ModelData& data = fit->data;
    EXPECT_EQ(data.name, "trend");
    EXPECT_EQ(data.method, "trend");
    EXPECT_EQ(data.correction, nullptr);
    const FittedModel model(data);
    EXPECT_EQ(model.centre_count(), 0);
    for (double depth_m = 0.0; depth_m < 0.01; depth_m += 1e-4) {
      const std::array<double, kMaxFeatures> x{depth_m, 0.01};
      const double trend_N = data.trend.at(x.data(), data.features);
      EXPECT_EQ(model.evaluate(x.data()).force_N, std::clamp(trend_N, 0.0, kForceMargin * data.largest_force_N));
    }
  }
}

TEST(TrendMethod, ComesBackFromItsFile) {
  const auto fit = fit_trend_alone(Thinning::coverage);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  const auto text = write_model_text(fit->data);
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("\"trend_alone\": true"), std::string::npos);
  const auto back = read_model_text(*text, "m.json");
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->correction, nullptr);
  EXPECT_EQ(*write_model_text(*back), *text);
}

// The fit, not the command line, fills in the provenance, so that live fits have it too.
TEST(TrendMethod, ProvenanceSaysHowTheDataWerePrepared) {
  const auto fit = fit_trend_alone(Thinning::force);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_EQ(fit->data.provenance.weighting, "jnd");
  EXPECT_EQ(fit->data.provenance.thinning, "force");
  EXPECT_EQ(fit->data.provenance.relaxation, "scene");
}

}  // namespace
}  // namespace palpate
