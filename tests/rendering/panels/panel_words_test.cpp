// The texts of the panels from plain views, without session, threads or device.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "rendering/panels/panel.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

ModelView ready_slot(const char* name) {
  ModelView slot;
  slot.name = name;
  slot.state = SlotState::ready;
  return slot;
}

ModelsView view_of(std::vector<ModelView> slots, bool in_contact) {
  ModelsView models;
  models.slots = std::move(slots);
  models.now.in_contact = in_contact;
  return models;
}

TEST(PanelWords, AStallComesBeforeAFaultAndAFaultBeforeAlarmsThatAreOver) {
  HealthView health;
  health.loop.ticks = 10;
  health.loop.age_s = 0.3;
  health.newest.device.faults = device_fault::kUnplugged;
  health.alarms = {"the encoder jumped", "a tick was late"};
  const HealthWords stalled = health_words(health, 60.0, true);
  EXPECT_TRUE(test::has_parts(stalled.text, {"last tick 0.3 s"}));
  EXPECT_TRUE(stalled.problem && !stalled.past);
  health.loop.age_s = 0.0;
  const HealthWords unplugged = health_words(health, 60.0, true);
  EXPECT_TRUE(test::has_parts(unplugged.text, {device_fault_words(device_fault::kUnplugged).front()}));
  EXPECT_TRUE(unplugged.problem && !unplugged.past);
  health.newest.device.faults = 0;
  const HealthWords over = health_words(health, 60.0, true);
  EXPECT_TRUE(test::has_parts(over.text, {"the encoder jumped", "1 more"}));
  EXPECT_TRUE(over.problem && over.past);
}

TEST(PanelWords, MissedDeadlinesAndSlowPicturesAreNamed) {
  HealthView health;
  EXPECT_EQ(health_words(health, 20.0, true).text.find("frames"), std::string::npos) << "the start";
  health.loop.ticks = 20000;
  EXPECT_FALSE(health_words(health, 20.0, true).problem) << "nothing that is felt is late";
  EXPECT_TRUE(test::has_parts(health_words(health, 20.0, true).text, {"20 frames"}));
  health.loop.missed_deadlines = 41;
  EXPECT_TRUE(test::has_parts(health_words(health, 20.0, true).text, {"20 frames", "41 deadlines"}));
  health.missed_of_late = 0.025;
  EXPECT_FALSE(health_words(health, 20.0, false).problem) << "a visitor cannot change it";
  EXPECT_TRUE(test::has_parts(health_words(health, 20.0, true).text, {"2.5 %", "real-time priority"}));
  health.scheduling.realtime = true;
  EXPECT_EQ(health_words(health, 20.0, true).text.find("real-time priority"), std::string::npos);
  health.missed_of_late = 0.0;
  EXPECT_FALSE(health_words(health, 0.0, true).problem);
}

TEST(PanelWords, OnlyAZeroedDeviceHasALine) {
  HealthView health;
  EXPECT_EQ(device_line(health), "");
  health.device_name = "hid";
  health.newest.device.zeroing = Zeroing::done;
  health.newest.device.sample_age_s = 0.0012;
  health.newest.delay_ms = 2.1F;
  health.newest.heat_share = 0.4F;
  EXPECT_TRUE(test::has_parts(device_line(health), {"hid", "1.2 ms", "2.1 ms", "40 %"}));
  health.newest.stiffness_share = 0.5F;
  EXPECT_TRUE(test::has_parts(device_line(health), {"50 %"}));
}

TEST(PanelWords, WarnsOutOfDomainOnlyInContactAndOfTheActiveModel) {
  ModelsView models = view_of({ready_slot("greedy-100"), ready_slot("direct")}, false);
  models.slots[0].out_of_domain = true;
  EXPECT_EQ(data_warning(models), "");
  models.now.in_contact = true;
  EXPECT_NE(data_warning(models).find("greedy-100"), std::string::npos);
  models.replays_training = true;
  EXPECT_EQ(data_warning(models), "") << "it was trained on this recording";
  models.replays_training = false;
  models.selected = 1;
  EXPECT_EQ(data_warning(models), "");
}

// One block of numbers for the selected model: of the test, and of the press that is seen.
TEST(PanelWords, TheBigNumberIsThatOfTheSelectedModel) {
  ModelsView models = view_of({ready_slot("greedy-100"), ready_slot("trend")}, true);
  EXPECT_EQ(big_number(models).number, "–") << "not known yet";
  models.test_name = "another press";
  models.slots[0].errors.samples = 100;
  models.slots[0].errors.p99_error_over_jnd = 0.824;
  models.slots[1].errors.p99_error_over_jnd = 3.83;
  models.verdict.chosen = 1;
  EXPECT_EQ(big_number(models).number, "0.82");
  EXPECT_EQ(big_number(models).what, "of a JND in 99 % of the test: greedy-100");
  EXPECT_EQ(big_number(models).below, "") << "nothing was pressed";
  models.now.press_over_jnd[0] = 1.23F;
  EXPECT_EQ(big_number(models).below, "1.2 in this press");
  models.slots[0].refitting = true;
  EXPECT_EQ(big_number(models).number, "–") << "the figure is of the model before";
  models.slots[0].refitting = false;
  models.reference = 0;
  EXPECT_EQ(big_number(models).below, "") << "it is the reference";
  models.selected = 1;
  EXPECT_EQ(big_number(models).number, "–") << "without samples there is no 0.00";
}

TEST(PanelWords, TheTableIsACsv) {
  ModelsView models = view_of({ready_slot("greedy-100"), ready_slot("trend")}, true);
  models.counted = "10 samples";
  models.slots[0].centres = 100;
  models.slots[0].errors.samples = 10;
  models.slots[0].errors.p99_error_over_jnd = 0.5;
  models.slots[0].errors.within_jnd = 1.0;
  models.slots[0].tick.median_ns = 330.0;
  EXPECT_EQ(
      table_csv(models),
      "# 10 samples\nmodel,centres,p99_error_over_jnd,within_jnd,tick_ns\ngreedy-100,100,0.5,1,330\ntrend,0,,,\n");
}

TEST(PanelWords, TwoModelsAreComparedAloneAndASceneThatCannotMoveSaysNothing) {
  ModelsView models = view_of({ready_slot("a"), ready_slot("b"), ready_slot("c")}, true);
  EXPECT_EQ(models.drawn(), (std::vector<std::size_t>{1, 2, 0}));
  models.second = 2;
  EXPECT_EQ(models.drawn(), (std::vector<std::size_t>{2, 0}));
  WindowView shown;
  ViewState view;
  MouseDevice mouse;
  Scene scene;
  shown.tool = &mouse;
  shown.scene = &scene;
  shown.hand_explores = true;
  EXPECT_EQ(press_hint(shown, view), "") << "no model, no material";
  scene.material = "skin";
  EXPECT_NE(press_hint(shown, view).find("pull down"), std::string::npos);
  shown.hand_explores = false;
  shown.health.newest.rendered_N = 1.0;
  EXPECT_EQ(press_hint(shown, view), "") << "it was done";
}

TEST(PanelWords, WithoutATruthTheBigNumberIsThePrediction) {
  ModelsView models = view_of({ready_slot("greedy-100")}, true);
  ModelView& greedy = models.slots[0];
  // The error that the model predicts, relative to a JND of 0.13 N at 1 N.
  models.compared = false;
  models.reference_name = "no truth to compare with";
  EXPECT_EQ(big_number(models).number, "–") << "it does not know";
  greedy.force_N = 1.0;
  greedy.predicted_error_N = 0.5 * JndLine{}.at(1.0);
  EXPECT_EQ(big_number(models).number, "0.50");
  EXPECT_EQ(big_number(models).below, "no truth to compare with");
  models.now.in_contact = false;
  EXPECT_EQ(big_number(models).number, "–");
  EXPECT_EQ(big_number({}).number, "");
}

TEST(PanelWords, ARowSaysWhichModelsHaveItsForcesAndWhy) {
  ModelInfo info;
  EXPECT_EQ(equal_words(info), "");
  info.method = "trend";
  info.equals = {"trend+voxel", "trend+greedy-100"};
  EXPECT_TRUE(test::has_parts(equal_words(info), {"trend+voxel", "trend+greedy-100", "no correction"}));
  info.method = "greedy";
  EXPECT_EQ(equal_words(info).find("no correction"), std::string::npos);
}

// All dots, their intervals and paths are inside, with the JND.
TEST(PanelWords, ThePlotOfErrorAgainstTimeShowsAllDots) {
  ModelsView models = view_of({ready_slot("greedy-100"), ready_slot("trend")}, true);
  const PlotAxes empty = speed_axes(models);
  EXPECT_LT(empty.y.from, 0.0);
  const auto set = [](ModelView& one, double ns, double over_jnd) {
    one.errors.samples = 100;
    one.errors.p99_error_over_jnd = over_jnd;
    one.tick = {ns, 0.9 * ns, 1.1 * ns, ns};
  };
  set(models.slots[0], 390.0, 0.04);
  set(models.slots[1], 240.0, 0.05);
  models.slots[0].p99_interval = {0.02, 0.08};
  models.slots[0].path[3] = {150.0, 7.0};
  const PlotAxes axes = speed_axes(models);
  for (const double ns : {150.0, 240.0, 429.0}) {
    EXPECT_LT(axes.x.from, std::log10(ns));
    EXPECT_GT(axes.x.to, std::log10(ns));
  }
  for (const double over_jnd : {0.02, 0.08, 1.0, 7.0}) {
    EXPECT_LT(axes.y.from, std::log10(over_jnd));
    EXPECT_GT(axes.y.to, std::log10(over_jnd));
  }
  EXPECT_LT(axes.x.to, 3.0) << "the budget of 1 ms is not in the plot";
}

}  // namespace
}  // namespace palpate
