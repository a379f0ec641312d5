#include "models/fit/fit.h"

#include <gtest/gtest.h>

#include "models/model/correction.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using test::must;

ModelFits example_fits() {
  return ModelFits({prepare_recording(test::example_recording(1500, 250.0)),
                    prepare_recording(test::example_recording(1000, 250.0))},
                   {"test", test::paper_features(), {}});
}

// A plan with the features of the scene.
ModelPlan plan_for(Base base, const Method& method, int centres = 30) {
  return {.base = base, .method = &method, .centres = centres, .features = FeatureChoice::scene};
}

// The model of a plan, and the number of questions of its fit: fewer if parts are reused.
std::pair<std::string, int> counted(ModelFits& fits, const ModelPlan& plan) {
  int questions = 0;
  const auto fit = must(fits.fit(plan, {[&](double) { return ++questions > 0; }}));
  return {must(write_model_text(fit.data)), questions};
}

TEST(ModelFits, PlansThatDifferInTheMethodShareTheirPreparation) {
  ModelFits fits = example_fits();
  const PreparedTraining* const first = must(fits.prepare(plan_for(Base::trend, kGreedyMethod), {}));
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kDirectMethod), {})), first);
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kGreedyMethod, 7), {})), first);
  const PreparedTraining* const on_force = must(fits.prepare(plan_for(Base::force, kGreedyMethod), {}));
  EXPECT_NE(on_force, first);
  ModelPlan other = plan_for(Base::trend, kGreedyMethod);
  other.thinning = Thinning::none;
  EXPECT_NE(must(fits.prepare(other, {})), first);
  other.thinning = Thinning::coverage;
  EXPECT_EQ(must(fits.prepare(other, {})), first) << "coverage is the default with the trend";
  // The kernel belongs to the residual of the trend, but not to the force.
  other.kernel = KernelKind::linear;
  EXPECT_NE(must(fits.prepare(other, {})), first);
  other.base = Base::force;
  other.thinning.reset();
  EXPECT_EQ(must(fits.prepare(other, {})), on_force);
  // Every preparation has the same samples, and stays valid.
  EXPECT_EQ(first->samples, on_force->samples);
  EXPECT_EQ(first->samples, must(fits.samples({})));
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kGreedyMethod), {})), first);
}

TEST(ModelFits, AFitIsThatOfAPlanAlone) {
  for (const Base base : {Base::trend, Base::force}) {
    ModelFits shared = example_fits();
    for (const Method* method : {&kDirectMethod, &kVoxelMethod, &kRandomMethod, &kGreedyMethod}) {
      const ModelPlan plan = plan_for(base, *method);
      ModelFits alone = example_fits();
      EXPECT_EQ(counted(shared, plan).first, counted(alone, plan).first) << plan_name(plan);
    }
  }
}

}  // namespace
}  // namespace palpate
