#include "tests/support/fitting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "engine/tick/haptics_tick.h"

namespace palpate::test {
namespace {

// Errors of the methods on recordings of real materials, with the positions as recorded: a prediction. Skipped where
// the recordings are not present beside the sources.

class RealAccuracy : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(real_data())) GTEST_SKIP() << "no recordings at " << real_data();
  }
};

TEST_F(RealAccuracy, SkinOnTrialsOfOtherForces) {
  const PreparedTraining prepared = prepare(skin_recordings("train", {"250", "600", "1000"}), default_request("skin"));
  const ModelPtr greedy = fit(prepared, &kGreedyMethod);
  double squares = 0.0;
  double within = 0.0;
  double samples = 0.0;
  for (const RecordingPtr& recording : skin_recordings("test", {"400", "800", "900"})) {
    const ErrorSummary summary = judge(*recording, greedy);
    std::cout << figures(recording->name, summary) << "\n";
    const auto n = static_cast<double>(summary.samples);
    squares += n * summary.rms_error_N * summary.rms_error_N;
    within += n * summary.within_jnd;
    samples += n;
  }
  // Measured: 100 % and 34 mN as recorded. A surface offset of -0.2 mm would give 8 mN, but
  // these recordings start on the surface and do not determine it, so no offset is applied.
  EXPECT_GE(within / samples, 0.999);
  EXPECT_LE(std::sqrt(squares / samples), 0.040);
}

// The surface position differs by up to a millimetre between trials.
TEST_F(RealAccuracy, SiliconeUnderAnIndenterOnAnotherSpot) {
  std::vector<RecordingPtr> training;
  for (const char* trial : {"3", "4", "7", "10", "12"}) {
    training.push_back(real_recording(std::string("zwick_silicone/train_trial") + trial + ".csv"));
  }
  const ModelPtr greedy = fit(prepare(training, default_request("silicone_block")), &kGreedyMethod);
  const ErrorSummary summary = judge(*real_recording("zwick_silicone/test_trial9.csv"), greedy);
  std::cout << figures("trial 9", summary) << "\n";
  EXPECT_GE(summary.within_jnd, 0.995);
  EXPECT_LE(summary.rms_error_N, 0.020);  // measured: 16.2 mN, an error of 0.45 JND at the 99th percentile
}

// The second cycle leaves the domain of the first; the log has the share of samples that are out of domain. Every
// method must predict it better than a model of depth alone.
TEST_F(RealAccuracy, PressOnItsSecondCycle) {
  const std::vector<RecordingPtr> training{real_recording("ur3e_press_mit/train_cycle1.csv")};
  const RecordingPtr recording = real_recording("ur3e_press_mit/test_cycle2.csv");
  const ErrorSummary depth_alone = judge(*recording, fit(prepare(training, position_request()), &kTrendMethod));
  std::cout << figures("depth alone", depth_alone) << "\n";
  for (const ModelPtr& model : fit_all(prepare(training, default_request("silicone_block")))) {
    const ErrorSummary summary = judge(*recording, model);
    std::cout << figures(model->name(), summary) << "\n";
    EXPECT_LT(summary.rms_error_N, depth_alone.rms_error_N) << model->name();
    EXPECT_GT(summary.within_jnd, depth_alone.within_jnd) << model->name();
    EXPECT_GE(summary.within_jnd, 0.95) << model->name();  // measured: 97.4 %
  }
}

// As many test machines record: the press starts and ends at a preload of 3 N, which is depth 0.
TEST_F(RealAccuracy, PressThatCountsDepthFromItsPreload) {
  const auto from_preload = [](const char* file) {
    Recording cut = *real_recording(file);
    const auto loaded = [](const RecordingRow& row) { return row.force_N > 3.0; };
    cut.rows.erase(cut.rows.begin(), std::find_if(cut.rows.begin(), cut.rows.end(), loaded));
    cut.rows.erase(std::find_if(cut.rows.rbegin(), cut.rows.rend(), loaded).base(), cut.rows.end());
    const double zero_m = cut.rows.front().position_m;
    for (RecordingRow& row : cut.rows) row.position_m -= zero_m;
    return std::make_shared<const Recording>(std::move(cut));
  };
  const PreparedTraining prepared =
      prepare({from_preload("ur3e_press_mit/train_cycle1.csv")}, default_request("silicone_block"));
  EXPECT_LT(prepared.common.features.front().surface_position_m, -0.3e-3);
  const ErrorSummary summary = judge(*from_preload("ur3e_press_mit/test_cycle2.csv"), fit(prepared, &kGreedyMethod));
  std::cout << figures("cycle 2", summary) << "\n";
  EXPECT_GE(summary.within_jnd, 0.99);  // 0.92 if the trend started at the preload
}

TEST_F(RealAccuracy, EcoflexFromPositionAlone) {
  for (const std::string thinner : {"0T", "100T"}) {
    const PreparedTraining prepared =
        prepare({real_recording("ecoflex_static/EF10_" + thinner + "_train_A1.csv")}, position_request());
    const RecordingPtr recording = real_recording("ecoflex_static/EF10_" + thinner + "_test_A3.csv");
    double peak_N = 0.0;
    for (const RecordingRow& row : recording->rows) peak_N = std::max(peak_N, row.force_N);
    for (const ModelPtr& model : fit_all(prepared)) {
      const ErrorSummary summary = judge(*recording, model);
      std::cout << figures(model->name(), summary) << ", " << 100.0 * summary.rms_error_N / peak_N
                << " % of the peak\n";
      EXPECT_LT(summary.rms_error_N, 0.01 * peak_N) << model->name() << ", " << thinner;
    }
  }
}

// Coverage of the 95 % bound, as recorded, on recordings that no model was fitted to, in every phase of the contacts.

struct Row {
  bool within = false;
  double depth_m = 0.0, speed_m_per_s = 0.0, into_contact = 0.0;  // the last: share of the rows of the contact, 0 to 1
};

// The rows in contact.
std::vector<Row> rows_of(const Recording& recording, const ModelPtr& model) {
  std::vector<Row> rows;
  std::size_t first = 0;  // of the contact
  const auto end_contact = [&] {
    for (std::size_t i = first; i < rows.size(); ++i)
      rows[i].into_contact = static_cast<double>(i - first) / static_cast<double>(rows.size() - first);
    first = rows.size();
  };
  double last_m = 0.0;
  replay(recording, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
    const double speed = std::abs(snapshot.depth_m - last_m);
    last_m = snapshot.depth_m;
    if (snapshot.depth_m <= 0.0) return end_contact();
    const double error_N = std::abs(snapshot.force_N[0] - row.force_N);
    rows.push_back({error_N <= snapshot.predicted_error_N[0], snapshot.depth_m, speed});
  });
  end_contact();
  return rows;
}

// The share within the bound of the tenth of the rows that comes first in this order.
double share_of_tenth(std::vector<Row> rows, const std::function<double(const Row&)>& order) {
  std::ranges::stable_sort(rows, {}, order);
  const auto tenth = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 10);
  return static_cast<double>(std::count_if(rows.begin(), tenth, [](const Row& row) { return row.within; })) /
         static_cast<double>(tenth - rows.begin());
}

// `least`: of all rows; each phase may have a tenth less.
void expect_coverage(const RecordingPtr& recording, const ModelPtr& model, double least) {
  SCOPED_TRACE(recording->name);
  ASSERT_TRUE(model->data().error_bound.has_value());
  const std::vector<Row> rows = rows_of(*recording, model);
  const auto within = static_cast<double>(std::ranges::count(rows, true, &Row::within));
  std::cout << recording->name << ": " << 100.0 * within / static_cast<double>(rows.size()) << " % within the bound";
  EXPECT_GE(within / static_cast<double>(rows.size()), least);
  const std::pair<const char*, std::function<double(const Row&)>> phases[] = {
      {"first", [](const Row& row) { return row.into_contact; }},
      {"last", [](const Row& row) { return -row.into_contact; }},
      {"deepest", [](const Row& row) { return -row.depth_m; }},
      {"fastest", [](const Row& row) { return -row.speed_m_per_s; }}};
  for (const auto& [phase, order] : phases) {
    const double share = share_of_tenth(rows, order);
    std::cout << ", " << phase << " tenth " << 100.0 * share;
    EXPECT_GE(share, least - 0.1) << phase;
  }
  std::cout << "\n";
}

TEST(BoundAccuracy, VirtualMaterials) {
  for (const char* material : {"foam", "layered", "friction", "sponge"}) {
    const PreparedTraining prepared = prepare({train_recording(material)}, default_request("silicone_block"));
    expect_coverage(test_recording(material), fit(prepared, &kGreedyMethod), 0.93);
  }
}

TEST(BoundAccuracy, RealMaterials) {
  if (!std::filesystem::exists(real_data())) GTEST_SKIP() << "no recordings at " << real_data();
  const ModelPtr skin =
      fit(prepare(skin_recordings("train", {"250", "600", "1000"}), default_request("skin")), &kGreedyMethod);
  for (const RecordingPtr& recording : skin_recordings("test", {"400", "800", "900"}))
    expect_coverage(recording, skin, 0.93);
  // A single press does not show how the next one differs.
  const auto press = prepare({real_recording("ur3e_press_mit/train_cycle1.csv")}, default_request("silicone_block"));
  EXPECT_FALSE(fit(press, &kGreedyMethod)->data().error_bound.has_value());
}

}  // namespace
}  // namespace palpate::test
