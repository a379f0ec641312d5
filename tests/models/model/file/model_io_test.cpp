// Model files: writing and reading lose nothing.
#include "models/model/file/model_io.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::example_model;
using test::example_models;

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

std::string text_of(const ModelData& data) {
  const Result<std::string> text = write_model_text(data);
  EXPECT_TRUE(text.ok()) << (text ? "" : text.error().message);
  return text ? *text : "";
}

ModelData read_back(const ModelData& data) {
  Result<ModelData> back = read_model_text(text_of(data), "m.json");
  EXPECT_TRUE(back.ok()) << (back ? "" : back.error().message);
  return back ? *back : ModelData{};
}

TEST(ModelIo, FeaturesWithPartsSplinesSofteningAndTheErrorBoundAreKept) {
  const DriveCurve drive{5e-3, {0.1, 0.2, 1.0 / 3.0, 0.4}};
  FeatureSpec spectrum;
  spectrum.kind = FeatureKind::maxwell_spectrum;
  spectrum.part_count = 2;
  spectrum.parts[0] = {0.05, 0.0, drive};
  spectrum.parts[1] = {0.7, 0.0, drive};
  FeatureSpec stops;
  stops.kind = FeatureKind::stops;
  stops.part_count = 1;
  stops.parts[0] = {0.0, 1e-4, drive};
  spectrum.slowing = 1.7;
  FeatureSpec creep;
  creep.kind = FeatureKind::creep;
  creep.part_count = 1;
  creep.parts[0] = {0.1, 5e-3, drive};
  ModelData data = example_model("greedy", KernelKind::cubic, {FeatureSpec{}, spectrum, stops, creep}, 11);
  data.trend.elastic = test::even_spline(0.1, 1.0 / 3.0);
  data.error_bound = ErrorBound{0.01, 0.02, 0.3};
  data.sensor = SensorSpec{30e-6, 1e-6};
  const std::vector<double> memory(memory_size(data.features), 1.0 / 3.0);
  data.ends = {{-1e-3, 4e-3, memory}, {0.0, 0.1, memory}};
  const ModelData back = read_back(data);
  EXPECT_EQ(back.features, data.features);
  EXPECT_EQ(back.ends, data.ends);
  ASSERT_TRUE(back.error_bound.has_value() && back.sensor.has_value());
  EXPECT_EQ(back.sensor->encoder_step_m, 30e-6);
  EXPECT_EQ(back.sensor->position_noise_m, 1e-6);
  const FittedModel original(data);
  const FittedModel loaded(back);
  test::Numbers numbers(4);
  for (int query = 0; query < 500; ++query) {
    const double x[] = {5e-3 * std::abs(numbers.next()), numbers.next(), numbers.next(), 5e-3};
    const ForceEstimate one = original.evaluate(x);
    const ForceEstimate other = loaded.evaluate(x);
    ASSERT_EQ(bits(one.force_N), bits(other.force_N));
    ASSERT_EQ(bits(one.predicted_error_N), bits(other.predicted_error_N));
    ASSERT_GE(one.predicted_error_N, 0.01);
  }
  EXPECT_EQ(text_of(back), text_of(data));
}

TEST(ModelIo, AModelWithoutAnErrorBoundSaysThatItDoesNotKnow) {
  const ModelData data = example_models().front();
  EXPECT_EQ(text_of(data).find("error_bound"), std::string::npos);
  std::array<double, kMaxFeatures> x{};
  EXPECT_TRUE(std::isnan(FittedModel(read_back(data)).evaluate(x.data()).predicted_error_N));
}

TEST(ModelIo, ForcesAreBitIdenticalAfterLoading) {
  const test::TemporaryFolder folder;
  for (const ModelData& data : example_models()) {
    SCOPED_TRACE(data.name);
    ASSERT_TRUE(save_model(folder.file(data.name), data, false).ok());
    const auto loaded = load_model(folder.file(data.name));
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_EQ(text_of((*loaded)->data()), text_of(data));  // with all fields
    const FittedModel original(data);
    test::Numbers numbers(99);
    int inside = 0;
    for (int query = 0; query < 2000; ++query) {
      std::array<double, kMaxFeatures> x{};
      for (std::size_t i = 0; i < data.features.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        x[i] = data.offset(k) + 1.4 * data.scale(k) * numbers.next();
      }
      const ForceEstimate before = original.evaluate(x.data());
      const ForceEstimate after = (*loaded)->evaluate(x.data());
      ASSERT_EQ(bits(before.force_N), bits(after.force_N)) << query;
      ASSERT_EQ(before.out_of_domain, after.out_of_domain);
      inside += before.out_of_domain ? 0 : 1;
    }
    EXPECT_GT(inside, 100) << "the queries hardly reach the correction";
  }
}

TEST(ModelIo, AwkwardNumbersRoundTripBitForBit) {
  ModelData data = example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
  const double awkward[] = {-0.0,
                            0.1,
                            1.0 / 3.0,
                            5e-324,
                            -2.2250738585072014e-308,
                            1.7976931348623157e308,
                            9007199254740993.0,
                            1e22,
                            123456789012345678.0,
                            -1e-7,
                            3.0,
                            std::nextafter(1.0, 2.0)};
  // This field accepts any number.
  for (const double offset_m : awkward) data.provenance.offsets.push_back({"press-1", offset_m, 0.0, 0.0});
  const ModelData back = read_back(data);
  ASSERT_EQ(back.provenance.offsets.size(), std::size(awkward));
  for (std::size_t i = 0; i < std::size(awkward); ++i) {
    EXPECT_EQ(bits(back.provenance.offsets[i].offset_m), bits(awkward[i])) << awkward[i];
  }
}

TEST(ModelIo, StoresNeitherTimesNorFolders) {
  ModelData data = example_model("greedy", KernelKind::cubic, test::position_features(), 1);
  const std::string text = text_of(data);
  data.provenance.recordings[0].insert(0, "/home/someone/rec/");  // folders are not stored, either
  EXPECT_EQ(text_of(data), text);
  EXPECT_EQ(text.find("seconds"), std::string::npos);
}

TEST(ModelIo, WhatCannotBeReadIsNotWritten) {
  const test::TemporaryFolder folder;
  const auto message = [&](void (*spoil)(ModelData&)) {
    ModelData data = example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
    spoil(data);
    const Status status = save_model("m.json", data, false);
    return status ? "" : status.error().message;
  };
  EXPECT_TRUE(test::has_parts(message([](ModelData& data) { data.name = "a,b"; }),
                              {"m.json", "found \"a,b\"", "1 to 100 bytes"}));
  EXPECT_TRUE(
      test::has_parts(message([](ModelData& data) { data.method = ""; }), {"m.json", "found \"\"", "1 to 100 bytes"}));
  EXPECT_TRUE(test::has_parts(message([](ModelData& data) {
                                test::change_rbf(data, [](RbfFunction& f) {
                                  f.weights(3) = std::numeric_limits<double>::quiet_NaN();
                                });
                              }),
                              {"m.json", "correction", "nan"}));
  EXPECT_TRUE(test::has_parts(message([](ModelData& data) { data.provenance.training_within_jnd = -1.0; }),
                              {"m.json", "provenance.training_within_jnd", "found -1", "from 0 up to 1"}));
}

}  // namespace
}  // namespace palpate
