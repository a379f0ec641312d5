#include "engine/base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/signals.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::read_text;
using test::TemporaryFolder;

const std::string kMegabyte(std::size_t{1} << 20, 'x');

TEST(AtomicFile, HoldsWhatWasWritten) {
  const TemporaryFolder folder;
  auto file = AtomicFile::create(folder.file("out"), false);
  ASSERT_TRUE(file.ok());
  file->write("one,");
  file->write("two\n");
  EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(read_text(folder.file("out")), "one,two\n");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
}

TEST(AtomicFile, AFileThatIsReplacedKeepsItsPermissions) {
  const TemporaryFolder folder;
  const std::string path = folder.with_file("out", "secret");
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  ASSERT_TRUE(write_file_atomically(path, "new", true).ok());
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    auto file = AtomicFile::create(folder.file("out"), false);
    ASSERT_TRUE(file.ok());
    file->write(kMegabyte);
  }
  EXPECT_TRUE(folder.entries().empty());
}

TEST(AtomicFile, RefusesAnExistingFile) {
  const TemporaryFolder folder;
  const std::string path = folder.with_file("out", "old");
  const Status status = write_file_atomically(path, "new", false);
  ASSERT_FALSE(status.ok());
  EXPECT_TRUE(test::has_parts(status.error().message, {path, "--force"}));
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(folder.entries().size(), 1u);
}

TEST(AtomicFile, RefusesAFileThatAppearedWhileItWasWriting) {
  const TemporaryFolder folder;
  auto file = AtomicFile::create(folder.file("out"), false);
  ASSERT_TRUE(file.ok());
  file->write("ours");
  folder.with_file("out", "theirs");
  const Status status = file->commit();
  ASSERT_FALSE(status.ok());
  EXPECT_TRUE(test::has_parts(status.error().message, {folder.file("out"), "--force"}));
  EXPECT_EQ(read_text(folder.file("out")), "theirs");
  EXPECT_EQ(folder.entries().size(), 1u);
}

TEST(AtomicFile, RefusesAFolderADeviceAndAnEmptyName) {
  const TemporaryFolder folder;
  EXPECT_TRUE(test::has_parts(write_file_atomically(folder.path(), "x", true).error().message,
                              {folder.path(), "folder", "; "}));
  EXPECT_TRUE(test::has_parts(write_file_atomically("/dev/null", "x", true).error().message,
                              {"/dev/null", "regular file", "; "}));
  EXPECT_TRUE(test::has_parts(write_file_atomically("", "x", true).error().message, {"empty"}));
}

TEST(AtomicFile, NamesAMissingFolder) {
  const TemporaryFolder folder;
  const std::string path = folder.file("none/out");
  EXPECT_TRUE(test::has_parts(write_file_atomically(path, "x", false).error().message,
                              {path, "folder", folder.file("none"), "; "}));
  const std::string under_a_file = folder.with_file("file", "") + "/out";
  EXPECT_TRUE(test::has_parts(write_file_atomically(under_a_file, "x", false).error().message,
                              {under_a_file, "folder", folder.file("file")}));
}

TEST(AtomicFile, ReportsAFullDiskAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.with_file("out", "old");
  const auto fill_disk = [&] {
    install_signal_handlers();
    const rlimit limit{1000, 1000};  // simulates a disk with 1000 free bytes
    setrlimit(RLIMIT_FSIZE, &limit);
    const Status written = write_file_atomically(path, kMegabyte, true);
    _exit(!written.ok() && written.error().message == "cannot write " + path + ": File too large" ? 0 : 4);
  };
  EXPECT_EXIT(fill_disk(), testing::ExitedWithCode(0), "");
  EXPECT_EQ(read_text(path), "old");
  EXPECT_EQ(folder.entries().size(), 1u);
}

TEST(AtomicFile, KilledLeavesNothingAtAll) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
    const TemporaryFolder folder;
    folder.with_file("out", "old");
    const auto write_until_killed = [&] {
      install_signal_handlers();
      auto file = AtomicFile::create(folder.file("out"), true);
      if (!file) _exit(3);
      file->write(kMegabyte);  // more than one buffer
      raise(number);
    };
    EXPECT_EXIT(write_until_killed(), testing::KilledBySignal(number), "");
    EXPECT_EQ(read_text(folder.file("out")), "old");
    const int nameless = open(folder.path().c_str(), O_WRONLY | O_TMPFILE, 0666);
    if (nameless < 0) GTEST_SKIP() << "this file system gives every file a name";
    close(nameless);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
  }
}

}  // namespace
}  // namespace palpate
