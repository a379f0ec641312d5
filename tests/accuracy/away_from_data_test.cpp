// Extrapolation: outside its training data every model must be finite, bounded,
// continuous, nonnegative and marked as out of domain. On motions unlike the
// training its error must not exceed that of a model of position alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "engine/tick/haptics_tick.h"
#include "scenes/hard/hard.h"
#include "scenes/material/material.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

constexpr double kEncoder_m = 30e-6;
constexpr double kModerateSpeed_m_per_s = 0.03;

// A minimum-jerk move to `target_m` in `duration_s`.
struct Stretch {
  double target_m = 0.0;
  double duration_s = 0.0;
};

// The path of these moves one after the other, from kInAir_m; then at rest.
Path along(std::vector<Stretch> stretches) {
  return [stretches = std::move(stretches)](double time_s) {
    double from_m = kInAir_m;
    for (const auto& [target_m, duration_s] : stretches) {
      if (time_s < duration_s) return minimum_jerk(from_m, target_m, duration_s, time_s).aim_m;
      time_s -= duration_s;
      from_m = target_m;
    }
    return from_m;
  };
}

// A press to `depth_m`, a hold of `hold_s`, and a return to kInAir_m, with the peak speed `speed_m_per_s`.
std::vector<Stretch> press_and_hold(double depth_m, double speed_m_per_s, double hold_s) {
  constexpr double kPeakSpeed = 1.875;  // of a minimum-jerk path of length 1 in time 1
  const double travel_s = kPeakSpeed * (depth_m - kInAir_m) / speed_m_per_s;
  return {{depth_m, travel_s}, {depth_m, hold_s}, {kInAir_m, travel_s}, {kInAir_m, 0.5}};
}

struct Subject {
  std::string name;
  std::vector<ModelPtr> models;  // one of each method
  double deepest_m = 0.0;
  double largest_N = 0.0;
  double speed_m_per_s = 0.0;  // of the training
  double onset_N = 0.0;        // force with which the recorded contact begins
  // The limit of a force step with a 30 um encoder, relative to the limit with
  // exact positions.
  double encoder_allowance = 1.0;
};

Subject subject_of(const std::string& name, const PreparedTraining& prepared, double speed_m_per_s) {
  const ModelData& common = prepared.common;
  Subject subject;
  subject.name = name;
  subject.models = fit_all(prepared);
  subject.deepest_m = common.trend.reference_depth_m;
  subject.largest_N = common.largest_force_N;
  subject.speed_m_per_s = speed_m_per_s;
  return subject;
}

// 250 Hz keeps direct fits short. The tests still run at 1 kHz.
constexpr double kTrainingRate_Hz = 250.0;

const Subject& silicone() {
  static const Subject subject = [] {
    RigSettings settings = train_settings("silicone");
    settings.seconds = 12.0;
    settings.rate_Hz = kTrainingRate_Hz;
    return subject_of("silicone", prepare({rig_recording(settings)}, scene_request("silicone_block")),
                      kModerateSpeed_m_per_s);
  }();
  return subject;
}

bool have_press() { return std::filesystem::exists(real_data()); }

const Subject& real_press() {
  static const Subject subject = [] {
    Subject made = subject_of(
        "press", prepare({real_recording("ur3e_press_mit/train_cycle1.csv")}, scene_request("silicone_block")), 0.01);
    // Position 0 is where the force first exceeded 0.1 N.
    made.onset_N = 0.1;
    // Known limitation: with an encoder coarser than its own, steps exceed one JND.
    // Below 1 N the recorded speeds end. There the encoder makes the velocity ripple by
    // 0.7 mm/s per sample, a 25th of its spread. Direct fits the force noise there (50 mN)
    // and moves by its whole correction limit of 0.31 N: 3.3 JND. In the other models
    // the ripple crosses much of the zone in which trust falls from 1 to 0: 1.4 JND.
    made.encoder_allowance = 4.0;
    return made;
  }();
  return subject;
}

std::vector<const Subject*> subjects() {
  std::vector<const Subject*> all{&silicone()};
  if (have_press()) all.push_back(&real_press());
  return all;
}

struct Stroke {
  double largest_step_over_jnd = 0.0;  // between consecutive samples, relative to the allowed step
  double largest_N = 0.0;
  std::size_t outside = 0;  // samples deeper than 1.3 times the training
  std::size_t outside_unmarked = 0;
};

// These moves into a virtual material, at 1 kHz.
Press scripted_press(const std::string& material, const std::vector<Stretch>& script, double encoder_step_m,
                     std::uint64_t seed) {
  double seconds = 0.0;
  for (const Stretch& stretch : script) seconds += stretch.duration_s;
  return press_into(*must(find_material(material)).make_block(), along(script), even_times(seconds, 1000.0),
                    {.encoder_step_m = encoder_step_m, .seed = seed});
}

// Replays `motion`. The allowed step is one JND or the step of the true
// material, whichever is larger.
std::vector<Stroke> stroke_over(const Subject& subject, const Press& motion) {
  std::vector<Stroke> strokes(subject.models.size());
  std::vector<double> last_N(subject.models.size(), 0.0);
  std::size_t row_index = 0;
  bool was_in_contact = false;
  replay(motion.recording, ForceModels(subject.models.begin(), subject.models.end()),
         [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
           double true_step_N = row_index > 0 ? std::abs(motion.true_N[row_index] - motion.true_N[row_index - 1]) : 0.0;
           if (snapshot.in_contact != was_in_contact) true_step_N = std::max(true_step_N, subject.onset_N);
           was_in_contact = snapshot.in_contact;
           EXPECT_EQ(snapshot.fault, TickFault::none);
           for (std::size_t i = 0; i < strokes.size(); ++i) {
             const double force_N = snapshot.force_N[i];
             Stroke& stroke = strokes[i];
             EXPECT_TRUE(std::isfinite(force_N));
             EXPECT_GE(force_N, 0.0);
             stroke.largest_N = std::max(stroke.largest_N, force_N);
             const double jnd_N = subject.models[i]->data().jnd.at(std::max(force_N, last_N[i]));
             const double allowed_N = std::max(jnd_N, true_step_N);
             stroke.largest_step_over_jnd =
                 std::max(stroke.largest_step_over_jnd, std::abs(force_N - last_N[i]) / allowed_N);
             last_N[i] = force_N;
             if (row.position_m > 1.3 * subject.deepest_m) {
               ++stroke.outside;
               if ((snapshot.out_of_domain_mask >> i & 1U) == 0) ++stroke.outside_unmarked;
             }
           }
           ++row_index;
         });
  return strokes;
}

void expect_sane(const Subject& subject, const std::string& what, const std::vector<Stretch>& script,
                 double largest_step_over_jnd) {
  for (const double encoder_m : {0.0, kEncoder_m}) {
    const double limit = largest_step_over_jnd * (encoder_m > 0.0 ? subject.encoder_allowance : 1.0);
    const auto strokes = stroke_over(subject, scripted_press("silicone", script, encoder_m, 3));
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      const std::string who = subject.name + ", " + what + ", " + subject.models[i]->name() +
                              (encoder_m > 0.0 ? ", encoder" : ", exact position");
      std::cout << who << ": largest step " << strokes[i].largest_step_over_jnd << " JND, largest force "
                << strokes[i].largest_N << " N of " << subject.largest_N << " N\n";
      EXPECT_LE(strokes[i].largest_N, 1.2 * subject.largest_N) << who;
      EXPECT_LE(strokes[i].largest_step_over_jnd, limit) << who;
      EXPECT_EQ(strokes[i].outside_unmarked, 0u) << who << " of " << strokes[i].outside;
    }
  }
}

TEST(AwayFromData, HalfAsDeepAgain) {
  for (const Subject* subject : subjects()) {
    expect_sane(*subject, "deeper", press_and_hold(1.5 * subject->deepest_m, subject->speed_m_per_s, 1.0), 1.0);
  }
}

TEST(AwayFromData, HoldsTenTimesAsLong) {
  for (const Subject* subject : subjects()) {
    expect_sane(*subject, "long hold", press_and_hold(0.8 * subject->deepest_m, subject->speed_m_per_s, 20.0), 1.0);
  }
}

// At three times the speed the force may rise three times as fast.
TEST(AwayFromData, ThreeTimesAsFast) {
  for (const Subject* subject : subjects()) {
    expect_sane(*subject, "faster", press_and_hold(0.9 * subject->deepest_m, 3.0 * subject->speed_m_per_s, 0.5), 3.0);
  }
}

// Along every axis through the middle of the data, from -1e6 to 1e6.
TEST(AwayFromData, SweepsOfEveryFeature) {
  for (const Subject* subject : subjects()) {
    for (const ModelPtr& model : subject->models) {
      const ModelData& data = model->data();
      for (std::size_t axis = 0; axis < data.features.size(); ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        std::vector<double> x(data.offset.data(), data.offset.data() + data.offset.size());
        for (const double sign : {-1.0, 1.0}) {
          for (double away = 1e-6; away < 1e6; away *= 1.5) {
            x[axis] = sign * away;
            const double force_N = model->evaluate(x.data()).force_N;
            ASSERT_TRUE(force_N >= 0.0 && force_N <= 1.2 * data.largest_force_N)
                << model->name() << ", axis " << axis << " at " << x[axis] << ": " << force_N << " N";
          }
          x[axis] = sign * 1e6;
          EXPECT_TRUE(model->evaluate(x.data()).out_of_domain) << model->name() << ", axis " << axis;
        }
        // Steps of a thousandth of the spread: the force has no jump. A change of
        // one spread changes the force by about its whole range, so that
        // each of these steps must be far below one JND.
        double last_N = -1.0;
        for (double u = -5.0; u <= 5.0; u += 1e-3) {
          x[axis] = data.offset(k) + u * data.scale(k);
          const double force_N = model->evaluate(x.data()).force_N;
          if (last_N >= 0.0) {
            ASSERT_LE(std::abs(force_N - last_N), data.jnd.at(force_N)) << model->name() << ", axis " << axis;
          }
          last_N = force_N;
        }
      }
    }
  }
}

// Compares each method with the same method fitted to position alone.
void expect_no_worse_than_position(const std::string& what, const RecordingPtr& train, const RecordingPtr& test_run,
                                   const std::string& scene) {
  const std::vector<ModelPtr> full = fit_all(prepare({train}, scene_request(scene)));
  const std::vector<ModelPtr> alone = fit_all(prepare({train}, position_request()));
  for (std::size_t i = 0; i < full.size(); ++i) {
    const ErrorSummary errors = judge_moved(*test_run, full[i]);
    const double alone_N = judge_moved(*test_run, alone[i]).rms_error_N;
    std::cout << what << ": " << figures(full[i]->name(), errors) << "; position alone " << 1e3 * alone_N << " mN\n";
    EXPECT_LE(errors.rms_error_N, alone_N) << what << ", " << full[i]->name();
  }
}

// Every fourth row, that is kTrainingRate_Hz.
RecordingPtr thinned(const RecordingPtr& recording) {
  auto copy = std::make_shared<Recording>(*recording);
  copy->rows.clear();
  for (std::size_t i = 0; i < recording->rows.size(); i += 4) copy->rows.push_back(recording->rows[i]);
  return copy;
}

RecordingPtr scripted(const std::string& material, const std::vector<std::vector<Stretch>>& presses,
                      std::uint64_t seed) {
  std::vector<Stretch> script{{-0.002, 0.3}};
  for (const auto& one : presses) script.insert(script.end(), one.begin(), one.end());
  return std::make_shared<const Recording>(scripted_press(material, script, kEncoder_m, seed).recording);
}

std::vector<std::vector<Stretch>> presses(const std::vector<double>& depths_m, double speed_m_per_s, double hold_s) {
  std::vector<std::vector<Stretch>> all;
  for (const double depth_m : depths_m) all.push_back(press_and_hold(depth_m, speed_m_per_s, hold_s));
  return all;
}

TEST(UnlikeTheTraining, SlowPressesThenPokes) {
  for (const std::string material : {"silicone", "foam"}) {
    expect_no_worse_than_position(
        material + ", slow to fast", thinned(scripted(material, presses({0.003, 0.006, 0.009, 0.005}, 0.015, 0.7), 1)),
        scripted(material, presses({0.004, 0.008, 0.006}, 0.15, 0.05), 2), material + "_block");
  }
}

TEST(UnlikeTheTraining, ShallowThenDeep) {
  for (const std::string material : {"silicone", "foam"}) {
    expect_no_worse_than_position(material + ", shallow to deep",
                                  thinned(scripted(material, presses({0.002, 0.004, 0.005, 0.003}, 0.02, 0.5), 1)),
                                  scripted(material, presses({0.006, 0.009, 0.008}, 0.03, 0.5), 2),
                                  material + "_block");
  }
}

TEST(UnlikeTheTraining, TheSecondCycleOfTheRealPress) {
  if (!have_press()) GTEST_SKIP() << "no recordings at " << real_data();
  expect_no_worse_than_position("press, cycle 1 to 2", real_recording("ur3e_press_mit/train_cycle1.csv"),
                                real_recording("ur3e_press_mit/test_cycle2.csv"), "silicone_block");
}

}  // namespace
}  // namespace palpate::test
