// Coverage of the 95 % bound, as recorded, on recordings that no model was fitted to, in every phase of the contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "engine/tick/replay.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

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
