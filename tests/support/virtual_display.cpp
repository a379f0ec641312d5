#include "tests/support/virtual_display.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace palpate::test {
namespace {

class Server {
 public:
  Server() {
    int ends[2];
    if (pipe(ends) != 0) return;
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0) become_server(ends[1], parent);
    close(ends[1]);
    if (pid_ > 0) read_name(ends[0]);
    close(ends[0]);
  }
  ~Server() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  const std::string& name() const { return name_; }

 private:
  // Xvfb selects a free display number and writes it to `descriptor`.
  [[noreturn]] static void become_server(int descriptor, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);
    const int silence = open("/dev/null", O_WRONLY);
    dup2(silence, STDOUT_FILENO);
    dup2(silence, STDERR_FILENO);
    const std::string number = std::to_string(descriptor);
    // Without -noreset it restarts after the last window closes and misses new connections meanwhile.
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1920x1080x24", "-nolisten", "tcp", "-noreset",
           nullptr);
    _exit(127);
  }

  void read_name(int descriptor) {
    std::string number;
    char byte = 0;
    while (read(descriptor, &byte, 1) == 1 && byte != '\n') number += byte;
    if (!number.empty()) name_ = ":" + number;
  }

  pid_t pid_ = -1;
  std::string name_;
};

}  // namespace

const std::string& virtual_display() {
  static const Server server;
  if (!server.name().empty()) {
    setenv("DISPLAY", server.name().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  }
  return server.name();
}

}  // namespace palpate::test
