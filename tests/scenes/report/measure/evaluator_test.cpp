#include "scenes/report/measure/evaluator.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

std::vector<ModelPointer> example_pointers() {
  std::vector<ModelPointer> models;
  for (const ModelData& data : test::example_models()) models.push_back(std::make_shared<const FittedModel>(data));
  return models;
}

TEST(ReplayEvaluator, PoolsWhatItSawRecordingByRecording) {
  std::vector<ModelPointer> models = example_pointers();
  while (models.size() < 20) models.push_back(models.front());  // more than one replay takes
  const JndLine jnd;
  ReplayEvaluator evaluator(models.size(), jnd);
  const Recording recording = test::example_recording(500, 1000.0);
  const auto once = evaluator.evaluate(recording, models);
  ASSERT_TRUE(once.ok());
  ASSERT_EQ(once->size(), models.size());
  EXPECT_EQ((*once)[0].rms_error_N, (*once)[19].rms_error_N) << "the same model";
  ASSERT_TRUE(evaluator.evaluate(recording, models).ok());
  EXPECT_EQ(evaluator.pooled()[3].samples, 2 * (*once)[3].samples);
  EXPECT_NEAR(evaluator.pooled()[3].rms_error_N, (*once)[3].rms_error_N, 1e-12);
}

TEST(WithSurfaceAt, MovesPositionsAlone) {
  const Recording recording = test::example_recording(20, 1000.0);
  const Recording moved = with_correction(recording, {0.001, 0.0});
  EXPECT_DOUBLE_EQ(moved.rows[7].position_m, recording.rows[7].position_m - 0.001);
  EXPECT_EQ(moved.rows[7].force_N, recording.rows[7].force_N);
}

}  // namespace
}  // namespace palpate
