// Broken model files: every message has the position, the field, the value found,
// the expected one and advice.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::example_model;

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

std::string text_of(const ModelData& data) {
  const Result<std::string> text = write_model_text(data);
  EXPECT_TRUE(text.ok()) << (text ? "" : text.error().message);
  return text ? folded(*text) : "";
}

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
  return text_of(data);
}

std::string small_grid_text() {
  ModelData data = example_model("voxel", KernelKind::cubic, test::position_features(), 1);
  data.cover.points = Eigen::MatrixXd::Constant(1, 1, 0.25);
  test::change_grid(data, [](VoxelGrid& grid) { grid.values_N = {1.5, 2.5, 3.5}; });
  return text_of(data);
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
  std::string text = text_of(data);
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
