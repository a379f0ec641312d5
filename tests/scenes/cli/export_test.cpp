// palpate export with only a model: the forces of the file equal those of palpate replay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/tick/haptics_tick.h"
#include "engine/tick/jnd.h"
#include "models/correction/methods.h"
#include "models/model/file/model_io.h"
#include "tests/support/compiled_model.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

class ExportVerb : public ::testing::Test {
 protected:
  // Positions and forces of the virtual rig.
  Recording recording(const std::string& material, double seconds, std::uint64_t seed, double noise_m = 0.0) {
    RigSettings settings = test::train_settings(material);
    settings.seconds = seconds;
    settings.seed = seed;
    Recording positions = *test::encoder_only(test::rig_recording(settings));
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(0.0, noise_m);
    for (RecordingRow& row : positions.rows) row.position_m += noise_m > 0.0 ? noise(engine) : 0.0;
    return positions;
  }

  // Fits `train` and returns the text of the exported file.
  std::string exported(const Recording& train, const std::vector<std::string>& fit_options,
                       const std::vector<std::string>& export_options = {}) {
    EXPECT_TRUE(write_recording(folder_.file("train.csv"), train, {}, true).ok());
    std::vector<std::string> fit = {"fit",   "--recording",          folder_.file("train.csv"),
                                    "--out", folder_.file("m.json"), "--force"};
    fit.insert(fit.end(), fit_options.begin(), fit_options.end());
    test::must_run(fit);
    std::vector<std::string> arguments = {"export", folder_.file("m.json"), "--c", folder_.file("m.c"), "--force"};
    arguments.insert(arguments.end(), export_options.begin(), export_options.end());
    printed_ = test::must_run(arguments).out;
    return test::read_text(folder_.file("m.c"));
  }

  bool has_feature(FeatureKind kind) {
    const auto model = test::must(load_model(folder_.file("m.json")));
    return std::any_of(model->features().begin(), model->features().end(),
                       [&](const FeatureSpec& spec) { return spec.kind == kind; });
  }

  // The maximum of `distance(exported force, replay's force)` over the recording.
  template <typename Real, typename Distance>
  double worst(const Recording& test_recording, const std::string& text, const Distance& distance) {
    const test::CompiledModel<Real> compiled(text);
    if (!compiled.loaded()) return INFINITY;
    // Writes and reads the file, so that the decimals are those that replay reads.
    EXPECT_TRUE(write_recording(folder_.file("test.csv"), test_recording, {}, true).ok());
    const Recording read = test::must(read_recording(folder_.file("test.csv")));
    double largest = 0.0;
    const ReplaySummary summary =
        replay(read, {test::must(load_model(folder_.file("m.json")))},
               [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
                 const Real force_N = compiled.force(row.time_s, static_cast<Real>(row.position_m));
                 largest = std::max(largest, distance(static_cast<double>(force_N), snapshot.force_N[0]));
               });
    EXPECT_GT(summary.contact_samples, 500U);
    return largest;
  }

  double worst_N(const Recording& test_recording, const std::string& text) {
    return worst<double>(test_recording, text, [](double a_N, double b_N) { return std::abs(a_N - b_N); });
  }

  test::TemporaryFolder folder_;
  std::string printed_;
};

// Tested on other presses than those of the fit. The required accuracy is 1e-9 N.
TEST_F(ExportVerb, EveryMethodGivesReplaysForcesOfAnotherRecording) {
  const Recording train = recording("friction", 10.0, 1);
  const Recording other = recording("friction", 6.0, 2);
  for (const ModelPlan& plan : all_plans()) {
    const std::string name = family_name(plan);
    const std::string text = exported(train, {"--method", name});
    EXPECT_LT(worst_N(other, text), 1e-9) << name;
    EXPECT_EQ(has_feature(FeatureKind::stops), plan.base == Base::trend) << name;
    EXPECT_TRUE(test::has_parts(printed_, {"30 um", "0 um"}));
  }
}

TEST_F(ExportVerb, TheEncoderStepIsThatOfTheOption) {
  const std::string text = exported(recording("silicone", 6.0, 1), {"--method", "trend"}, {"--encoder-step", "1e-6"});
  EXPECT_TRUE(test::has_parts(text, {"#define PALPATE_ENCODER_STEP_M 1e-06"}));
  EXPECT_TRUE(test::has_parts(printed_, {"steps of 1 um"}));
}

TEST_F(ExportVerb, NeverWritesOverTheModel) {
  const test::TemporaryFolder folder;
  const std::string model = folder.with_file("m.json", "mine\n");
  for (const std::string& out : {model, folder.path() + "/./m.json"}) {
    EXPECT_TRUE(test::fails(1, {"export", model, "--c", out, "--force"}, {"m.json", "the file to read from", "--c"}));
  }
  EXPECT_EQ(test::read_text(model), "mine\n");
}

}  // namespace
}  // namespace palpate
