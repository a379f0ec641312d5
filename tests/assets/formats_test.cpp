#include <gtest/gtest.h>

#include <regex>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

test::ProgramRun check_schema(const std::vector<std::string>& files) {
  std::vector<std::string> command = {
      "/usr/bin/env", "python3", "-c",
      "import json, jsonschema, sys; schema, *files = [json.load(open(path)) for path in sys.argv[1:]]\n"
      "for file in files: jsonschema.validate(file, schema)",
      PALPATE_SOURCE_DIR "/assets/formats/model.schema.json"};
  command.insert(command.end(), files.begin(), files.end());
  return test::run_program(command);
}

TEST(Formats, EveryModelFileIsAsTheSchemaSays) {
  const test::TemporaryFolder folder;
  std::vector<std::string> files;
  for (const ModelData& data : test::example_models()) {
    files.push_back(folder.file(data.name + ".json"));
    ASSERT_TRUE(save_model(files.back(), data, false).ok());
  }
  const auto run = check_schema(files);
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
}

TEST(Formats, TheSchemaRefusesWhatTheReaderRefuses) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("model.json");
  ASSERT_TRUE(save_model(path, test::example_models().front(), false).ok());
  const std::string text = test::read_text(path);
  const std::vector<std::pair<const char*, const char*>> changes = {{"palpate-model", "another-model"},
                                                                    {"\"version\": 1", "\"version\": 2"},
                                                                    {"\"kernel\"", "\"kernels\""},
                                                                    {"\"largest_force_N\": ", "\"largest_force_N\": -"},
                                                                    {"\"kind\": \"depth\"", "\"kind\": \"colour\""},
                                                                    {"\"thinning\": \"coverage\"", "\"thinning\": 1"}};
  for (const auto& [from, to] : changes) {
    const std::string changed = std::regex_replace(text, std::regex(from), to, std::regex_constants::format_first_only);
    ASSERT_NE(changed, text) << from;
    const std::string file = folder.with_file("changed.json", changed);
    EXPECT_EQ(check_schema({file}).exit_code, 1) << to;
    EXPECT_FALSE(load_model(file).ok()) << to;
  }
}

TEST(Formats, TheExampleRecordingIsOneAndSaysThatItIsNoRealMaterial) {
  const std::string path = PALPATE_SOURCE_DIR "/assets/examples/silicone_press.csv";
  const Result recording = test::must(read_recording(path));
  const std::string text = test::read_text(path);
  EXPECT_LT(text.size(), 200000U);
  EXPECT_TRUE(test::has_parts(text.substr(0, text.find("time_s")), {"palpate synth"}));
}

}  // namespace
}  // namespace palpate
