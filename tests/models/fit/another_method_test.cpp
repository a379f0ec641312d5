// A new method that exists only in this file: a polynomial in depth and velocity. It
// is fitted, saved, loaded, replayed, plotted and put into a live slot without changes
// of other code.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "models/fit/fit.h"
#include "models/model/file/json_arrays.h"
#include "models/model/file/model_io.h"
#include "scenes/report/figures.h"
#include "scenes/report/plan.h"
#include "scenes/scene/scene.h"
#include "scenes/worker/slot_plan.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

constexpr Eigen::Index kTerms = 6;  // 1, d, v, d^2, d v, v^2

Eigen::Matrix<double, kTerms, 1> terms(double d, double v) {
  return (Eigen::Matrix<double, kTerms, 1>() << 1.0, d, v, d * d, d * v, v * v).finished();
}

class PolynomialCorrection final : public Correction {
 public:
  explicit PolynomialCorrection(Eigen::VectorXd coefficients) : coefficients_(std::move(coefficients)) {}

  double evaluate(const double* u) const noexcept override { return coefficients_.dot(terms(u[0], u[1])); }
  int size() const noexcept override { return static_cast<int>(coefficients_.size()); }
  Status validate(int dimension) const override {
    if (dimension < 2 || coefficients_.size() != kTerms || !coefficients_.allFinite()) {
      return Error{"polynomial: expected 6 finite coefficients of depth and velocity"};
    }
    return {};
  }
  FileFields file_fields() const override { return {{"polynomial", json_list(coefficients_)}}; }

 private:
  Eigen::VectorXd coefficients_;
};

CorrectionPtr read_polynomial(JsonFields& fields, const JsonNode& top, int) {
  return std::make_shared<const PolynomialCorrection>(read_vector(fields, top, "polynomial", kTerms, "coefficients"));
}

Result<FittedCorrection> fit_polynomial(const MethodTask& task, const FitControl&) {
  Eigen::MatrixXd rows(task.sites.count(), kTerms);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    rows.row(i) = task.sites.row_scale(i) * terms(task.sites.points(0, i), task.sites.points(1, i)).transpose();
  }
  const Eigen::VectorXd scaled = task.sites.row_scale.cwiseProduct(task.sites.target_N);
  return FittedCorrection{
      std::make_shared<const PolynomialCorrection>(rows.colPivHouseholderQr().solve(scaled)), {}, ""};
}

const Method kPolynomialMethod{
    .name = "polynomial",
    .label = "polynomial",
    .colour = 0x7F3C8D,
    .expected_seconds = [](const MethodRequest&) { return 0.02; },
    .fit = fit_polynomial,
};

class AnotherMethod : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    add_correction_kind({"polynomial", read_polynomial});
    add_method(kPolynomialMethod);
  }
  static void TearDownTestSuite() {
    remove_method(kPolynomialMethod);
    remove_correction_kind("polynomial");
  }
};

TEST_F(AnotherMethod, IsFittedSavedLoadedAndReplayed) {
  const auto recording = std::make_shared<const Recording>(test::example_recording(1500, 250.0));
  TrainingRequest request;
  request.scene = "test";
  request.features = test::paper_features();
  PreparedTraining prepared = test::prepare({recording}, request);
  prepared.strength.reset();  // a correction regardless of cross-validation
  prepared.sites.strength = 1.0;
  const test::ModelPtr model = test::fit(prepared, find_method("polynomial"));
  const test::ModelPtr trend = test::fit(prepared, &kTrendMethod);
  EXPECT_EQ(model->name(), "polynomial");
  EXPECT_EQ(model->centre_count(), 6);

  const test::TemporaryFolder folder;
  const std::string path = folder.file("polynomial.json");
  ASSERT_TRUE(save_model(path, model->data(), false).ok());
  const auto loaded = load_model(path);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ((*loaded)->method(), "polynomial");

  const std::vector<ErrorSummary> errors = test::judge(*recording, {model, *loaded, trend});
  EXPECT_EQ(errors[0].rms_error_N, errors[1].rms_error_N);
  EXPECT_LT(errors[0].rms_error_N, errors[2].rms_error_N) << "it corrects the trend";
}

TEST_F(AnotherMethod, HasItsColourLabelSlotAndPlaceInTheReport) {
  EXPECT_EQ(method_rgb("polynomial"), 0x7F3C8Du);
  const auto slots = plan_slots(test::must(load_scene("silicone_block")), {"polynomial"}, false);
  ASSERT_TRUE(slots.ok()) << slots.error().message;
  EXPECT_EQ((*slots)[0].method, &kPolynomialMethod);
  EXPECT_EQ(plan_name((*slots)[0]), "polynomial");
  const std::vector<PlannedModel> plan = make_plan(true, 4);
  const auto at = std::find_if(plan.begin(), plan.end(), [](const PlannedModel& model) {
    return model.request.method == &kPolynomialMethod && model.recipe == Recipe::palpate;
  });
  ASSERT_NE(at, plan.end());
  EXPECT_TRUE(at->main);
  EXPECT_EQ(model_colour(*at), 0x7F3C8Du);
}

TEST_F(AnotherMethod, IsListedWhereMethodsAre) {
  EXPECT_NE(method_names().find("polynomial"), std::string::npos);
  EXPECT_NE(
      plan_slots(test::must(load_scene("silicone_block")), {"polynomal"}, false).error().message.find("polynomial"),
      std::string::npos);
}

}  // namespace
}  // namespace palpate
