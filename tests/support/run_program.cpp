#include "tests/support/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "tests/support/message_parts.h"

namespace palpate::test {
namespace {

// Replaces the child process by the program.
[[noreturn]] void become(const std::vector<std::string>& command, const std::vector<std::string>& environment, int out,
                         int err) {
  const int empty = open("/dev/null", O_RDONLY);
  dup2(empty, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  std::vector<std::string> settings = environment;
  for (std::string& setting : settings) putenv(setting.data());
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

// Reads both pipes at once, so that neither fills up and stalls the program.
void drain(std::array<pollfd, 2>& pipes, std::array<std::string*, 2> texts) {
  std::array<char, 65536> chunk;
  while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
    if (poll(pipes.data(), pipes.size(), -1) < 0) continue;
    for (std::size_t i = 0; i < pipes.size(); ++i) {
      if (pipes[i].fd < 0 || pipes[i].revents == 0) continue;
      const ssize_t count = read(pipes[i].fd, chunk.data(), chunk.size());
      if (count > 0) {
        texts[i]->append(chunk.data(), static_cast<std::size_t>(count));
      } else {
        close(pipes[i].fd);
        pipes[i].fd = -1;
      }
    }
  }
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment) {
  ProgramRun run;
  std::array<int, 2> out{};
  std::array<int, 2> err{};
  if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) return run;
  const pid_t child = fork();
  if (child == 0) become(command, environment, out[1], err[1]);
  close(out[1]);
  close(err[1]);
  std::array<pollfd, 2> pipes{pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
  drain(pipes, {&run.out, &run.err});
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child) {
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return run;
}

ProgramRun run_palpate(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
  std::vector<std::string> command = {PALPATE_BINARY};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command, environment);
}

ProgramRun must_run(const std::vector<std::string>& arguments) {
  ProgramRun run = run_palpate(arguments);
  if (run.exit_code != 0) throw std::runtime_error("exit code " + std::to_string(run.exit_code) + ", " + run.err);
  return run;
}

testing::AssertionResult is_refused(const ProgramRun& run, int exit_code, const std::vector<std::string>& parts) {
  const bool one_line = run.err.rfind("error: ", 0) == 0 && run.err.find('\n') == run.err.size() - 1;
  if (run.exit_code == exit_code && run.out.empty() && one_line) return has_parts(run.err, parts);
  return testing::AssertionFailure() << "exit code " << run.exit_code << ", expected " << exit_code
                                     << " and one error line: " << run.out << run.err;
}

testing::AssertionResult fails(int exit_code, const std::vector<std::string>& arguments,
                               const std::vector<std::string>& parts) {
  return is_refused(run_palpate(arguments), exit_code, parts);
}

}  // namespace palpate::test
