// The sentences of the panels from plain views: no session, no thread, no device.
#include <gtest/gtest.h>

#include "rendering/panels/panel_errors.h"
#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"
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
  EXPECT_EQ(health_words(health, 20.0).text, "20 frames a second: a slow picture, the force is not affected");
  health.loop.ticks = 5000;
  health.loop.missed_deadlines = 41;
  EXPECT_EQ(health_words(health, 20.0).text, "20 frames a second: a slow picture, 41 deadlines missed");
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
  health.stiffness_share = 0.5;
  EXPECT_NE(device_line(health).find("50 % of the stiffness"), std::string::npos) << "a late line is said";
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

// One number: the table's, of the same samples, and of whom and than what it is.
TEST(PanelWords, TheBigNumberIsTheTablesAndSaysOfWhom) {
  SlotView greedy = ready_slot("greedy-100");
  ModelsView models{{&greedy}, 0, true};
  EXPECT_EQ(big_number(models, {}).number, "–");
  EXPECT_EQ(big_number(models, {}).below, "greedy-100 off the material: from the next touch on");
  for (int i = 0; i < 1000; ++i) {
    greedy.errors.add(1.0 + 0.25 * JndLine{}.at(1.0), 1.0, false, {});
    greedy.quantile.add(0.25);
  }
  EXPECT_EQ(big_number(models, {}).number, "0.25");
  EXPECT_EQ(big_number(models, {}).number, jnd_text(greedy.quantile.p99()));
  EXPECT_EQ(big_number(models, {}).below, "greedy-100 off the material, 99 % of the time");
  models.in_contact = false;
  EXPECT_EQ(big_number(models, {}).number, "0.25") << "in the air it says the same";
  EXPECT_EQ(counted_words(models), "1,000 samples in contact since the start");
  models.reference = 0;
  EXPECT_EQ(big_number(models, {}).number, "–") << "it is the reference";
}

TEST(PanelWords, WithoutATruthTheBigNumberSaysSo) {
  SlotView greedy = ready_slot("greedy-100");
  ModelsView models{{&greedy}, 0, true};
  // What the model predicts of itself, of 0.13 N at 1 N.
  models.compared = false;
  models.off_from = "no truth to compare with";
  EXPECT_EQ(big_number(models, {}).number, "–") << "it does not know";
  greedy.force_N = 1.0;
  greedy.predicted_error_N = 0.5 * JndLine{}.at(1.0);
  EXPECT_EQ(big_number(models, {}).number, "0.50");
  EXPECT_EQ(big_number(models, {}).below, "greedy-100's own guess (95 %); no truth to compare with");
  models.in_contact = false;
  EXPECT_EQ(big_number(models, {}).number, "–");
  EXPECT_EQ(big_number({}, {}).number, "–");
  models.compared = true;
  greedy.foreign = true;
  EXPECT_EQ(big_number(models, {}).below, "no truth to compare greedy-100 with");
}

SlotView judged_slot(const char* name, double share, double tick_ns) {
  SlotView slot = ready_slot(name);
  slot.tick_ns = tick_ns;
  for (int i = 0; i < 1000; ++i) {
    const double ratio = i < 1000.0 * share ? 0.5 : 2.0;
    slot.errors.add(1.0 + ratio * JndLine{}.at(1.0), 1.0, false, {});
    slot.quantile.add(ratio);
  }
  return slot;
}

TEST(PanelWords, TheVerdictIsOneSentenceFromTheTablesNumbers) {
  const SlotView greedy = judged_slot("greedy-100", 1.0, 612.0);
  const SlotView direct = judged_slot("direct", 0.999, 3900.0);
  const SlotView random = judged_slot("random-10 '09", 0.4, 330.0);
  ModelsView models{{&random, &direct, &greedy}, 0, true};
  EXPECT_EQ(verdict_words(models),
            "greedy-100: 100 % unnoticeable at 0.61 us a tick; direct the same at 3.9 us; random-10 '09 40 %");
  models.slots = {&random};
  EXPECT_EQ(verdict_words(models), "None is unnoticeable. random-10 '09: 40 % unnoticeable at 0.33 us a tick");
  const SlotView fresh = ready_slot("fresh");
  models.slots = {&fresh};
  EXPECT_EQ(verdict_words(models), "The verdict comes with the first samples in contact.");
  models.compared = false;
  models.off_from = "no truth to compare with";
  EXPECT_EQ(verdict_words(models), "no truth to compare with");
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
