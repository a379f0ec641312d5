#include "engine/tick/jnd.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

// The paper's conservative line, section 4.1.
TEST(JndLine, IsThePapersConservativeLine) {
  const JndLine line;
  EXPECT_DOUBLE_EQ(line.at(0.0), 0.065);
  EXPECT_NEAR(line.at(2.5), 0.065 + 0.0633 * 2.5, 1e-15);
  EXPECT_DOUBLE_EQ(line.at(-2.5), line.at(2.5));
}

}  // namespace
}  // namespace palpate
