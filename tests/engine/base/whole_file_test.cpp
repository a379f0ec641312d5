#include "engine/base/whole_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(WholeFile, ReadsEveryByteOrNothing) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0\r\n\xff", 5);
  EXPECT_EQ(read_whole_file(folder.with_file("bytes", bytes)), bytes);
  EXPECT_EQ(read_whole_file(folder.with_file("empty", "")), "");
  EXPECT_FALSE(read_whole_file(folder.file("none")).has_value());
  EXPECT_FALSE(read_whole_file(folder.path()).has_value());
}

}  // namespace
}  // namespace palpate
