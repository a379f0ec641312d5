#include "engine/base/temporary_paths.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "engine/base/signals.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::TemporaryFolder;

// A child that owns its signals, runs `body` and is asked to end twice.
void end_twice(const std::function<void()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);
    const StopListener listener;
    body();
    raise(SIGINT);
    raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
}

// As a report looks before it is whole; more names than one read of the folder returns.
void fill(const std::string& path) {
  std::filesystem::create_directories(path + "/figures/empty");
  for (int i = 0; i < 100; ++i) std::ofstream(path + "/figures/figure-" + std::to_string(i) + ".svg") << "x";
  std::ofstream(path + "/report.json") << "{}";
}

TEST(TemporaryPaths, AFolderGoesWithAllThatIsInIt) {
  const TemporaryFolder folder;
  end_twice([&] {
    fill(folder.file("hidden"));
    register_temporary(folder.file("hidden"));
  });
  EXPECT_TRUE(folder.entries().empty());
}

TEST(TemporaryPaths, WhatALinkPointsToStays) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  elsewhere.with_file("kept", "x");
  end_twice([&] {
    std::filesystem::create_directory(folder.file("hidden"));
    std::filesystem::create_directory_symlink(elsewhere.path(), folder.file("hidden/link"));
    register_temporary(folder.file("hidden"));
  });
  EXPECT_TRUE(folder.entries().empty());
  EXPECT_EQ(elsewhere.entries(), std::vector<std::string>{"kept"});
}

TEST(TemporaryPaths, WhatIsUnregisteredOrTheParentsStays) {
  const TemporaryFolder folder;
  const int parents = register_temporary(folder.with_file("parents", "x"));
  end_twice([&] { unregister_temporary(register_temporary(folder.with_file("whole", "x"))); });
  unregister_temporary(parents);
  EXPECT_EQ(folder.entries().size(), 2u);
}

TEST(TemporaryPaths, HoldsThirtyTwo) {
  std::vector<int> taken;
  for (int slot = register_temporary("/none"); slot >= 0; slot = register_temporary("/none")) taken.push_back(slot);
  EXPECT_EQ(taken.size(), 32u);
  for (const int slot : taken) unregister_temporary(slot);
  EXPECT_EQ(register_temporary(std::string(5000, 'x')), -1);
}

}  // namespace
}  // namespace palpate
