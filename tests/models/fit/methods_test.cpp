#include "models/fit/methods.h"

#include <gtest/gtest.h>

#include <set>

namespace palpate {
namespace {

TEST(Methods, AreFoundByTheirNames) {
  for (const Method* method : methods()) EXPECT_EQ(find_method(method->name), method);
  EXPECT_EQ(find_method("position"), nullptr);
  EXPECT_EQ(find_method(""), nullptr);
}

TEST(Methods, EveryRowIsWhole) {
  std::set<std::string> names;
  std::set<std::uint32_t> colours;
  for (const Method* method : methods()) {
    EXPECT_TRUE(names.insert(method->name).second) << method->name;
    EXPECT_TRUE(colours.insert(method->colour).second) << method->name;
    EXPECT_NE(std::string(method->label), "");
    ASSERT_NE(method->expected_seconds, nullptr);
    EXPECT_GT(method->expected_seconds({}), 0.0);
    EXPECT_NE(method->fit, nullptr);
    if (method->base == nullptr) continue;
    EXPECT_EQ(find_method(method->base->name), method->base);
  }
}

TEST(Methods, ABaseTakesItsTimeToo) {
  MethodRequest request;
  request.method = &kVoxelMethod;
  EXPECT_EQ(expected_seconds(request),
            kVoxelMethod.expected_seconds(request) + kDirectMethod.expected_seconds(request));
}

TEST(Methods, AreListedByWhatTheyTake) {
  EXPECT_EQ(methods_that_take(kTakesGrid), "voxel");
  EXPECT_EQ(methods_that_take(kTakesCandidates), "greedy");
  EXPECT_EQ(methods_that_take(kTakesCentres), "random, kdtree, greedy");
}

}  // namespace
}  // namespace palpate
