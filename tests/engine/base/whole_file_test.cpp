#include "engine/base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/message_parts.h"
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

TEST(WholeFile, WaitsForNoPipeAndReadsNoDeviceToTheEndOfMemory) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  for (const std::string& path : {folder.file("pipe"), std::string("/dev/zero")}) {
    EXPECT_FALSE(read_whole_file(path).has_value());
    const std::string message = read_plain_file(path, "a scene").error().message;
    EXPECT_TRUE(test::has_parts(message, {"pipe", "a scene"})) << message;
  }
}

TEST(WholeFile, SaysWhyAFileCannotBeRead) {
  const test::TemporaryFolder folder;
  const auto message = [](const std::string& path) { return read_plain_file(path, "a scene").error().message; };
  EXPECT_TRUE(test::has_parts(message(folder.file("none")), {folder.file("none"), "no such file", "; "}));
  EXPECT_TRUE(test::has_parts(message(folder.path()), {folder.path(), "folder", "; "}));
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::string path = folder.with_file("secret", "x");
  ASSERT_EQ(chmod(path.c_str(), 0), 0);
  EXPECT_TRUE(test::has_parts(message(path), {path, "permission", "; "}));
}

}  // namespace
}  // namespace palpate
