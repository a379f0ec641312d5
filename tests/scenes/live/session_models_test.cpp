// Models that a session fits itself, with its real threads.
#include "scenes/live/session_models.h"

#include <gtest/gtest.h>

#include <memory>

#include "scenes/live/live_session.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::frames_until;
using test::must;
using test::session_request;
using test::TemporaryFolder;

using Session = std::unique_ptr<LiveSession>;

// A session with fits: error figures relative to the material's true force, then a
// recording of the session that a fit accepts.
TEST(SessionModels, ItsRecordingCanBeFitted) {
  const TemporaryFolder folder;
  SessionRequest request = session_request("elastic_block", "hand", {"greedy", "random"});
  const Session session = must(LiveSession::open(request));
  ASSERT_EQ(session->models().size(), 3u);
  EXPECT_EQ(session->models().info(2).name, "direct") << "the reference, always";
  EXPECT_TRUE(test::has_parts(session->reference_words(), {"true force", "elastic"}));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().info(0).state == SlotState::ready; }));
  EXPECT_EQ(session->models().selected(), 0u) << "the first asked for";
  EXPECT_EQ(session->models().info(0).name, "greedy-100");
  EXPECT_EQ(session->models().info(0).centres, 100);
  ASSERT_TRUE(session->start_recording(folder.file("live.csv")).ok());
  ASSERT_TRUE(frames_until(
      *session, [&] { return session->figures(0).errors.samples > 500 && session->recording().seconds > 2.0; }));
  EXPECT_GT(session->figures(0).errors.within_jnd, 0.9);
  EXPECT_GT(session->figures(1).errors.samples, 500u);
  session->stop_recording();
  ASSERT_TRUE(frames_until(*session, [&] { return !session->recording().saving && !session->recording().active; }));
  const std::vector<Notice> notices = session->read_notices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_FALSE(notices[0].problem) << notices[0].text;
  const auto recording = std::make_shared<const Recording>(must(read_recording(folder.file("live.csv"))));
  EXPECT_TRUE(recording->columns.velocity);
  const PreparedTraining prepared = test::prepare({recording}, test::scene_request("elastic_block"));
  EXPECT_GT(test::judge(*recording, test::fit(prepared, &kRandomMethod)).within_jnd, 0.95);
}

// Several requests in sequence, as when a slider is dragged: the last one counts.
TEST(SessionModels, ModelsAreFittedAnewWithOtherCentres) {
  SessionRequest request = session_request("elastic_block", "hand", {"random-10"});
  const Session session = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_EQ(session->models().info(0).centres, 10);
  for (const int centres : {12, 14, 20}) session->models().refit(0, centres);
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().info(0).centres == 20; }));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_FALSE(session->models().info(0).refitting);
  EXPECT_EQ(session->models().info(0).name, "random-20");
}

// A recording of another material than that of the scene: errors are relative to the recording's material.
TEST(SessionModels, ARecordingIsTheMaterialThatIsFittedAndPressed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("mine.csv");
  ASSERT_TRUE(write_recording(path, *test::rig_recording(test::train_settings("elastic")), {}, false).ok());
  SessionRequest request = session_request("silicone_block", "hand", {"greedy", "trend"});
  request.recordings = {path};
  const Session session = must(LiveSession::open(request));
  EXPECT_EQ(session->scene().title, "mine");
  EXPECT_FALSE(session->has_reference(ReferenceKind::truth)) << "silicone is none of it";
  EXPECT_EQ(session->reference_words(), "no truth to compare with");
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_TRUE(test::has_parts(session->reference_words(), {"direct"}));
  EXPECT_EQ(session->models().selected(), 0u) << "the winner";
  ASSERT_TRUE(frames_until(*session, [&] { return session->figures(0).errors.samples > 1000; }));
  EXPECT_LT(session->figures(0).errors.p99_error_over_jnd, 1.0);

  request.recordings.clear();
  request.device = "replay:" + path;
  const Session replayed = must(LiveSession::open(request));
  EXPECT_EQ(replayed->scene().title, "mine");
  EXPECT_TRUE(test::has_parts(replayed->reference_words(), {"mine"}));
  ASSERT_TRUE(frames_until(*replayed, [&] { return replayed->models().all_settled(); }));
  ASSERT_TRUE(frames_until(*replayed, [&] { return replayed->figures(0).errors.samples > 1000; }));
  EXPECT_LT(replayed->figures(0).errors.p99_error_over_jnd, 1.0);
}

TEST(SessionModels, LineUpsShareTheModelsThatBothHave) {
  SessionRequest request = session_request("elastic_block", "hand", {});
  request.line_up = "Palpate";
  const Session session = must(LiveSession::open(request));
  EXPECT_EQ(session->line_up(), "Palpate");
  const std::size_t before = session->models().size();
  session->use_line_up("Ladder");
  // Three models by the paper's recipe are new; direct, voxel, greedy and trend exist already.
  EXPECT_EQ(session->models().size(), before + 3);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < session->models().size(); ++i)
    hidden += session->models().info(i).state == SlotState::hidden ? 1 : 0;
  EXPECT_EQ(hidden, 2u) << "random and kdtree";
  session->use_line_up("no such");
  EXPECT_EQ(session->line_up(), "Ladder");
}

}  // namespace
}  // namespace palpate
