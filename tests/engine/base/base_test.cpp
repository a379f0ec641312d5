#include "engine/base/text.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/base/files.h"
#include "engine/base/random_stream.h"
#include "engine/base/signals.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(PositionPrefix, CountsLinesAndBytes) {
  EXPECT_EQ(position_prefix("f", "ab\nc", 1), "f:1:2: ");
  EXPECT_EQ(position_prefix("f", "ab\nc", 3), "f:2:1: ");
  EXPECT_EQ(position_prefix("f", "ab\nc", 100), "f:2:2: ");
}

TEST(Utf8, FollowsRfc3629) {
  for (const std::string good : {"", "a", "\xC2\xB5", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xED\x9F\xBF"}) {
    EXPECT_EQ(utf8_bytes(good), good.size()) << good;
  }
  // Invalid UTF-8: lone, overlong, surrogate, beyond U+10FFFF, truncated.
  for (const char* bad : {"a\x80", "a\xC0\x80", "a\xE0\x80\x80", "a\xED\xA0\x80", "a\xF4\x90\x80\x80",
                          "a\xF5\x80\x80\x80", "a\xE2\x82", "a\xF0\x9F\x98z"}) {
    EXPECT_EQ(utf8_bytes(bad), 1u);
  }
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("plain \xC2\xB5"), "plain \xC2\xB5");
  EXPECT_EQ(printable("\x1B[2J\x7F\n"), "\\x1b[2J\\x7f\\x0a");
  EXPECT_EQ(printable("\xC2\x9B\xFF"), "\\xc2\\x9b\\xff");
  EXPECT_EQ(printable("abcdef", 3), "abc...");
  EXPECT_EQ(printable("abc", 3), "abc");
  EXPECT_EQ(printable("a\x1B]0;x\a.csv: found\n  b\n", std::string::npos), "a\\x1b]0;x\\x07.csv: found\n  b\n");
}

TEST(Trimmed, TakesBlanksAndTabsFromBothEnds) {
  EXPECT_EQ(trimmed(" \ta b\t "), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
}

TEST(NearestName, IsWithinAThirdOfTheLetters) {
  const std::vector<std::string> names{"method", "recording", "out", "force"};
  EXPECT_EQ(nearest_name("metod", names), "method");
  EXPECT_EQ(nearest_name("recodring", names), "recording");
  EXPECT_EQ(nearest_name("ouput", names), "out");
  EXPECT_EQ(nearest_name("dance", {"help", "json"}), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("metod", {}), "");
}

TEST(ShellWord, IsReadBackByAShellAsOneWord) {
  EXPECT_EQ(shell_word("a/b-1.csv"), "a/b-1.csv");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(Text, FixedRoundsAsPrintfDoes) {
  for (const double value : {0.0, -0.0, 0.125, 2.5, 1.005, -1234.5678, 1e308, 5e-324}) {
    for (const int decimals : {0, 1, 3, 17}) {
      char expected[400];
      std::snprintf(expected, sizeof expected, "%.*f", decimals, value);
      EXPECT_EQ(fixed(value, decimals), expected);
    }
  }
}

TEST(Text, ThreeDigitsKeepTheirNumberWhateverTheSize) {
  EXPECT_EQ(three_digits(8.8749), "8.87");
  EXPECT_EQ(three_digits(0.012345), "0.0123");
  EXPECT_EQ(three_digits(9.999), "10.0");
  EXPECT_EQ(three_digits(99.96), "100");
  EXPECT_EQ(three_digits(12345.0), "12,300");
  EXPECT_EQ(three_digits(-1234567.0), "-1,230,000");
  EXPECT_EQ(three_digits(0.0), "0");
  EXPECT_EQ(three_digits(4.5e9), "4.50e+09");
  EXPECT_EQ(three_digits(std::numeric_limits<double>::infinity()), "–");
}

TEST(Text, AtMostThreeDecimalsWithoutAnExponent) {
  EXPECT_EQ(at_most_three_decimals(0.4123), "0.412");
  EXPECT_EQ(at_most_three_decimals(2.314), "2.31");
  EXPECT_EQ(at_most_three_decimals(9.997), "10.0");
  EXPECT_EQ(at_most_three_decimals(23.14), "23.1");
  EXPECT_EQ(at_most_three_decimals(-231.4), "-231");
  EXPECT_EQ(at_most_three_decimals(std::nan("")), "–");
}

constexpr int kDraws = 200000;

// Standard errors at 200,000 draws: mean 1/sqrt(n) = 0.0022, variance
// sqrt(1.9/n) = 0.0031. The tolerance is four standard errors.
TEST(RandomStream, NormalHasMeanZeroAndVarianceOne) {
  RandomStream random(1, 1);
  double sum = 0.0, squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
    beyond_two += std::abs(z) > 2.0;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.009);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.0125);
  // A true normal has 4.55 %, the sum of twelve 4.58 %; standard error 0.05 %.
  EXPECT_NEAR(100.0 * beyond_two / kDraws, 4.6, 0.2);
}

using testing::ExitedWithCode;
using testing::KilledBySignal;

// Standard error tells what has happened; f: the forces were stopped.
void trace(char letter) { [[maybe_unused]] const auto written = write(STDERR_FILENO, &letter, 1); }

// Runs `body` with forces to stop and default handlers. In a child process (EXPECT_EXIT).
void run(const std::function<void()>& body) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) signal(number, SIG_DFL);
  stop_forces_by([]() noexcept { trace('f'); });
  install_signal_handlers();
  body();
  _exit(0);
}

TEST(Signals, ForcesStopBeforeASignalEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGABRT})
    EXPECT_EXIT(run([=] { raise(number); }), KilledBySignal(number), "^f$");
}

TEST(Signals, EveryOrderOfTwoSignalsStopsTheForces) {
  for (const int first : {SIGINT, SIGTERM, SIGHUP}) {
    for (const int second : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT}) {
      const auto both = [=] {
        const StopListener listener;
        raise(first);
        trace(stop_requested() == first ? '1' : '?');
        raise(second);
        trace('?');
      };
      EXPECT_EXIT(run(both), KilledBySignal(second), "^1f$") << first;
    }
  }
}

TEST(Signals, AHandlerFromBeforeIsCalledAfterTheForcesStop) {
  const auto install_twice = [] {
    signal(SIGTERM, [](int) { trace('h'); });
    install_signal_handlers();
    install_signal_handlers();
    raise(SIGTERM);
  };
  EXPECT_EXIT(run(install_twice), ExitedWithCode(0), "^fh$");
}

TEST(Signals, AnIgnoredSignalStaysIgnored) {
  const auto ignore = [] {
    signal(SIGHUP, SIG_IGN);
    ignore_broken_pipes();
    const StopListener listener;
    raise(SIGHUP);
    raise(SIGPIPE);
    trace(stop_requested() == 0 ? '1' : '?');
  };
  EXPECT_EXIT(run(ignore), ExitedWithCode(0), "^1$");
}

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

using test::read_text;
using test::TemporaryFolder;

const std::string kMegabyte(std::size_t{1} << 20, 'x');

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
    Result file = test::must(AtomicFile::create(folder.file("out"), false));
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
  Result file = test::must(AtomicFile::create(folder.file("out"), false));
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
