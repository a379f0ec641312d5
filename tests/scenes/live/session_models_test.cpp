// Models that a session fits itself, with its real threads.
#include "scenes/live/session_models.h"

#include <gtest/gtest.h>

#include <memory>

#include "scenes/live/live_session.h"
#include "scenes/material/rig.h"
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

// A session with fits: error figures relative to the material's true force, then a recording of the session that can be
// fitted.
TEST(SessionModels, ItsRecordingCanBeFitted) {
  const TemporaryFolder folder;
  SessionRequest request = session_request("elastic_block", "hand", {"greedy-20", "random-20"});
  const Session session = must(LiveSession::open(request));
  ASSERT_EQ(session->models().size(), 2u);
  EXPECT_TRUE(test::has_parts(session->reference_words(), {"true force", "elastic"}));
  ASSERT_TRUE(frames_until(*session, [&] { return session->verdict().chosen.has_value(); }));
  EXPECT_EQ(session->models().info(0).name, "greedy-20");
  EXPECT_EQ(session->models().info(0).centres, 20);
  EXPECT_TRUE(session->models().info(0).paper);
  EXPECT_EQ(session->models().selected(), *session->verdict().chosen) << "the model of the headline";
  const LiveSession::StartTimes times = session->start_times();
  EXPECT_LE(times.first_model_s, times.all_models_s);
  EXPECT_LE(times.all_models_s, times.verdict_s);
  ASSERT_TRUE(session->start_recording(folder.file("live.csv")).ok());
  ASSERT_TRUE(frames_until(*session, [&] {
    return session->comparison().figures(0).errors.samples > 500 && session->recording().seconds > 2.0;
  }));
  EXPECT_GT(session->figures(0).errors.within_jnd, 0.9);
  EXPECT_EQ(session->figures(0).errors.samples, session->figures(1).errors.samples);
  session->stop_recording();
  ASSERT_TRUE(frames_until(*session, [&] { return !session->recording().saving && !session->recording().active; }));
  const std::vector<Notice> notices = session->read_notices();
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_FALSE(notices[0].problem) << notices[0].text;
  const Recording recording = must(read_recording(folder.file("live.csv")));
  EXPECT_TRUE(recording.columns.velocity);
  ModelWorker worker(session->scene(), 1, {recording});
  EXPECT_TRUE(worker.make({must(parse_plan("random-20"))}).ok());
}

// The verdict is that of fixed strokes: a hand that holds still, or presses otherwise, does not turn it.
TEST(SessionModels, TheVerdictDoesNotDependOnWhatIsPressed) {
  const Session session = must(LiveSession::open(session_request("elastic_block", "mouse", {"random-3", "trend"})));
  ASSERT_TRUE(frames_until(*session, [&] { return session->verdict().chosen.has_value(); }));
  const std::string headline = session->verdict().headline;
  const std::uint64_t samples = session->figures(0).errors.samples;
  EXPECT_GT(samples, 1000u) << "nobody has pressed";
  session->tool_input()->set_target(0.004, session->newest().loop_time_s);
  ASSERT_TRUE(frames_until(*session, [&] { return session->comparison().figures(0).errors.samples > 300; }));
  session->reset_figures();
  EXPECT_EQ(session->comparison().figures(0).errors.samples, 0u);
  EXPECT_EQ(session->figures(0).errors.samples, samples);
  EXPECT_EQ(session->verdict().headline, headline);
}

// The moment of the largest error, of the test and of this session, with the ticks around it.
TEST(SessionModels, TheWorstMomentIsFoundAndSaid) {
  const Session session = must(LiveSession::open(session_request("elastic_block", "mouse", {"random-3", "trend"})));
  ASSERT_TRUE(frames_until(*session, [&] { return session->verdict().chosen.has_value(); }));
  const auto of_test = session->worst(0, true, 100.0);
  ASSERT_TRUE(of_test);
  EXPECT_NE(of_test->words.find(" mm"), std::string::npos) << of_test->words;
  const ForceHistory& history = *of_test->history;
  const HistoryPoint& worst = *history.last_until(of_test->at_s);
  EXPECT_GE(worst.loop_time_s, 100.0);
  float largest = 0.0F;
  for (std::size_t i = 0; i < history.size(); ++i)
    if (history[i].in_contact) largest = std::max(largest, std::abs(history[i].sustained_over_jnd[0]));
  EXPECT_EQ(std::abs(worst.sustained_over_jnd[0]), largest);
  EXPECT_FALSE(std::isnan(worst.force_N[1])) << "all models are there";
  EXPECT_FALSE(session->worst(0, false, 100.0)) << "nothing was pressed";
  session->tool_input()->set_target(0.004, session->newest().loop_time_s);
  ASSERT_TRUE(frames_until(*session, [&] { return session->comparison().figures(0).errors.samples > 300; }));
  const auto of_session = session->worst(0, false, 100.0);
  ASSERT_TRUE(of_session);
  EXPECT_FALSE(of_session->history);
  const HistoryPoint& now = *session->comparison().history().last_until(of_session->at_s);
  EXPECT_GE(now.press_over_jnd[0], std::abs(now.sustained_over_jnd[0]));
}

TEST(SessionModels, AModelIsAddedByItsNameAndTakenOutBeforeItIsFitted) {
  const Session session = must(LiveSession::open(session_request("elastic_block", "hand", {"random-3"})));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  session->models().add("random-5");
  session->models().add("greedy-200");
  session->models().remove(2);
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_EQ(session->models().info(1).name, "random-5");
  EXPECT_EQ(session->models().ready_slots(), (std::vector<std::size_t>{0, 1}));
  session->models().add("random-5");
  EXPECT_EQ(session->models().ready_slots().size(), 2u) << "it is there already";
}

// Several requests in sequence, as when a slider is dragged: the last one counts. The tested sizes make a path.
TEST(SessionModels, ModelsAreFittedAnewWithOtherCentres) {
  const Session session = must(LiveSession::open(session_request("elastic_block", "hand", {"random-10"})));
  ASSERT_TRUE(frames_until(*session, [&] { return session->figures(0).path.contains(10); }));
  EXPECT_EQ(session->models().info(0).centres, 10);
  for (const int centres : {12, 14, 20}) session->models().refit(0, centres);
  ASSERT_TRUE(frames_until(
      *session, [&] { return session->models().info(0).centres == 20; },
      [&] { EXPECT_FALSE(session->models().info(0).refitting && session->verdict().chosen) << "the headline waits"; }));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_FALSE(session->models().info(0).refitting);
  EXPECT_EQ(session->models().info(0).name, "random-20");
  ASSERT_TRUE(frames_until(*session, [&] { return session->figures(0).path.contains(20); }));
}

// A single recording: its end is set apart, and replayed if the recording is. Back in the hand the test stays.
TEST(SessionModels, TheEndOfASingleRecordingIsTheTest) {
  const TemporaryFolder folder;
  const std::string path = folder.file("mine.csv");
  const Recording mine = must(record_sensors({.material = "elastic", .seed = 3, .seconds = 20.0}));
  ASSERT_TRUE(write_recording(path, mine, {}, false).ok());
  SessionRequest request = session_request("silicone_block", "replay:" + path, {"random-20", "trend"});
  const Session replayed = must(LiveSession::open(request));
  EXPECT_EQ(replayed->scene().title, "mine");
  EXPECT_LT(replayed->replay()->duration_s(), 0.41 * 20.0);
  EXPECT_FALSE(replayed->tests_training());
  EXPECT_EQ(replayed->read_notices().size(), 1u) << "it says so";
  ASSERT_TRUE(frames_until(*replayed, [&] { return replayed->verdict().chosen.has_value(); }));
  EXPECT_TRUE(test::has_parts(replayed->verdict().detail, {"mine, last", "no model was fitted to"}));
  EXPECT_LT(replayed->figures(1).errors.p99_error_over_jnd, 1.0);

  SessionRequest hand = request;
  hand.device = "hand";
  hand.recordings = replayed->scene().recordings;
  hand.test = replayed->test_file();
  hand.kept = replayed->models().requests();
  hand.refits = false;
  hand.models.clear();
  const Session pressed = must(LiveSession::open(hand));
  EXPECT_EQ(pressed->comparison().reference(), ReferenceKind::model) << "silicone is none of it";
  ASSERT_TRUE(frames_until(*pressed, [&] { return pressed->verdict().chosen.has_value(); }));
  EXPECT_EQ(pressed->figures(1).errors.samples, replayed->figures(1).errors.samples);
}

// Without a correction, a correction by any method is the trend: one row, which says so.
TEST(SessionModels, ModelsOfEqualForcesAreOneRow) {
  const TemporaryFolder folder;
  const Session session = must(LiveSession::open(session_request("elastic_block", "hand", {"trend", "random-20"})));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_EQ(session->models().ready_slots().size(), 2u);
  // A saved model comes back as what it is, and is not a second row.
  ASSERT_TRUE(session->models().save(1, folder.file("own.json")).ok());
  EXPECT_TRUE(session->models().load_file(folder.file("own.json")));
  session->update();
  EXPECT_EQ(session->models().info(2).state, SlotState::equal);
  EXPECT_EQ(session->models().info(2).method, "random");
  EXPECT_TRUE(session->models().info(2).paper);
  EXPECT_EQ(session->models().ready_slots().size(), 2u);
}

TEST(SessionModels, LineUpsShareTheModelsThatBothHave) {
  SessionRequest request = session_request("elastic_block", "hand", {});
  request.line_up = "Sizes";
  const Session session = must(LiveSession::open(request));
  EXPECT_EQ(session->line_up(), "Sizes");
  const std::size_t before = session->models().size();
  session->use_line_up("Comparison");
  EXPECT_EQ(session->models().size(), before + 4) << "greedy-100 exists already";
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < session->models().size(); ++i)
    hidden += session->models().info(i).state == SlotState::hidden ? 1 : 0;
  EXPECT_EQ(hidden, 4u);
  session->use_line_up("no such");
  EXPECT_EQ(session->line_up(), "Comparison");
}

}  // namespace
}  // namespace palpate
