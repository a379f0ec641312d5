// Broken model files: every message has the position, the field, the value found,
// the expected one and advice.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/model/file/model_io.h"
#include "models/model/file/model_json.h"
#include "tests/support/example_model.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::example_model;

std::string text_of(const ModelData& data) {
  const Result<std::string> text = write_model_text(data);
  EXPECT_TRUE(text.ok()) << (text ? "" : text.error().message);
  return text ? *text : "";
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

// `text` with the first `from` replaced by `to`; the test fails if there is none.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string complaint(const std::string& text) {
  const Result<ModelData> data = read_model_text(text, "m.json");
  return data ? "accepted" : data.error().message;
}

struct Broken {
  std::string from;
  std::string to;
  std::string message;
};

void expect_all(const std::string& text, const std::vector<Broken>& table) {
  ASSERT_EQ(complaint(text), "accepted") << text;
  for (const Broken& broken : table) {
    EXPECT_EQ(complaint(with(text, broken.from, broken.to)), broken.message) << broken.from << " -> " << broken.to;
  }
}

TEST(ModelReader, RefusesWhatIsNoModelOfThisVersion) {
  expect_all(
      small_text(),
      {
          {"\"palpate-model\"", "\"palpate\"",
           "m.json:2:13: format: found \"palpate\", expected \"palpate-model\"; name a file that palpate fit "
           "wrote"},
          {"\"format\"", "\"Format\"",
           "m.json:1:1: found no \"format\", expected \"palpate-model\"; name a file that palpate fit wrote"},
          {"\"version\": 1", "\"version\": 2",
           "m.json:3:14: version: found 2, expected 1; fit the model again with this program, or read it with "
           "the one that wrote it"},
          {"\"version\": 1", "\"version\": \"1\"",
           "m.json:3:14: version: found \"1\", expected 1; fit the model again with this program, or read it "
           "with the one that wrote it"},
          {"  \"version\": 1,\n", "", "m.json:1:1: version: found no such field, expected 1; fit the model again"},
      });
}

TEST(ModelReader, RefusesWrongNamesAndFeatures) {
  expect_all(
      small_text(),
      {
          {"\"small\"", "\"\"",
           "m.json:4:11: name: found an empty text, expected 1 to 100 bytes without control characters, "
           "commas and quotes; fit the model again"},
          {"\"small\"", "\"a,b\"",
           "m.json:4:11: name: found a control character, comma or quote, expected 1 to 100 bytes without "
           "control characters, commas and quotes; fit the model again"},
          {"\"small\"", "7", "m.json:4:11: name: found 7, expected a text; fit the model again"},
          {"\"greedy\"", "\"\"",
           "m.json:5:13: method: found an empty text, expected 1 to 100 bytes without control characters, "
           "commas and quotes; fit the model again"},
          {"\"kind\": \"velocity\"", "\"kind\": \"speed\"",
           "m.json:8:14: features[1].kind: found \"speed\", expected one of depth, velocity, "
           "lowpass_velocity, maxwell_spectrum, stops, creep, surface_lag; fit "
           "the model again"},
          {"{\"kind\": \"velocity\"}", "7",
           "m.json:8:5: features[1]: found 7, expected an object with \"kind\"; fit the model again"},
          {"\"relaxation_time_s\": 0.1", "\"relaxation_time_s\": 0",
           "m.json:9:66: features[2].parts[0].relaxation_time_s: found 0, expected a number above 0; fit the model "
           "again"},
          {"\"relaxation_time_s\": 0.1", "\"relaxation_time_s\": \"0.1\"",
           "m.json:9:66: features[2].parts[0].relaxation_time_s: found \"0.1\", expected a number above 0; fit the "
           "model again"},
          {"[0.4, 0.3, 0.2, 0.1]", "[0.4, 0.3, 0.2]",
           "m.json:9:126: features[2].parts[0].drive.coefficient_N: found a list of 3, expected 4 coefficients; fit "
           "the model again"},
          {"{\"kind\": \"depth\"},", "",
           "m.json:12:15: normalisation.offset: found a list of 3, expected 2 numbers, one per feature; fit the model "
           "again\n"
           "m.json:13:14: normalisation.scale: found a list of 3, expected 2 numbers, one per feature; fit the model "
           "again\n"
           "m.json:41:14: domain.lower: found a list of 3, expected 2 numbers, one per feature; fit the model again\n"
           "m.json:42:14: domain.upper: found a list of 3, expected 2 numbers, one per feature; fit the model again\n"
           "m.json:46:5: domain.points[0]: found a list of 3, expected 2 numbers, one per feature; fit the model "
           "again\n"
           "m.json:52:5: centres[0]: found a list of 3, expected 2 numbers, one per feature; fit the model again"},
      });
}

TEST(ModelReader, ReadsTheSingleBranchOfEarlierFiles) {
  const std::string text = small_text();
  const std::string earlier =
      with(with(text, "\"maxwell_spectrum\", \"parts\": [{", "\"maxwell_branch\", "), "]}}]}", "]}}");
  const Result<ModelData> data = read_model_text(earlier, "m.json");
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(text_of(*data), text);
}

TEST(ModelReader, RefusesWrongNumbersAndSizes) {
  expect_all(
      small_text(),
      {
          {"\"scale\": [0.003, 0.05, 1]", "\"scale\": [0.003, 0, 1]",
           "m.json: normalisation.scale: found 0 or less, expected positive numbers; fit the model again"},
          {"\"scale\": [0.003, 0.05, 1]", "\"scale\": [0.003, 0.05]",
           "m.json:13:14: normalisation.scale: found a list of 2, expected 3 numbers, one per feature; fit "
           "the model again"},
          {"\"scale\": [0.003, 0.05, 1]", "\"scale\": [0.003, null, 1]",
           "m.json:13:22: normalisation.scale[1]: found null, expected a number; fit the model again"},
          {"\"scale\": [0.003, 0.05, 1]", "\"scale\": 1",
           "m.json:13:14: normalisation.scale: found 1, expected 3 numbers, one per feature; fit the model "
           "again"},
          {"\"offset_N\": 0.065", "\"offset_N\": 0",
           "m.json:26:23: jnd.offset_N: found 0, expected a number above 0; fit the model again"},
          {"\"jnd\": {", "\"jnd\": 3, \"was\": {",
           "m.json:26:10: jnd: found 3, expected an object with \"offset_N\"; fit the model again"},
          {"\"corrects_trend\": true", "\"corrects_trend\": 1",
           "m.json:23:21: corrects_trend: found 1, expected true or false; fit the model again"},
          {"\"largest_force_N\": 2.5", "\"largest_force_N\": -2.5",
           "m.json:25:22: largest_force_N: found -2.5, expected a number, 0 or more; fit the model again"},
          {"\"largest_force_N\": 2.5", "\"largest_force_N\": 1.7e308",
           "m.json: largest_force_N: found 1.7e+308 N, expected at most 1e6 N; fit the model again"},
          {"\"inner_radius\": 0.3", "\"inner_radius\": 3",
           "m.json: domain radii: found 3.000000 and 0.909091, expected 0 <= inner < outer; fit the model "
           "again"},
          {"\"seed\": 18446744073709551615", "\"seed\": -1",
           "m.json:33:13: provenance.seed: found -1, expected a whole number, 0 or more; fit the model again"},
          {"\"press-2\"", "2", "m.json:28:31: provenance.recordings[1]: found 2, expected a text; fit the model again"},
          {"\"standard_error_s\": 0.01", "\"standard_error\": 0.01",
           "m.json:37:26: provenance.relaxation_times[0].standard_error_s: found no such field, expected a "
           "number, 0 or more; fit the model again"},
          {"[0.25, 0.25, 0.25]", "",
           "m.json:45:15: domain.points: found an empty list, expected a list of at least one point; fit the "
           "model again"},
          {"\"linear\"", "\"gauss\"",
           "m.json:49:13: kernel: found \"gauss\", expected one of cubic, linear, thin-plate, quintic; fit "
           "the model again"},
          {"\"tail\": [1.5]", "\"tail\": [1.5, 2]",
           "m.json:50:11: tail: found a list of 2, expected 1 coefficients; fit the model again"},
          {"[0.5, 0.5, 0.5],", "[0.5, 0.5],",
           "m.json:52:5: centres[0]: found a list of 2, expected 3 numbers, one per feature; fit the model "
           "again"},
          {"[0.5, 0.5, 0.5],", "[0.5, \"x\", 0.5],",
           "m.json:52:11: centres[0][1]: found \"x\", expected a number; fit the model again"},
          {"[0.5, 0.5, 0.5],", "",
           "m.json:55:14: weights: found a list of 2, expected 1 numbers, one per centre; fit the model again"},
          {"0.125,", "",
           "m.json:55:14: weights: found a list of 1, expected 2 numbers, one per centre; fit the model again"},
          {"\"centres\"", "\"centers\"",
           "m.json:1:1: found none of \"centres\", \"grid\", \"trend_alone\", expected one of them; fit the model "
           "again"},
          {"\"centres\"", "\"grid\": {}, \"centres\"",
           "m.json:1:1: found both \"centres\" and \"grid\", expected one of them; fit the model again"},
      });
}

TEST(ModelReader, RefusesAFieldThatItDoesNotKnow) {
  expect_all(
      small_text(),
      {
          {"\"tail\"", "\"tails\": 3,\n\"tail\"",
           "m.json:50:12: tails: found an unknown field, expected one of format, version, name, method, features, "
           "normalisation, trend, corrects_trend, correction_limit_N, largest_force_N, jnd, "
           "provenance, domain, lowest_force_N, sensor, error_bound, kernel, tail, centres, weights; fit the model "
           "again"},
          {"{\"kind\": \"depth\"}", "{\"kind\": \"depth\", \"time\": 1}",
           "m.json:7:31: features[0].time: found an unknown field, expected one of kind, surface_position_m; fit the "
           "model again"},
      });
}

TEST(ModelReader, RefusesWrongGrids) {
  expect_all(small_grid_text(),
             {
                 {"[[-1, 0, 1]]", "[[-1, 0, 0]]",
                  "m.json:48:23: grid.nodes[0][2]: found 0, expected at least 2 numbers, each above the last; fit "
                  "the model again"},
                 {"[[-1, 0, 1]]", "[[-1]]",
                  "m.json:48:15: grid.nodes[0]: found a list of 1, expected at least 2 numbers, each above the last; "
                  "fit the model again"},
                 {"[[-1, 0, 1]]", "[]",
                  "m.json:48:14: grid.nodes: found a list of 0 axes, expected 1, one per feature; fit the model again"},
                 {"[[-1, 0, 1]]", "[[-1, 1]]",
                  "m.json:49:17: grid.values_N: found a list of 3, expected as many as the grid has nodes; fit the "
                  "model again"},
                 {"1.5, 2.5, 3.5", "1.5, 2.5, {}",
                  "m.json:50:15: grid.values_N[2]: found an object, expected a number; fit the model again"},
             });
}

TEST(ModelReader, RefusesTextThatIsNotJson) {
  expect_all(small_text(),
             {
                 {"\"largest_force_N\": 2.5", "\"largest_force_N\": 1e999",
                  "m.json:25:22: found 1e999, expected a finite number; fit the model again"},
                 {"\"largest_force_N\": 2.5", "\"largest_force_N\": -1e400",
                  "m.json:25:22: found -1e400, expected a finite number; fit the model again"},
                 {"\"largest_force_N\": 2.5", "\"largest_force_N\": NaN",
                  "m.json:25:22: syntax error while parsing value - invalid literal; last read: "
                  "'\"largest_force_N\": N'; the file is damaged: copy it again or fit the model again"},
                 {"\"largest_force_N\": 2.5", "\"largest_force_N\": 2,5",
                  "m.json:25:24: syntax error while parsing object key - unexpected number literal; expected string "
                  "literal; the file is damaged: copy it again or fit the model again"},
                 {"\"small\"", "\"sm\xff\"",
                  "m.json:4:14: syntax error while parsing value - invalid string: ill-formed UTF-8 byte; last read: "
                  "'\"sm\\xff'; the file is damaged: copy it again or fit the model again"},
             });
  const std::string text = small_text();
  EXPECT_EQ(complaint(""),
            "m.json:1:1: syntax error while parsing value - unexpected end of input; expected '[', '{', "
            "or a literal; the file is damaged: copy it again or fit the model again");
  EXPECT_EQ(complaint(text.substr(0, 100)),
            "m.json:6:13: syntax error while parsing object separator - unexpected end of input; expected "
            "':'; the file is damaged: copy it again or fit the model again");
  EXPECT_EQ(complaint(std::string("\0\0\0\0", 4)),
            "m.json:1:1: found a NUL byte, expected text; the file is damaged: copy it again or fit the model again");
  EXPECT_EQ(complaint("[1, 2]"),
            "m.json:1:1: found no \"format\", expected \"palpate-model\"; name a file that palpate fit "
            "wrote");
  EXPECT_EQ(complaint("{} {}"),
            "m.json:1:4: syntax error while parsing value - unexpected '{'; expected end of input; the "
            "file is damaged: copy it again or fit the model again");
  EXPECT_EQ(complaint(std::string(10'000'000, '[')),
            "m.json:1:17: found more than 16 lists inside each other, expected fewer; the file is "
            "damaged: copy it again or fit the model again");
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
      EXPECT_TRUE(!data || validate_model(*data).ok()) << changed;
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
  EXPECT_NE(message.find("grid.values_N: found a list of 0, expected as many as the grid has nodes"), std::string::npos)
      << message.substr(0, 200);
}

TEST(ModelReader, ExplainsFilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto message = [](const std::string& path) {
    const auto model = load_model(path);
    return model ? "loaded" : model.error().message;
  };
  EXPECT_EQ(message(folder.file("none.json")),
            folder.file("none.json") +
                ": found no such file, expected a model file; check the path, or make one with palpate fit");
  EXPECT_EQ(message(folder.path()), folder.path() + ": found a folder, expected a model file; name a file in it");
  EXPECT_EQ(message("/dev/null"),
            "/dev/null: found a pipe or a device, expected a model file; save it to a file first");
  // A sparse file, which occupies almost no disk space.
  const std::string huge = folder.with_file("huge.json", "");
  std::filesystem::resize_file(huge, kMaximumModelFileBytes + 1);
  EXPECT_EQ(message(huge),
            huge + ": found 536870913 bytes, expected at most 536870912; name a file that palpate fit wrote");
}

}  // namespace
}  // namespace palpate
