#include "scenes/plot/plot.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRandomLetters = 6;  // of mkdtemp
// A folder is locked within this time after it was made.
constexpr std::chrono::seconds kLockedBy(10);

bool run_in_shell(const std::string& command, std::string& text) {
  std::FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr) return false;
  char chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, output)) text.append(chunk, count);
  return pclose(output) == 0;
}

// The first line of gnuplot's output that is neither empty nor a warning.
std::string first_line(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool says = line.find_first_not_of(" \t^") != std::string::npos;
    if (says && line.find("warning:") == std::string::npos) return line;
  }
  return "no message";
}

// Runs gnuplot without the user's settings.
Status run_gnuplot(const std::string& folder, const std::string& script) {
  std::string message;
  if (run_in_shell(
          "cd " + shell_word(folder) + " && LC_ALL=C gnuplot -d " + shell_word(script) + " 2>&1 >/dev/null </dev/null",
          message))
    return {};
  return Error{"gnuplot could not draw " + script + ": " + first_line(message) +
               "; check that it is gnuplot 5.4 or newer with the svg and pngcairo terminals"};
}

// Locks a folder against `remove_abandoned`; -1 if another object has locked it.
int lock_folder(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  close(descriptor);
  return -1;
}

// Removes the scratch folders of programs that were killed: nothing locks them, and they are too old to be locked next.
void remove_abandoned(const std::string& parent, const std::string& name) {
  std::error_code error;
  std::vector<fs::path> abandoned;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    const std::string found = entry.path().filename().string();
    if (!found.starts_with(name) || found.size() != name.size() + kRandomLetters || !entry.is_directory(error))
      continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(error);
    if (!error && age > kLockedBy) abandoned.push_back(entry.path());
  }
  for (const fs::path& path : abandoned) {
    const int lock = lock_folder(path.string());
    if (lock < 0) continue;
    fs::remove_all(path, error);
    close(lock);
  }
}

}  // namespace

ScratchFolder::ScratchFolder(const std::string& parent, const std::string& name)
    : path_(parent + "/" + name + std::string(kRandomLetters, 'X')) {
  remove_abandoned(parent, name);
  if (mkdtemp(path_.data()) == nullptr) {
    path_.clear();
  } else {
    lock_ = lock_folder(path_);
  }
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

Status find_gnuplot() {
  std::string path;
  if (run_in_shell("command -v gnuplot", path)) return {};
  return Error{"found no gnuplot in PATH, which draws the figures; install it (Debian: apt-get install gnuplot-nox)"};
}

Status draw_plots(const std::string& folder, const std::vector<Plot>& plots) {
  if (const Status found = find_gnuplot(); !found) return found;
  for (const Plot& plot : plots) {
    const auto text = plot_script(plot);
    if (!text) return text.error();
    const std::string script = plot.name + ".gp";
    if (const Status status = write_file_atomically(folder + "/" + script, *text, true); !status) return status;
    if (const Status status = run_gnuplot(folder, script); !status) return status;
    // gnuplot does not report a write that failed.
    for (const char* ending : {".svg", ".png"}) {
      const std::string drawn = plot.name + ending;
      std::error_code missing;
      if (const auto bytes = fs::file_size(folder + "/" + drawn, missing); missing || bytes == 0)
        return Error{"gnuplot wrote no " + drawn + "; check the free space, and that it is gnuplot 5.4 or newer"};
    }
  }
  return {};
}

Status check_plot_path(const std::string& path, bool overwrite) {
  const std::string ending = fs::path(path).extension().string();
  if (ending != ".svg" && ending != ".png")
    return Error{"found --plot " + path + ", expected a file that ends in .svg or .png"};
  const auto trial = AtomicFile::create(path, overwrite);
  return trial ? Status() : trial.error();
}

Status draw_plot(const Plot& plot, const std::string& path, bool overwrite) {
  if (const Status status = check_plot_path(path, overwrite); !status) return status;
  const fs::path parent = fs::path(path).parent_path();
  const ScratchFolder scratch(parent.empty() ? "." : parent.string());
  if (scratch.path().empty()) return Error{"cannot write " + path + ": no folder can be made beside it"};
  if (const Status status = draw_plots(scratch.path(), {plot}); !status) return status;
  const std::string drawn = scratch.path() + "/" + plot.name + fs::path(path).extension().string();
  const auto bytes = read_plain_file(drawn, "a drawing of gnuplot");
  return bytes ? write_file_atomically(path, *bytes, overwrite) : bytes.error();
}

}  // namespace palpate
