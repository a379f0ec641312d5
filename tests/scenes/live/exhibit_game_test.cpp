#include "scenes/live/exhibit_game.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace palpate {
namespace {

using State = ExhibitGame::State;
const std::vector<ExhibitModel> kAll = {{0, 100, false}, {1, 40, true}, {2, 5, true}};

HistoryPoint tick_at(double time_s, double over_jnd, bool in_contact = true, bool away = false) {
  HistoryPoint tick{.loop_time_s = time_s, .reference_N = 2.0F, .in_contact = in_contact, .out_of_domain = away};
  tick.force_N.fill(2.0F);
  for (std::size_t slot : {0U, 1U, 2U})
    tick.sustained_over_jnd[slot] = static_cast<float>(over_jnd) * (slot == 2 ? 1.0F : slot == 1 ? 0.5F : 0.125F);
  return tick;
}
// A press of `seconds` from the air, in which the first level is off by `over_jnd`.
void press(ExhibitGame& game, double from_s, double seconds, double over_jnd) {
  game.add(tick_at(from_s - 1e-3, 0.0, false));
  for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i) game.add(tick_at(from_s + 1e-3 * i, over_jnd));
}

TEST(ExhibitGame, GoesFromObviousToImpossible) {
  const auto line_up = ExhibitGame::line_up_of(kAll, true, false);
  EXPECT_FALSE(line_up.truth) << "the reference";
  ASSERT_EQ(line_up.levels.size(), 3u);
  EXPECT_EQ(line_up.levels[0].slot, 2u) << "of the paper with few centres";
  EXPECT_EQ(line_up.levels[1].slot, 1u) << "with more";
  EXPECT_EQ(line_up.levels[2].slot, 0u) << "the best";
  // Of more models the obvious ones and the best are left.
  const auto many = ExhibitGame::line_up_of({{0, 9, true}, {1, 5, true}, {2, 7, true}, {3, 0, false}}, true, false);
  ASSERT_EQ(many.levels.size(), 3u);
  EXPECT_EQ(many.levels[1].slot, 2u);
  EXPECT_EQ(many.levels[2].slot, 3u);
}

// A device can render models only, and some sessions have no reference.
TEST(ExhibitGame, WithoutATruthModelsAreComparedWithTheBest) {
  for (const bool has_force : {false, true}) {
    const auto line_up = ExhibitGame::line_up_of({{4, 10, true}, {5, 90, true}}, has_force, has_force);
    ASSERT_TRUE(line_up.truth);
    EXPECT_EQ(line_up.truth->slot, 5u);
    ASSERT_EQ(line_up.levels.size(), 1u);
    EXPECT_EQ(line_up.levels[0].slot, 4u);
  }
  EXPECT_FALSE(ExhibitGame(1).begin({{4, 10, true}}, false, false));
  EXPECT_FALSE(ExhibitGame(1).begin({}, true, false));
}

TEST(ExhibitGame, PressesComeBeforeTheQuestionAndAllAreJudgedByAllPresses) {
  ExhibitGame game(1);
  ASSERT_TRUE(game.begin(kAll, true, false));
  double time_s = 100.0;
  for (const double over_jnd : {3.0, 8.0, 1.0}) {
    EXPECT_EQ(game.state(), State::press);
    game.answer(true);
    EXPECT_EQ(game.state(), State::press) << "before a press there is no answer";
    game.add(tick_at(time_s, 99.0));  // the simulated hand was there
    for (int i = 0; i < 3000; ++i) game.add(tick_at(time_s += 1e-3, 0.0, false));
    EXPECT_EQ(game.trace().seconds(), 0.0) << "time begins with the first contact";
    press(game, time_s, 0.6, over_jnd);
    time_s += 0.6;
    ASSERT_TRUE(game.can_answer()) << "one stroke presses both";
    game.answer(game.level() == 0 ? game.round().computer_is_left : !game.round().computer_is_left);
    ASSERT_EQ(game.state(), State::reveal) << "the answer ends the round";
    EXPECT_EQ(game.round().correct(), game.level() == 0);
    game.go_on();
  }
  EXPECT_EQ(game.state(), State::score);
  // The same presses for all: the order of the levels is that of their errors.
  EXPECT_DOUBLE_EQ(game.largest_over_jnd(0), 8.0);
  EXPECT_DOUBLE_EQ(game.largest_over_jnd(1), 4.0);
  EXPECT_DOUBLE_EQ(game.largest_over_jnd(2), 1.0);
  game.reset();
  EXPECT_EQ(game.state(), State::attract);
}

TEST(ExhibitGame, TheComputerIsOnEitherSide) {
  std::set<bool> sides;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    ExhibitGame game(seed);
    ASSERT_TRUE(game.begin(kAll, true, false));
    for (const ExhibitRound& round : game.rounds()) sides.insert(round.computer_is_left);
  }
  EXPECT_EQ(sides.size(), 2u);
}

TEST(ExhibitGame, OnADeviceBothBlocksHaveToBeChosenAndPressed) {
  ExhibitGame game(1);
  ASSERT_TRUE(game.begin(kAll, true, true));
  EXPECT_EQ(game.rendered().slot == 0, !game.round().computer_is_left) << "the left one first; slot 0 is the best";
  press(game, 1.0, 1.0, 2.0);
  EXPECT_FALSE(game.can_answer());
  game.choose(false);
  EXPECT_EQ(game.rendered().slot == 0, game.round().computer_is_left);
  EXPECT_FALSE(game.can_answer()) << "chosen is not pressed";
  press(game, 3.0, 30.0, 2.0);
  ASSERT_EQ(game.state(), State::press) << "a hand takes its time";
  game.answer(true);
  EXPECT_EQ(game.state(), State::reveal);
}

TEST(ExhibitTrace, KeepsTheLargestWithinWhatWasTrainedFor) {
  ExhibitTrace trace;
  const ExhibitLineUp line_up = ExhibitGame::line_up_of(kAll, true, false);
  for (int i = 0; i < 2000; ++i) {
    const bool away = i >= 1000 && i < 1100;
    trace.add(tick_at(5.0 + 1e-3 * i, i == 700 ? -0.75 : away ? 3.0 : 0.5, true, away), line_up, 0);
  }
  EXPECT_NEAR(trace.largest_over_jnd(), 0.75, 1e-9);
  EXPECT_EQ(trace.largest_at(), 28u);
  EXPECT_NEAR(trace.columns()[28].over_jnd, -0.75, 1e-9) << "with its sign";
  EXPECT_TRUE(std::isnan(trace.columns()[41].over_jnd)) << "where nothing was recorded the curve has a gap";
  EXPECT_NEAR(trace.seconds(), 1.999, 1e-9);
  for (int i = 2000; i < 70000; ++i) trace.add(tick_at(5.0 + 1e-3 * i, i > 61000 ? 1.0 : 0.0), line_up, 0);
  EXPECT_EQ(trace.largest_over_jnd(), 1.0) << "also after a minute";
}

}  // namespace
}  // namespace palpate
