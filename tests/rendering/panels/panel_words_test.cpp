// The sentences of the panels from plain views: no session, no thread, no device.
#include <gtest/gtest.h>

#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/scene_overlay.h"

namespace palpate {
namespace {

SlotView ready_slot(const char* name) {
  SlotView slot;
  slot.name = name;
  slot.state = SlotState::ready;
  return slot;
}

TEST(PanelWords, AStalledLoopComesBeforeAllElse) {
  HealthView health;
  health.loop.ticks = 10;
  health.loop.age_s = 0.3;
  health.device.faults = device_fault::kUnplugged;
  const HealthWords words = health_words(health, 60.0);
  EXPECT_EQ(words.text, "The loop stands still: last tick 0.3 s ago, the tool gets no new force");
  EXPECT_TRUE(words.problem);
}

TEST(PanelWords, AlarmsThatAreOverAreCounted) {
  HealthView health;
  health.alarms = {"the encoder jumped", "a tick was late"};
  const HealthWords words = health_words(health, 60.0);
  EXPECT_EQ(words.text, "Earlier: the encoder jumped (and 1 more)");
  EXPECT_TRUE(words.problem && words.past);
}

TEST(PanelWords, MissedDeadlinesAndSlowPicturesAreNamed) {
  HealthView health;
  EXPECT_FALSE(health_words(health, 20.0).problem) << "nothing that is felt is late";
  EXPECT_EQ(health_words(health, 20.0).text, "20 frames a second: the picture is slow, the force is not affected");
  health.missed_of_late = 0.025;
  EXPECT_EQ(health_words(health, 20.0).text,
            "2.5 % of the deadlines missed of late: close other programs, or allow real-time priority");
  health.scheduling.realtime = true;
  EXPECT_EQ(health_words(health, 20.0).text, "2.5 % of the deadlines missed of late: close other programs");
  health.missed_of_late = 0.0;
  EXPECT_FALSE(health_words(health, 0.0).problem);
}

TEST(PanelWords, OnlyAZeroedDeviceHasALine) {
  HealthView health;
  EXPECT_EQ(device_line(health), "");
  health.device_name = "hid";
  health.device.zeroing = Zeroing::done;
  health.device.sample_age_s = 0.0012;
  health.device.round_trip_s = 0.0021;
  health.heat_share = 0.4;
  EXPECT_EQ(device_line(health), "hid: sample 1.2 ms old, round trip 2.1 ms, motor heat 40 %");
}

TEST(PanelWords, AModelThatIsNotReadyTellsHowFarItIs) {
  SlotView slot;
  EXPECT_EQ(waiting_words(slot), "waits");
  slot.state = SlotState::fitting;
  slot.progress = 0.4;
  EXPECT_EQ(waiting_words(slot), "fits 40 %");
  slot.state = SlotState::failed;
  EXPECT_EQ(waiting_words(slot), "failed");
}

TEST(PanelWords, WarnsOutOfDomainOnlyInContactAndOfTheActiveModel) {
  SlotView greedy = ready_slot("greedy-100");
  SlotView direct = ready_slot("direct");
  greedy.out_of_domain = true;
  ModelsView models{{&greedy, &direct}, 0, false};
  EXPECT_EQ(data_warning(models), "");
  models.in_contact = true;
  EXPECT_EQ(data_warning(models), "Nothing like this was recorded: here greedy-100 only follows the trend");
  models.selected = 1;
  EXPECT_EQ(data_warning(models), "");
}

TEST(PanelWords, TheBigNumberSaysWhatItIs) {
  SlotView greedy = ready_slot("greedy-100");
  greedy.recent_peak_error_over_jnd = 0.25;
  ModelsView models{{&greedy}, 0, true};
  EXPECT_EQ(big_number(models, {}).number, "0.25");
  EXPECT_EQ(big_number(models, {}).below, "the error of the active model");
  // Nothing to compare with: what the model predicts of itself, of 0.13 N at 1 N.
  models.compared = false;
  EXPECT_EQ(big_number(models, {}).number, "–") << "it does not know";
  greedy.force_N = 1.0;
  greedy.predicted_error_N = 0.5 * JndLine{}.at(1.0);
  EXPECT_EQ(big_number(models, {}).number, "0.50");
  EXPECT_EQ(big_number(models, {}).below, "predicted for the active model (95 %)");
  models.in_contact = false;
  EXPECT_EQ(big_number(models, {}).number, "–");
  EXPECT_EQ(big_number({}, {}).number, "–");
}

TEST(PanelWords, BeforeTheFirstModelTheFitIsTheNumber) {
  SlotView trend;
  trend.name = "trend";
  trend.state = SlotState::fitting;
  trend.progress = 0.34;
  const BigNumber big = big_number({{&trend}, 0, true}, {});
  EXPECT_EQ(big.number, "34 %");
  EXPECT_EQ(big.what, "of the first model, trend:");
}

TEST(PanelWords, ARecordingTellsItsLength) {
  RecordingStatus recording;
  EXPECT_EQ(recording_words(recording), "");
  recording.path = "/tmp/session.csv";
  recording.active = true;
  recording.seconds = 2.5;
  recording.rows = 2500;
  EXPECT_EQ(recording_words(recording), "recording session.csv: 2.5 s, 2500 samples");
  recording.active = false;
  recording.saving = true;
  EXPECT_EQ(recording_words(recording), "saving session.csv");
}

}  // namespace
}  // namespace palpate
