#include "scenes/plot/gnuplot.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <sstream>

namespace palpate {
namespace {

// In the child, after fork: async-signal-safe calls only.
[[noreturn]] void become(char* const* arguments, char* const* environment, const char* folder, int out) {
  const int empty = open("/dev/null", O_RDWR);
  dup2(empty, STDIN_FILENO);
  dup2(empty, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  if (chdir(folder) != 0) _exit(127);
  execve(arguments[0], arguments, environment);
  _exit(127);
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

// Ours without what would change a decimal point.
std::vector<std::string> plain_environment() {
  std::vector<std::string> settings{"LC_ALL=C"};
  for (char** setting = environ; *setting != nullptr; ++setting) {
    const std::string text = *setting;
    if (text.rfind("LC_", 0) != 0 && text.rfind("GNUPLOT", 0) != 0) settings.push_back(text);
  }
  return settings;
}

std::string read_all(int descriptor) {
  std::string text;
  char chunk[4096];
  for (;;) {
    const ssize_t count = read(descriptor, chunk, sizeof chunk);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(chunk, static_cast<std::size_t>(count));
  }
}

// The first line that says something, warnings left out.
std::string first_line(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool says = line.find_first_not_of(" \t^") != std::string::npos;
    if (says && line.find("warning:") == std::string::npos) return line;
  }
  return "no message";
}

Status run_script(const std::string& program, const std::string& folder, const std::string& script) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) return Error{"cannot start " + program + ": no pipe"};
  std::vector<std::string> command{program, "-d", script};  // no personal settings
  std::vector<std::string> environment = plain_environment();
  const std::vector<char*> arguments = pointers(command);
  const std::vector<char*> settings = pointers(environment);
  // No copy of our memory, for which the haptics thread of a window would have to wait.
  const pid_t child = vfork();
  if (child == 0) become(arguments.data(), settings.data(), folder.c_str(), pipe_ends[1]);
  close(pipe_ends[1]);
  const std::string said = child > 0 ? read_all(pipe_ends[0]) : "";
  close(pipe_ends[0]);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return Error{"gnuplot (" + program + ") could not draw " + script + ": " + first_line(said) +
               "; check that it is gnuplot 5.4 or newer with the svg and pngcairo terminals"};
}

}  // namespace

Result<std::string> find_gnuplot() {
  const char* path = getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = (folder.empty() ? "." : folder) + "/gnuplot";
    struct stat status {};
    if (stat(program.c_str(), &status) == 0 && S_ISREG(status.st_mode) && access(program.c_str(), X_OK) == 0) {
      // The child changes its folder first.
      char* absolute = realpath(program.c_str(), nullptr);
      if (absolute == nullptr) continue;
      const std::string found = absolute;
      free(absolute);
      return found;
    }
  }
  return Error{"found no gnuplot in PATH, which draws the figures; install it (Debian: apt-get install gnuplot-nox)"};
}

Status run_gnuplot(const std::string& program, const std::string& folder, const std::vector<std::string>& scripts) {
  // A process each: what one script leaves set must not colour the next.
  for (const std::string& script : scripts) {
    if (const Status drawn = run_script(program, folder, script); !drawn) return drawn;
  }
  return {};
}

}  // namespace palpate
