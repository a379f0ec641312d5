#include "scenes/live/recording_offer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "engine/recording/recording.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::string rows(const char* header, const char* between) {
  std::string text = std::string(header) + "\n";
  for (int i = 0; i < 50; ++i) {
    const double at = 0.01 * i;
    text += std::to_string(at) + between + std::to_string(at) + between + std::to_string(2.0 * at) + "\n";
  }
  return text;
}

std::string write(const test::TemporaryFolder& folder, const std::string& name, const std::string& text) {
  const std::string path = folder.file(name);
  std::ofstream(path) << text;
  return path;
}

TEST(RecordingOffer, EverythingButAModelIsOffered) {
  EXPECT_TRUE(is_offered("a.csv"));
  EXPECT_TRUE(is_offered("trial.TXT"));
  EXPECT_FALSE(is_offered("model.json"));
  EXPECT_FALSE(is_offered("greedy-10")) << "a method";
}

TEST(RecordingOffer, ARecordingIsOfferedAsItIs) {
  const test::TemporaryFolder folder;
  const std::string path = write(folder, "a.csv", rows("time_s,position_m,force_N", ","));
  const auto offer = offer_recording(path, folder.path());
  ASSERT_TRUE(offer.ok()) << offer.error().message;
  EXPECT_EQ(offer->path, path);
  EXPECT_TRUE(offer->words.empty());
}

TEST(RecordingOffer, AnotherTableBecomesOneInTheFolder) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder data;
  const std::string path = write(folder, "trial.txt", rows("Time [s]\tPosition [mm]\tForce [mN]", "\t"));
  const auto offer = offer_recording(path, data.path());
  ASSERT_TRUE(offer.ok()) << offer.error().message;
  EXPECT_EQ(offer->path.rfind(data.path() + "/trial-", 0), 0u) << offer->path;
  EXPECT_EQ(offer->words.at(2).rfind("position: column 2 \"Position [mm]\" in mm", 0), 0u) << offer->words.at(2);
  const auto recording = read_recording(offer->path);
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_NEAR(recording->rows.back().force_N, 0.98e-3, 1e-9);
}

TEST(RecordingOffer, WhatIsWrongIsSaidOfWhatItWantsToBe) {
  const test::TemporaryFolder folder;
  const auto broken =
      offer_recording(write(folder, "a.csv", "# mine\ntime_s,position_m,force_N\n0,0,x\n"), folder.path());
  ASSERT_FALSE(broken.ok());
  EXPECT_NE(broken.error().message.find("a.csv:3"), std::string::npos) << broken.error().message;
  const auto two = offer_recording(
      write(folder, "b.csv", "t [s],x [mm],F1 [N],F2 [N]\n0,1,2,3\n1,2,3,4\n2,3,4,5\n3,4,5,6\n"), folder.path());
  ASSERT_FALSE(two.ok());
  EXPECT_NE(two.error().message.find("--columns"), std::string::npos) << two.error().message;
  EXPECT_FALSE(offer_recording(folder.file("none.csv"), folder.path()).ok());
}

}  // namespace
}  // namespace palpate
