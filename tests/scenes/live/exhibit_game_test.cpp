#include "scenes/live/exhibit_game.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace palpate {
namespace {

using State = ExhibitGame::State;
const std::vector<ExhibitModel> kAll = {{0, 100, false}, {1, 40, true}, {2, 5, true}};

// A press of `seconds` at 2 N. The second force is larger by `over_jnd` JNDs of 0.1 N.
void press(ExhibitGame& game, double from_s, double seconds, double over_jnd) {
  for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i)
    game.add({from_s + 1e-3 * i, 2.0, 2.0 + 0.1 * over_jnd, over_jnd, true, false});
}

TEST(ExhibitGame, GoesFromObviousToImpossible) {
  const auto rounds = ExhibitGame::rounds_of(kAll, true, false);
  ASSERT_EQ(rounds.size(), 3u);
  EXPECT_EQ(rounds[0].second.slot, 2u) << "of the paper with few centres";
  EXPECT_EQ(rounds[1].second.slot, 1u) << "with more";
  EXPECT_EQ(rounds[2].second.slot, 0u) << "the best";
  for (const ExhibitRound& round : rounds) EXPECT_FALSE(round.first) << "the reference";
  // Of more models the obvious ones and the best are left.
  const auto many = ExhibitGame::rounds_of({{0, 9, true}, {1, 5, true}, {2, 7, true}, {3, 0, false}}, true, false);
  ASSERT_EQ(many.size(), 3u);
  EXPECT_EQ(many[0].second.slot, 1u);
  EXPECT_EQ(many[1].second.slot, 2u);
  EXPECT_EQ(many[2].second.slot, 3u);
}

TEST(ExhibitGame, IsPlayedFromGuessToScore) {
  ExhibitGame game(1);
  ASSERT_TRUE(game.begin(kAll, true, false, 2.0));
  double time_s = 100.0;
  for (const double over_jnd : {3.0, 1.5, 0.3}) {
    EXPECT_EQ(game.state(), State::guess);
    press(game, time_s, 0.1, over_jnd);
    EXPECT_EQ(game.trace().seconds(), 0.0) << "nothing counts before the guess";
    game.guess(true);
    EXPECT_EQ(game.state(), State::press);
    for (int i = 0; i < 5000; ++i) game.add({time_s += 1e-3, 0.0, 0.0, 0.0, false, false});
    EXPECT_EQ(game.trace().seconds(), 0.0) << "time begins with the first contact";
    press(game, time_s, 2.1, over_jnd);
    time_s += 2.1;
    ASSERT_EQ(game.state(), State::reveal);
    EXPECT_NEAR(game.round().largest_over_jnd, over_jnd, 1e-9);
    EXPECT_EQ(game.round().correct(), over_jnd > 1.0);
    game.go_on();
  }
  EXPECT_EQ(game.state(), State::score);
  EXPECT_EQ(game.correct_answers(), 2u);
  game.reset();
  EXPECT_EQ(game.state(), State::attract);
}

TEST(ExhibitGame, RoundsOnADeviceAreBlindWithOneCatchTrial) {
  std::set<std::size_t> caught_at;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    ExhibitGame game(seed);
    ASSERT_TRUE(game.begin(kAll, true, true));
    ASSERT_EQ(game.rounds().size(), 3u);
    int catches = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const ExhibitRound& round = game.rounds()[i];
      ASSERT_TRUE(round.first);
      EXPECT_TRUE(round.first->slot == 0 || round.second.slot == 0) << "the best is one of them";
      if (!round.is_catch()) continue;
      ++catches;
      caught_at.insert(i);
    }
    EXPECT_EQ(catches, 1);
  }
  EXPECT_EQ(caught_at.size(), 3u) << "in any place";
}

TEST(ExhibitGame, AnAnswerNeedsBothToBePressed) {
  ExhibitGame game(1);
  ASSERT_TRUE(game.begin(kAll, true, true));
  EXPECT_EQ(game.state(), State::press) << "no guess before a hand has felt anything";
  game.guess(true);
  press(game, 1.0, 1.0, 2.0);
  game.answer(true);
  EXPECT_EQ(game.state(), State::press);
  game.choose(3);
  EXPECT_EQ(game.chosen(), 1);
  game.choose(2);
  EXPECT_EQ(game.rendered().slot, game.round().second.slot);
  game.answer(true);
  EXPECT_EQ(game.state(), State::press) << "chosen is not pressed";
  press(game, 3.0, 30.0, 2.0);
  ASSERT_EQ(game.state(), State::press) << "a hand takes its time";
  game.answer(true);
  ASSERT_EQ(game.state(), State::reveal);
  EXPECT_TRUE(game.round().noticed());
  EXPECT_TRUE(game.round().correct());
}

TEST(ExhibitTrace, KeepsTheLargestWithinWhatWasTrainedFor) {
  ExhibitTrace trace;
  for (int i = 0; i < 2000; ++i) {
    const bool away = i >= 1000 && i < 1100;
    trace.add({5.0 + 1e-3 * i, 1.0, 1.05, i == 700 ? -0.7 : away ? 3.0 : 0.5, true, away});
  }
  EXPECT_NEAR(trace.largest_over_jnd(), 0.7, 1e-9);
  EXPECT_EQ(trace.largest_at(), 28u);
  EXPECT_NEAR(trace.columns()[28].over_jnd, -0.7, 1e-9) << "with its sign";
  EXPECT_TRUE(std::isnan(trace.columns()[41].over_jnd)) << "where nothing was recorded the curve has a gap";
  EXPECT_NEAR(trace.columns()[60].over_jnd, 0.5, 1e-9);
  EXPECT_NEAR(trace.seconds(), 1.999, 1e-9);
  trace.clear();
  EXPECT_TRUE(trace.columns().empty());
  EXPECT_EQ(trace.largest_over_jnd(), 0.0);
}

}  // namespace
}  // namespace palpate
