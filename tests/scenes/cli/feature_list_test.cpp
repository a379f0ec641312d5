#include "scenes/cli/feature_list.h"

#include <gtest/gtest.h>

namespace palpate::cli {
namespace {

TEST(FeatureListText, ReadsItsOwnExample) {
  const auto list = parse_feature_list(kFeatureListExample);
  ASSERT_TRUE(list.ok()) << list.error().message;
  EXPECT_TRUE(list->velocity);
  EXPECT_EQ(list->relaxation_times_s, (std::vector<std::vector<double>>{{0.17}, {0.4, 1.27}}));
  ASSERT_EQ(list->stop_thresholds_m.size(), 1U);
  EXPECT_DOUBLE_EQ(list->stop_thresholds_m[0], 1e-4);
  EXPECT_EQ(list->creep_times_s, (std::vector<double>{0.1, 1.0}));
}

TEST(FeatureListText, DepthAloneIsEnough) {
  const auto list = parse_feature_list("depth");
  ASSERT_TRUE(list.ok());
  EXPECT_FALSE(list->velocity);
  EXPECT_TRUE(list->relaxation_times_s.empty());
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

}  // namespace
}  // namespace palpate::cli
