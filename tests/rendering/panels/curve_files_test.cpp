// The saved figure and the saved table are of the same samples.
#include "rendering/panels/curve_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace palpate {
namespace {

// Two seconds of quick strokes; the model has exactly the reference's force.
ForceHistory example() {
  ForceHistory history;
  for (int i = 0; i < 2000; ++i) {
    HistoryPoint point;
    point.loop_time_s = point.time_s = 100.0 + 1e-3 * i;
    point.in_contact = true;
    point.reference = i < 1000 ? 2 : 1;
    point.force_N.fill(std::nanf(""));
    point.reference_N = point.force_N[0] = static_cast<float>(5.0 + std::sin(0.07 * i));
    history.append(point);
  }
  return history;
}

TEST(CurveFiles, WhatIsEqualInTheTableIsEqualInTheFigure) {
  const ForceHistory history = example();
  CurveColumns columns;
  columns.gather(history, {}, 1, 100.0, 102.0, 100);
  const CurveSource source{"scene", "hand", "truth", {}, 100.0, {{0, "model", Rgb(0.0F)}}};
  const std::string svg = curve_svg(columns, source, 100.0, 102.0);
  std::vector<std::string> paths;
  for (std::size_t at = svg.find("<path d='M"); at != std::string::npos; at = svg.find("<path d='M", at + 1)) {
    const std::string path = svg.substr(at + 9, svg.find('\'', at + 9) - at - 9);
    if (path.find('L') != std::string::npos) paths.push_back(path);
  }
  ASSERT_EQ(paths.size(), 3u) << "reference, model, difference";
  EXPECT_EQ(paths[0], paths[1]);
}

TEST(CurveFiles, EveryRowSaysWhatItsReferenceWas) {
  const CurveSource source{"scene", "hand", "truth", {}, 100.0, {{0, "model", Rgb(0.0F)}}};
  std::istringstream csv(curve_csv(example(), source, 100.0, 102.0));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "# scene, hand; now compared with: truth");
  std::getline(csv, line);
  EXPECT_EQ(line, "time_s,depth_m,reference,reference_N,rendered_N,model_N");
  std::getline(csv, line);
  EXPECT_EQ(line, "0.000000,0,model,5,0,5");
  while (std::getline(csv, line)) {
    if (line.rfind("1.5", 0) != 0) continue;
    EXPECT_NE(line.find(",truth,"), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace palpate
