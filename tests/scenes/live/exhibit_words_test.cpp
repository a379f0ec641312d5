#include "scenes/live/exhibit_game.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/base/files.h"
#include "scenes/scene/scene.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(ExhibitWords, AllLanguagesSayTheSameThings) {
  const auto languages = test::must(read_exhibit_words(find_assets().value() + "/exhibit"));
  ASSERT_GE(languages.size(), 2u);
  EXPECT_EQ(languages[0]("language"), "English");
  EXPECT_EQ(languages[1]("language"), "Deutsch");
  const auto english = nlohmann::json::parse(*read_whole_file(find_assets().value() + "/exhibit/english.json"));
  const auto german = nlohmann::json::parse(*read_whole_file(find_assets().value() + "/exhibit/german.json"));
  EXPECT_EQ(english.size(), german.size());
  for (const auto& [key, text] : english.items()) EXPECT_TRUE(german.contains(key)) << key;
}

TEST(ExhibitWords, FillInNumbersAndShowMissingKeys) {
  const auto words = test::must(ExhibitWords::parse("{\"was\": \"Block %1: %2\"}", "x.json"));
  EXPECT_EQ(words("was", "1", "soft"), "Block 1: soft");
  EXPECT_EQ(words("nothing"), "nothing");
}

TEST(ExhibitTally, OutlivesARestart) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("tally");
  EXPECT_EQ(read_tally(path).answers[0], 0u);
  ASSERT_TRUE(write_tally(path, {{12, 11, 10}, {1, 4, 9}}).ok());
  EXPECT_EQ(read_tally(path).answers[1], 11u);
  EXPECT_EQ(read_tally(path).fooled[2], 9u);
  for (const char* broken : {"3 7 1 1 1 1", "3", ""})
    EXPECT_EQ(read_tally(folder.with_file("broken", broken)).answers[0], 0u) << broken;
}

}  // namespace
}  // namespace palpate
