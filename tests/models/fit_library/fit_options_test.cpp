#include "models/fit_library/fit_options.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(FeatureListText, ReadsItsOwnExample) {
  const auto list = parse_feature_list(kFeatureListExample);
  ASSERT_TRUE(list.ok()) << list.error().message;
  std::vector<FeatureKind> kinds;
  for (const FeatureSpec& spec : list->features) kinds.push_back(spec.kind);
  EXPECT_EQ(kinds, (std::vector{FeatureKind::depth, FeatureKind::velocity, FeatureKind::maxwell_spectrum,
                                FeatureKind::maxwell_spectrum, FeatureKind::stops, FeatureKind::creep}));
  EXPECT_EQ(constants_of(list->features[2]), std::vector{0.17});
  EXPECT_EQ(constants_of(list->features[3]), (std::vector{0.4, 1.27}));
  ASSERT_EQ(list->features[4].part_count, 1U);
  EXPECT_DOUBLE_EQ(list->features[4].parts[0].threshold_m, 1e-4);
  EXPECT_EQ(constants_of(list->features[5]), (std::vector{0.1, 1.0}));
}

TEST(FeatureListText, SaysWhatIsWrong) {
  for (const char* text : {"", "depth,", "speed", "velocity,velocity", "maxwell", "maxwell:", "maxwell:-1",
                           "maxwell:0.1+", "stops:0.1", "stops:0mm", "creep:", "creep:nan", "maxwell:1e999"}) {
    const auto list = parse_feature_list(text);
    ASSERT_FALSE(list.ok()) << text;
    EXPECT_NE(list.error().message.find("found \""), std::string::npos) << text;
    EXPECT_NE(list.error().message.find("expected "), std::string::npos) << text;
  }
  EXPECT_FALSE(parse_feature_list("velocity,maxwell:1,maxwell:2,maxwell:3,maxwell:4,maxwell:5,maxwell:6,creep:1").ok())
      << "nine features";
}

TEST(FitOptionsText, TheDefaultsAreGoodAndEachWrongOneIsNamed) {
  EXPECT_TRUE(check_fit_options({}).ok());
  const auto wrong = [](auto FitOptions::*option, auto value) {
    FitOptions options;
    options.features = "depth";  // a list excludes relaxation times
    options.*option = value;
    return check_fit_options(options).error().message;
  };
  EXPECT_EQ(wrong(&FitOptions::method, "nothing").rfind("method: found \"nothing\"", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::centres, kMostFittedCentres + 1).rfind("centres: found 2001", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::candidates, "0").rfind("candidates: ", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::kernel, "gauss").rfind("kernel: ", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::grid, "1x2").rfind("grid: ", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::recipe, "2009").rfind("recipe: ", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::surface, "deep").rfind("surface: ", 0), 0U);
  EXPECT_EQ(wrong(&FitOptions::relaxation, "0.1").rfind("relaxation: ", 0), 0U);
}

TEST(FitOptionsText, TheRecipeIsItsTwoOptions) {
  FitOptions options;
  options.recipe = kRecipe2009;
  const TrainingRequest request = training_request(options, {});
  EXPECT_EQ(request.reduction, Reduction::force);
  EXPECT_EQ(request.weighting, Weighting::relative);
  EXPECT_EQ(request.choice, FeatureChoice::scene);
}

TEST(FitOptionsText, ReadsTheFeaturesOfAScene) {
  const auto features = parse_scene_features("depth,velocity,lowpass_velocity:0.17");
  ASSERT_TRUE(features.ok()) << features.error().message;
  ASSERT_EQ(features->size(), 3U);
  EXPECT_EQ((*features)[2].kind, FeatureKind::lowpass_velocity);
  EXPECT_EQ((*features)[2].relaxation_time_s, 0.17);
  for (const char* text : {"", "velocity", "depth,speed", "depth,lowpass_velocity:", "depth,lowpass_velocity:1+2"})
    EXPECT_FALSE(parse_scene_features(text).ok()) << text;
}

}  // namespace
}  // namespace palpate
