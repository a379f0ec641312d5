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

TEST(FitOptionsText, ReadsPairsAndNamesEachWrongOne) {
  const auto options = parse_fit_options(" method=random  centres=40 features=depth,velocity seed=7 ");
  ASSERT_TRUE(options.ok()) << options.error().message;
  EXPECT_EQ(options->method, "random");
  EXPECT_EQ(method_request(*options).centres, 40);
  EXPECT_EQ(method_request(*options).seed, 7U);
  EXPECT_EQ(options->features, "depth,velocity");
  EXPECT_EQ(options->kernel, "cubic");
  for (const auto& [text, beginning] : {std::pair{"method=nothing", "method: found \"nothing\""},
                                        {"centres=2001", "centres: found \"2001\""},
                                        {"candidates=0", "candidates: "},
                                        {"kernel=gauss", "kernel: "},
                                        {"grid=1x2", "grid: "},
                                        {"recipe=2009", "recipe: "},
                                        {"surface=deep", "surface: "},
                                        {"seed=-1", "seed: "},
                                        {"relaxation=", "relaxation: "},
                                        {"features=depth relaxation=0.1", "relaxation: "},
                                        {"speed=1", "found \"speed=1\", expected NAME=VALUE"},
                                        {"method", "found \"method\", expected NAME=VALUE"}}) {
    const auto wrong = parse_fit_options(text);
    ASSERT_FALSE(wrong.ok()) << text;
    EXPECT_EQ(wrong.error().message.rfind(beginning, 0), 0U) << wrong.error().message;
  }
}

TEST(FitOptionsText, TheRecipeIsItsTwoOptions) {
  FitOptions options;
  options.recipe = kRecipe2009;
  const TrainingRequest request = training_request(options, {});
  EXPECT_EQ(request.reduction, Reduction::force);
  EXPECT_EQ(request.weighting, Weighting::relative);
  EXPECT_EQ(request.choice, FeatureChoice::scene);
}

}  // namespace
}  // namespace palpate
