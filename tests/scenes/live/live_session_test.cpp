// A whole session with its real threads, without a window.
#include "scenes/live/live_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "engine/tick/haptics_tick.h"
#include "models/model/file/model_io.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/material/rig.h"
#include "scenes/worker/model_worker.h"
#include "tests/support/example_model.h"
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

// Two model files and a recording, for sessions without fits.
class SessionOfFiles : public ::testing::Test {
 protected:
  SessionOfFiles() {
    a = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
    b = test::example_model("direct", KernelKind::cubic, test::maxwell_features(), 2);
    a.name = "first";
    b.name = "second";
    EXPECT_TRUE(save_model(folder.file("a.json"), a, false).ok());
    EXPECT_TRUE(save_model(folder.file("b.json"), b, false).ok());
    recording = test::example_recording(700, 1000.0, 30e-6);
    EXPECT_TRUE(write_recording(folder.file("played.csv"), recording, {}, false).ok());
  }
  SessionRequest of_files(const std::string& device) const {
    return session_request("skin", device, {folder.file("a.json"), folder.file("b.json")});
  }
  Session replaying() const { return must(LiveSession::open(of_files("replay:" + folder.file("played.csv")))); }

  TemporaryFolder folder;
  ModelData a, b;
  Recording recording;
};

void frames(LiveSession& session, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  frames_until(session, [&] { return std::chrono::steady_clock::now() > end; });
}

TEST(LiveSession, RefusesUnknownNames) {
  EXPECT_TRUE(
      test::has_parts(LiveSession::open(session_request("sponge", "hand", {})), {"\"sponge\"", "silicone_block"}));
  EXPECT_TRUE(test::has_parts(LiveSession::open(session_request("", "hand", {"nothing.json"})), {"\"nothing.json\""}));
  EXPECT_TRUE(test::has_parts(LiveSession::open(session_request("", "brush", {})), {"\"brush\""}));
  EXPECT_TRUE(test::has_parts(LiveSession::open(session_request("skin", "hand", {"greedy"})), {"\"skin\""}));
  EXPECT_TRUE(LiveSession::open(session_request("skin", "hand", {})).ok()) << "a session that waits for a file";
}

// The loop and replay give bit-identical forces for the same samples. The models
// join in mid-stream, so the comparison starts with the next round of the recording.
TEST_F(SessionOfFiles, GivesTheForcesOfReplayBitForBit) {
  const ForceModels models{std::make_shared<FittedModel>(a), std::make_shared<FittedModel>(b)};
  std::map<double, TickSnapshot> expected;
  replay(recording, models,
         [&](const RecordingRow& row, const TickSnapshot& tick, const HapticsTick&) { expected[row.time_s] = tick; });
  const Session session = replaying();
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  // Models join in the middle of a round. Waits for the next one.
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().tick.model_count == 2; }));
  double last_s = session->newest().tick.time_s;
  ASSERT_TRUE(frames_until(
      *session, [&] { return session->newest().tick.time_s < std::exchange(last_s, session->newest().tick.time_s); }));
  int compared = 0;
  for (int i = 0; i < 120; ++i) {
    session->update();
    const LoopSnapshot& newest = session->newest();
    if (newest.tick.model_count == 2) {
      const auto tick = expected.find(newest.tick.time_s);
      ASSERT_NE(tick, expected.end()) << "time " << newest.tick.time_s;
      ASSERT_EQ(newest.tick.force_N[0], tick->second.force_N[0]) << newest.tick.time_s;
      ASSERT_EQ(newest.tick.force_N[1], tick->second.force_N[1]) << newest.tick.time_s;
      EXPECT_EQ(session->figures(0).force_N, newest.tick.force_N[0]);
      ++compared;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GT(compared, 50);
}

TEST_F(SessionOfFiles, ComparesWithTheForceInTheRecording) {
  const Session session = replaying();
  EXPECT_EQ(session->comparison().reference(), ReferenceKind::measured);
  EXPECT_TRUE(test::has_parts(session->reference_words(), {"played"}));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_EQ(session->models().info(0).name, "first");
  EXPECT_EQ(session->models().info(1).method, "direct");
  ASSERT_TRUE(frames_until(*session, [&] { return session->figures(1).errors.samples > 300; }));
  EXPECT_GT(session->figures(0).errors.rms_error_N, 0.0);
  EXPECT_GT(session->figures(0).tick_ns(), 0.0);
  EXPECT_EQ(session->test_name(), "played");
}

// A model that the session fits to a recording, saved to a file.
void fit_to(const Recording& recording, const TemporaryFolder& folder, const std::string& file) {
  Scene scene = must(load_scene("silicone_block"));
  scene.recordings = {"example"};
  ModelWorker worker(scene, 1, {recording});
  const auto model = must(worker.make({must(parse_plan("trend"))}));
  EXPECT_TRUE(save_model(folder.file(file), model->data(), false).ok());
}

TEST_F(SessionOfFiles, MovesTheSurfaceOfARecordingToThatOfTheModels) {
  Recording training = test::example_recording(3000, 1000.0, 30e-6);
  fit_to(training, folder, "fitted.json");
  for (RecordingRow& row : training.rows) row.position_m += 0.3e-3, row.force_N += 0.18;
  ASSERT_TRUE(write_recording(folder.file("shifted.csv"), training, {}, false).ok());
  SessionRequest request = of_files("replay:" + folder.file("shifted.csv"));
  request.models = {folder.file("fitted.json")};
  const Session session = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*session, [&] { return session->test().found_m() != 0.0; }));
  EXPECT_NEAR(session->test().found_m(), 0.3e-3, 0.02e-3);
  EXPECT_NEAR(session->test().force_zero_N(), 0.18, 0.005);
  ASSERT_TRUE(frames_until(*session, [&] { return session->verdict().chosen.has_value(); }));
  EXPECT_TRUE(test::has_parts(session->verdict().detail, {"The test is shifted, its forces counted from the "}));
  EXPECT_EQ(session->replay()->surface_offset_m(), 0.0) << "as recorded, as in a report";
  ASSERT_TRUE(frames_until(*session, [&] { return session->figures(0).errors.samples > 300; }));
  const double recorded_N = session->figures(0).errors.rms_error_N;

  session->move_surface(true);
  EXPECT_EQ(session->comparison().figures(0).errors.samples, 0u) << "figures of ticks begin anew";
  EXPECT_EQ(session->replay()->surface_offset_m(), session->test().found_m());
  // 0.3 mm at 300 N/m are 90 mN.
  EXPECT_GT(recorded_N, 3.0 * session->figures(0).errors.rms_error_N);
}

// The window and a report name the same model on the same recording.
TEST_F(SessionOfFiles, RecommendsTheModelThatAReportRecommends) {
  Recording shifted = test::example_recording(3000, 1000.0, 30e-6);
  fit_to(shifted, folder, "elsewhere.json");
  for (RecordingRow& row : shifted.rows) row.position_m += 0.3e-3;
  fit_to(shifted, folder, "here.json");
  ASSERT_TRUE(write_recording(folder.file("shifted.csv"), shifted, {}, false).ok());
  SessionRequest request = of_files("replay:" + folder.file("shifted.csv"));
  request.models = {folder.file("a.json"), folder.file("elsewhere.json"), folder.file("here.json")};
  const Session session = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*session, [&] { return session->test().complete() && session->verdict().chosen; }));
  std::vector<EvaluatedModel> models;
  for (std::size_t i = 0; i < 3; ++i) models.push_back({session->models().model(i), session->jnd()});
  const Recording replayed = must(read_recording(folder.file("shifted.csv")));
  const auto evaluation = must(evaluate(replayed, models));
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < 3; ++i) {
    const ErrorSummary errors = evaluation.models[i].as_recorded.summary();
    EXPECT_EQ(session->figures(i).errors.p99_error_over_jnd, errors.p99_error_over_jnd) << i;
    candidates.push_back({errors.within_jnd, errors.p99_error_over_jnd, session->figures(i).tick_ns()});
  }
  EXPECT_EQ(rank(candidates).recommended, 2u);
  EXPECT_EQ(session->verdict().chosen, 2u);
}

TEST_F(SessionOfFiles, LoadsAFileAndKeepsTheChoice) {
  SessionRequest request = of_files("hand");
  request.models = {folder.file("a.json")};
  const Session session = must(LiveSession::open(request));
  session->models().select(0);
  EXPECT_EQ(session->models().info(0).state, SlotState::waiting);
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_EQ(session->comparison().reference(), ReferenceKind::model);
  EXPECT_EQ(session->reference_words(), "no truth to compare with");
  EXPECT_TRUE(std::isnan(session->comparison().reference_in(session->newest())));
  ModelData other = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 3);
  other.name = "first";
  ASSERT_TRUE(save_model(folder.file("c.json"), other, false).ok());
  session->models().load_file(folder.file("b.json"));
  session->models().load_file(folder.file("c.json"));
  session->models().load_file(folder.with_file("bad.json", "{\"format\": 3}"));
  ASSERT_EQ(session->models().size(), 3u);
  session->update();
  EXPECT_EQ(session->models().info(2).name, "first-2") << "names are distinct";
  EXPECT_EQ(session->models().selected(), 0u);
  const std::vector<Notice> notices = session->read_notices();
  ASSERT_EQ(notices.size(), 3u);
  EXPECT_FALSE(notices[0].problem);
  EXPECT_TRUE(notices[2].problem);
  EXPECT_TRUE(test::has_parts(notices[2].text, {"bad.json"}));
  EXPECT_TRUE(session->read_notices().empty());
  session->models().select(2);
  session->models().select(9);
  EXPECT_EQ(session->models().selected(), 2u);
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().selected == 2 && !session->newest().fading; }));
  EXPECT_TRUE(test::has_parts(session->reference_words(), {"first"})) << "there is one now";
  // The first points have no force of models that were added later.
  EXPECT_TRUE(std::isnan(session->comparison().history()[0].force_N[2]));
  EXPECT_FALSE(std::isnan(session->comparison().history()[session->comparison().history().size() - 1].force_N[2]));
}

TEST_F(SessionOfFiles, ARemovedModelFreesItsSlotButTheLastOneStays) {
  SessionRequest request = of_files("hand");
  request.models.clear();
  for (std::size_t i = 0; i < kMaxModels; ++i) {
    const std::string file = folder.file("m" + std::to_string(i) + ".json");
    const ModelData one = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 10 + i);
    ASSERT_TRUE(save_model(file, one, false).ok());
    request.models.push_back(file);
  }
  const Session session = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*session, [&] { return session->models().all_settled(); }));
  EXPECT_FALSE(session->models().load_file(folder.file("b.json"))) << "the loop takes no more";
  EXPECT_TRUE(session->read_notices().back().problem);
  session->models().remove(5);
  EXPECT_TRUE(session->models().load_file(folder.file("b.json"))) << "in its place";
  frames(*session, 0.1);
  EXPECT_EQ(session->models().size(), kMaxModels);
  EXPECT_EQ(session->models().info(5).name, "second");
  const ForceHistory& history = session->comparison().history();
  EXPECT_TRUE(std::isnan(history[0].force_N[5])) << "no curve of the model that was there";
  for (std::size_t i = 1; i < kMaxModels; ++i) session->models().remove(i);
  session->models().remove(0);
  EXPECT_EQ(session->models().info(0).state, SlotState::ready) << "there must be one to press";
}

// The simulated hand stays in the recorded range of depth and speed, so that its samples count.
TEST(LiveSession, TheHandStaysInTheRecordedRange) {
  const test::TemporaryFolder folder;
  Recording slow = must(record_sensors({.material = "elastic"}));
  for (RecordingRow& row : slow.rows) {
    row.time_s *= 5.0;
    row.velocity_m_per_s /= 5.0;
    row.acceleration_m_per_s2 /= 25.0;
  }
  const std::string path = folder.file("slow.csv");
  ASSERT_TRUE(write_recording(path, slow, {}, false).ok());
  SessionRequest request = session_request("elastic_block", "hand", {"trend"});
  request.recordings = {path};
  const Session session = must(LiveSession::open(request));
  const ForceHistory& history = session->comparison().history();
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().tick.model_count == 1 && history.size() > 8000; }));
  double deepest_m = 0.0;
  for (std::size_t i = 0; i < history.size(); ++i) {
    // Until the model is fitted nothing pushes the hand back.
    if (!std::isnan(history[i].force_N[0])) deepest_m = std::max(deepest_m, static_cast<double>(history[i].position_m));
  }
  const auto recorded = std::ranges::max_element(slow.rows, {}, &RecordingRow::position_m);
  EXPECT_LT(deepest_m, 1.02 * recorded->position_m);
}

// The zero of the positions may be anywhere, also deep inside the block.
TEST_F(SessionOfFiles, TheHandPressesNoHarderThanARecordingAtNegativePositions) {
  Recording negative = must(record_sensors({.material = "elastic"}));
  for (RecordingRow& row : negative.rows) {
    row.position_m -= 0.1;
    row.force_N *= 0.1;  // weaker than the usual press of the scene
  }
  ASSERT_TRUE(write_recording(folder.file("negative.csv"), negative, {}, false).ok());
  SessionRequest request = of_files("hand");
  request.recordings = {folder.file("negative.csv")};
  const Session session = must(LiveSession::open(request));
  const auto strongest = std::ranges::max_element(negative.rows, {}, &RecordingRow::force_N);
  EXPECT_LE(session->scene().strongest_press_N, strongest->force_N);
}

TEST_F(SessionOfFiles, ClosingCompletesTheRecording) {
  {
    const Session session = replaying();
    ASSERT_TRUE(session->start_recording(folder.file("live.csv")).ok());
    ASSERT_TRUE(frames_until(*session, [&] { return session->recording().rows > 200; }));
  }
  const Recording live = must(read_recording(folder.file("live.csv")));
  EXPECT_GT(live.rows.size(), 200u);
}

// The true force belongs to one material; a model file names the material that it was fitted to.
TEST_F(SessionOfFiles, AModelOfSomethingElseIsNotComparedWithTheTruth) {
  SessionRequest request = of_files("hand");
  request.scene.clear();
  const Session alone = must(LiveSession::open(request));
  EXPECT_EQ(alone->comparison().reference(), ReferenceKind::model);
  EXPECT_EQ(alone->models().size(), 2u) << "nothing is fitted beside";
  ASSERT_TRUE(frames_until(*alone, [&] { return alone->models().all_settled(); }));
  EXPECT_TRUE(test::has_parts(alone->reference_words(), {"first"}));

  request.scene = "elastic_block";
  request.models = {"trend"};
  const Session beside = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*beside, [&] { return beside->models().all_settled(); }));
  beside->models().load_file(folder.file("a.json"));
  ASSERT_TRUE(frames_until(*beside, [&] { return beside->models().all_settled(); }));
  const std::size_t loaded = beside->models().size() - 1;
  EXPECT_TRUE(beside->models().info(loaded).other_material);
  ASSERT_TRUE(frames_until(*beside, [&] { return beside->figures(0).errors.samples > 100; }));
  EXPECT_EQ(beside->figures(loaded).errors.samples, 0u);
  beside->models().treat_as_this_material(loaded);
  EXPECT_TRUE(beside->models().requests().at(loaded).of_this_material) << "in the next session, too";
  ASSERT_TRUE(frames_until(*beside, [&] { return beside->figures(loaded).errors.samples > 100; }));

  // A model that this session fitted and saved is of this material.
  ASSERT_TRUE(beside->models().save(0, folder.file("own.json")).ok());
  beside->models().load_file(folder.file("own.json"));
  ASSERT_TRUE(frames_until(*beside, [&] { return beside->models().all_settled(); }));
  EXPECT_FALSE(beside->models().info(beside->models().size() - 1).other_material);
  EXPECT_EQ(beside->models().info(beside->models().size() - 1).state, SlotState::equal) << "it is there already";

  // A model that the next session keeps stays one of another material, although its scene was named.
  request.kept = {{.plan = {}, .path = folder.file("a.json"), .loaded = must(load_model(folder.file("a.json")))}};
  const Session next = must(LiveSession::open(request));
  ASSERT_TRUE(frames_until(*next, [&] { return next->models().all_settled(); }));
  EXPECT_TRUE(next->models().info(next->models().size() - 1).other_material);
}

// A paused replay adds no samples, and single steps count like a running replay.
TEST_F(SessionOfFiles, APausedReplayCountsNothingAndAStepOneSample) {
  const Session session = replaying();
  ASSERT_TRUE(frames_until(*session, [&] { return session->comparison().figures(0).errors.samples > 300; }));
  session->replay()->pause(true);
  frames(*session, 0.1);
  const std::uint64_t counted = session->comparison().figures(0).errors.samples;
  const std::size_t shown = session->comparison().history().size();
  frames(*session, 0.2);
  EXPECT_EQ(session->comparison().figures(0).errors.samples, counted);
  EXPECT_EQ(session->comparison().history().size(), shown);
  session->replay()->step(1);
  ASSERT_TRUE(frames_until(*session, [&] { return session->comparison().history().size() > shown; }));
  const ForceHistory& history = session->comparison().history();
  EXPECT_NEAR(history[shown].time_s - history[shown - 1].time_s, 1e-3, 1e-9) << "of the recording, not of the clock";
}

}  // namespace
}  // namespace palpate
