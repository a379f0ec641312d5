#include "models/model/file/model_io.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// Model files: writing and reading lose nothing.

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
  data.error_bound = ErrorBound{0.01, 0.02, 0.3, 1e-4};
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
    const Result loaded = test::must(load_model(folder.file(data.name)));
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

// Broken model files: every message has the position, the field, the value found,
// the expected one and advice.

// The text with what is nested deeper than two levels on one line, which is easier to break.
std::string folded(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t depth = line.find_first_not_of(' ');
    line.erase(0, depth);
    if (depth > 2 || (depth == 2 && (line[0] == ']' || line[0] == '}'))) {
      result.append(result.back() == ',' ? " " : "").append(line);
    } else {
      result.append(result.empty() ? "" : "\n").append(2 * depth, ' ').append(line);
    }
  }
  return result + "\n";
}

std::string folded_text_of(const ModelData& data) { return folded(text_of(data)); }

// A small model whose text is easy to break.
std::string small_text() {
  ModelData data = example_model("greedy", KernelKind::linear, test::maxwell_features(), 1);
  data.features.resize(3);
  for (Eigen::VectorXd* values : {&data.offset, &data.scale, &data.lower, &data.upper}) {
    *values = Eigen::VectorXd(values->head(3));
  }
  data.cover.points = Eigen::MatrixXd::Constant(3, 1, 0.25);
  test::change_rbf(data, [](RbfFunction& function) {
    function.centres = Eigen::MatrixXd::Constant(3, 2, 0.5);
    function.weights = Eigen::VectorXd::Constant(2, 0.125);
    function.tail = Eigen::VectorXd::Constant(1, 1.5);
  });
  data.name = "small";
  return folded_text_of(data);
}

std::string small_grid_text() {
  ModelData data = example_model("voxel", KernelKind::cubic, test::position_features(), 1);
  data.cover.points = Eigen::MatrixXd::Constant(1, 1, 0.25);
  test::change_grid(data, [](VoxelGrid& grid) { grid.values_N = {1.5, 2.5, 3.5}; });
  return folded_text_of(data);
}

std::string complaint(const std::string& text) {
  const Result<ModelData> data = read_model_text(text, "m.json");
  return data ? "accepted" : data.error().message;
}

void expect_all(const std::string& text, const std::vector<test::BrokenText>& table) {
  ASSERT_EQ(complaint(text), "accepted") << text;
  test::expect_messages(text, complaint, table);
}

TEST(ModelReader, RefusesWhatIsNoModelOfThisVersion) {
  expect_all(
      small_text(),
      {
          {"\"palpate-model\"",
           "\"palpate\"",
           {"m.json:2:13:", "format", "\"palpate\"", "\"palpate-model\"", "palpate fit"}},
          {"\"format\"", "\"Format\"", {"m.json:1:1:", "\"format\"", "\"palpate-model\"", "palpate fit"}},
          {"\"version\": 1", "\"version\": 2", {"m.json:3:14:", "version", "found 2", "expected 1", "; "}},
          {"\"version\": 1", "\"version\": \"1\"", {"m.json:3:14:", "version", "found \"1\"", "expected 1", "; "}},
          {"  \"version\": 1,\n", "", {"m.json:1:1:", "version", "no such field", "expected 1", "; "}},
      });
}

TEST(ModelReader, RefusesWrongNamesAndFeatures) {
  expect_all(small_text(),
             {
                 {"\"small\"", "\"\"", {"m.json:4:11:", "name", "found \"\"", "1 to 100 bytes", "; "}},
                 {"\"small\"", "\"a,b\"", {"m.json:4:11:", "name", "found \"a,b\"", "1 to 100 bytes", "; "}},
                 {"\"small\"", "7", {"m.json:4:11:", "name", "found 7", "; "}},
                 {"\"greedy\"", "\"\"", {"m.json:5:13:", "method", "found \"\"", "1 to 100 bytes", "; "}},
                 {"\"kind\": \"velocity\"",
                  "\"kind\": \"speed\"",
                  {"m.json:8:14:", "features[1].kind", "\"speed\"", "depth", "creep", "; "}},
                 // Written by an earlier version.
                 {"\"kind\": \"velocity\"",
                  "\"kind\": \"surface_lag\"",
                  {"m.json:8:14:", "features[1].kind", "\"surface_lag\"", "creep", "; "}},
                 {"\"coefficient_N\": [",
                  "\"knot_N\": [0, 0, 0, 0, 0, 0, 0], \"coefficient_N\": [",
                  {"m.json:9:", "features[2].parts[0].drive.knot_N", "an unknown field", "; "}},
                 {"{\"kind\": \"velocity\"}", "7", {"m.json:8:5:", "features[1]", "found 7", "\"kind\"", "; "}},
                 {"\"relaxation_time_s\": 0.1",
                  "\"relaxation_time_s\": 0",
                  {"m.json:9:66:", "features[2].parts[0].relaxation_time_s", "found 0", "above 1e-12", "; "}},
                 {"[0.4, 0.3, 0.2, 0.1]",
                  "[0.4, 0.3, 0.2, 1e300]",
                  {"m.json", "features[2].parts[0].drive.coefficient_N[3]", "1e+300", "from -1e+09 up to 1e+09", "; "}},
                 {"{\"kind\": \"depth\"},",
                  "",
                  {"m.json:12:15:", "offset", "m.json:13:14:", "scale", "m.json:42:14:", "lower",
                   "m.json:43:14:", "upper", "m.json:46:16:", "points", "m.json:53:5:", "centres"}},
             });
}

TEST(ModelReader, RefusesWrongNumbersAndSizes) {
  expect_all(
      small_text(),
      {
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": [0.003, 0, 1]",
           {"m.json:13:22:", "normalisation.scale[1]", "found 0", "above 1e-12", "; "}},
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": [0.003, 5e-324, 1]",
           {"m.json:13:22:", "normalisation.scale[1]", "found 5e-324", "above 1e-12", "; "}},
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": [1e-200, 0.05, 1]",
           {"m.json:13:15:", "normalisation.scale[0]", "found 1e-200", "above 1e-12", "; "}},
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": [0.003, 0.05]",
           {"m.json:13:14:", "normalisation.scale", "list of 2", "expected 3", "; "}},
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": [0.003, null, 1]",
           {"m.json:13:22:", "normalisation.scale[1]", "found null", "; "}},
          {"\"scale\": [0.003, 0.05, 1.0]",
           "\"scale\": 1",
           {"m.json:13:14:", "normalisation.scale", "found 1", "expected 3", "; "}},
          {"\"offset_N\": 0.065", "\"offset_N\": 0", {"m.json:26:17:", "jnd.offset_N", "found 0", "above 1e-12", "; "}},
          {"\"jnd\": {", "\"jnd\": 3, \"was\": {", {"m.json:25:10:", "jnd", "found 3", "\"offset_N\"", "; "}},
          {"\"largest_force_N\": 2.5",
           "\"largest_force_N\": 1.7e308",
           {"m.json:24:22:", "largest_force_N", "1.7e+308", "from 0 up to 1e+06", "; "}},
          {"\"outer_radius\": 0.9", "\"outer_radius\": 0.2", {"domain.outer_radius", "0.2", "above 0.3", "; "}},
          {"\"seed\": 18446744073709551615",
           "\"seed\": -1",
           {"m.json:35:13:", "provenance.seed", "found -1", "0 or more", "; "}},
          {"\"press-2\"", "2", {"m.json:30:31:", "provenance.recordings[1]", "found 2", "; "}},
          {"[0.25, 0.25, 0.25]", "", {"m.json:46:15:", "domain.points", "empty", "; "}},
          {"\"linear\"", "\"gauss\"", {"m.json:48:13:", "kernel", "\"gauss\"", "cubic", "; "}},
          {"    1.5\n", "    1.5, 2\n", {"m.json:49:11:", "tail", "list of 2", "expected 1", "; "}},
          {"[0.5, 0.5, 0.5],", "[0.5, 0.5],", {"m.json:53:5:", "centres[0]", "list of 2", "expected 3", "; "}},
          {"[0.5, 0.5, 0.5],", "", {"m.json:56:14:", "weights", "list of 2", "expected 1", "; "}},
          {"\"centres\"", "\"centers\"", {"m.json:1:1:", "\"centres\"", "\"grid\"", "\"trend_alone\"", "; "}},
          {"\"centres\"", "\"grid\": {}, \"centres\"", {"m.json:1:1:", "\"centres\"", "\"grid\"", "; "}},
      });
}

// Limits that the tick relies on: its arrays have room for eight features of eight parts, and it divides by lengths.
TEST(ModelReader, RefusesWhatTheTickCannotCompute) {
  const std::string text = small_text();
  const std::string feature = "{\"kind\": \"velocity\"},";
  const std::size_t first = text.find("{\"relaxation_time_s\"");
  const std::string part = text.substr(first, text.find("]}}", first) + 3 - first);
  std::string features, parts;
  for (int i = 0; i < 7; ++i) features += feature;
  for (int i = 0; i < 9; ++i) parts += (i > 0 ? ", " : "") + part;
  const auto number = [&](const std::string& key) {
    const std::size_t at = text.find("\"" + key + "\": ");
    return text.substr(at, text.find_first_of(",}\n", at) - at);
  };
  expect_all(text, {
                       {feature, features, {"m.json:6:15:", "features", "list of 9", "1 to 8", "; "}},
                       {part, parts, {"m.json", "features[2].parts", "list of 9", "1 to 8", "; "}},
                       {number("thinning_velocity_m_per_s"),
                        "\"thinning_velocity_m_per_s\": 0",
                        {"m.json", "trend.thinning_velocity_m_per_s", "found 0", "above 1e-12", "; "}},
                       {number("velocity_limit_m_per_s"),
                        "\"velocity_limit_m_per_s\": -1",
                        {"m.json", "trend.velocity_limit_m_per_s", "found -1", "0 or more", "; "}},
                       {number("correction_limit_N"),
                        "\"correction_limit_N\": -1",
                        {"m.json", "correction_limit_N", "found -1", "from 0", "; "}},
                   });
  for (const char* const group : {"\"drive\": {", "\"trend\": {"}) {
    const std::size_t at = text.find("\"reference_depth_m\": ", text.find(group));
    const std::string spoiled = std::string(text).replace(at, text.find(',', at) - at, "\"reference_depth_m\": 0");
    EXPECT_TRUE(test::has_parts(complaint(spoiled), {"reference_depth_m", "found 0", "above 1e-12", "; "}));
  }
  const std::size_t list = text.find("\"features\": [");
  const std::string none = std::string(text).replace(list, text.find("\n  ]", list) - list, "\"features\": [");
  EXPECT_TRUE(test::has_parts(complaint(none), {"features", "list of 0", "1 to 8", "; "}));
}

TEST(ModelReader, RefusesAFieldThatItDoesNotKnow) {
  expect_all(small_text(),
             {
                 {"\"tail\"",
                  "\"tails\": 3,\n\"tail\"",
                  {"m.json:49:12:", "tails", "unknown field", "format", "correction_limit_N", "largest_force_N",
                   "lowest_force_N", "error_bound", "; "}},
                 {"{\"kind\": \"depth\"}",
                  "{\"kind\": \"depth\", \"time\": 1}",
                  {"m.json:7:31:", "features[0].time", "unknown field", "kind", "surface_position_m", "; "}},
             });
}

TEST(ModelReader, RefusesWrongGrids) {
  expect_all(
      small_grid_text(),
      {
          {"[[-1.0, 0.0, 1.0]]", "[[-1, 0, 0]]", {"m.json:47:23:", "grid.nodes[0][2]", "found 0", "at least 2", "; "}},
          {"[[-1.0, 0.0, 1.0]]", "[[-1]]", {"m.json:47:15:", "grid.nodes[0]", "list of 1", "at least 2", "; "}},
          {"[[-1.0, 0.0, 1.0]]", "[]", {"m.json:47:14:", "grid.nodes", "list of 0", "expected 1", "; "}},
          {"[[-1.0, 0.0, 1.0]]", "[[-1, 1]]", {"m.json:48:17:", "grid.values_N", "list of 3", "; "}},
          {"1.5, 2.5, 3.5", "1.5, 2.5, {}", {"m.json:48:28:", "grid.values_N[2]", "found an object", "; "}},
      });
}

TEST(ModelReader, RefusesTextThatIsNoModel) {
  expect_all(small_text(), {{"\"largest_force_N\": 2.5", "\"largest_force_N\": 2,5", {"m.json:24:24:", "; "}}});
  EXPECT_TRUE(test::has_parts(complaint("[1, 2]"), {"m.json:1:1:", "\"format\"", "\"palpate-model\"", "palpate fit"}));
  const std::string deep(10'000'000, '[');
  EXPECT_TRUE(test::has_parts(complaint(deep), {"m.json:1:17:", "more than 16", "; "}));
}

// Every truncated file is refused without a crash.
TEST(ModelReader, RefusesAFileCutAnywhere) {
  const std::string text = small_text();
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    const std::string message = complaint(text.substr(0, length));
    ASSERT_EQ(message.rfind("m.json:", 0), 0u) << length << ": " << message;
  }
}

// Any changed byte gives a message or another valid model, never a crash.
TEST(ModelReader, SurvivesAnyChangedByte) {
  const std::string text = small_text();
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (const char c : {'\0', '"', '[', '}', '9', '-', 'e', ',', '\xff'}) {
      std::string changed = text;
      changed[at] = c;
      const auto data = read_model_text(changed, "m.json");
      EXPECT_TRUE(!data || write_model_text(*data).ok()) << changed;
    }
  }
}

// The product of the axis sizes overflows to 0, the number of values.
TEST(ModelReader, RefusesAGridThatOverflows) {
  ModelData data = example_model("voxel", KernelKind::cubic, test::paper_features(), 1);
  std::string axis = "[";
  for (int i = 0; i < 65535; ++i) axis.append(std::to_string(i)).append(",");
  axis += "65535]";
  std::string text = folded_text_of(data);
  text = text.substr(0, text.find("\"grid\"")) + "\"grid\": {\"nodes\": [" + axis + "," + axis + "," + axis + "," +
         axis + "],\n\"values_N\": []}}";
  const std::string message = complaint(text);
  EXPECT_TRUE(test::has_parts(message, {"grid.values_N", "list of 0"})) << message.substr(0, 200);
}

TEST(ModelReader, ExplainsFilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    const auto model = load_model(path);
    return model ? "loaded" : model.error().message;
  };
  EXPECT_TRUE(
      test::has_parts(message(folder.file("none.json")), {folder.file("none.json"), "no such file", "palpate fit"}));
  EXPECT_TRUE(test::has_parts(message(folder.path()), {folder.path(), "folder", "; "}));
  EXPECT_TRUE(test::has_parts(message("/dev/null"), {"/dev/null", "pipe", "; "}));
  const std::string damaged =
      message(folder.with_file("damaged.json", "{\"format\": \"palpate-model\", \"version\": 1}"));
  EXPECT_TRUE(test::has_parts(damaged, {"damaged.json:1:", "more errors"}));
  EXPECT_EQ(damaged.find('\n'), std::string::npos);
  // A sparse file, which occupies almost no disk space.
  const std::string huge = folder.with_file("huge.json", "");
  std::filesystem::resize_file(huge, kMaximumModelFileBytes + 1);
  EXPECT_TRUE(test::has_parts(message(huge), {huge, "536870913 bytes", "536870912", "palpate fit"}));
}

}  // namespace
}  // namespace palpate
