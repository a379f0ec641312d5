#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "scenes/cli/verbs.h"
#include "scenes/report/publish.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// The state of a run, in memory that all its processes share. A message longer than its place is cut.
struct Shared {
  static constexpr std::size_t kMessage = 1024;
  std::atomic<std::size_t> next{0}, done{0};
  char problems[1][kMessage];  // as many as there are jobs

  static Shared* make(std::size_t jobs) {
    void* const memory =
        mmap(nullptr, sizeof(Shared) + jobs * kMessage, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? nullptr : new (memory) Shared;  // anonymous memory is zero
  }
};
static_assert(std::atomic<std::size_t>::is_always_lock_free);

struct Job {
  fs::path recording, result;
};

Result<std::vector<Job>> jobs_of(const FolderRun& run) {
  const auto recordings = recordings_in({run.folder});
  if (!recordings) return recordings.error();
  std::vector<Job> jobs;
  for (const fs::path recording : *recordings)
    jobs.push_back({recording, fs::path(run.out) / (recording.stem().string() + run.result)});
  return jobs;
}

// Makes the folder, or continues in one that the same command has made.
Status enter(const FolderRun& run) {
  const std::string mark = run.out + "/command.txt";
  std::error_code error;
  if (fs::exists(run.out, error) && !run.force) {
    const auto command = read_whole_file(mark);
    if (!command || *command != kept_command() + "\n") {
      return Error{run.out +
                   " exists, and this command has not made it; name another folder, or replace it with --force"};
    }
    return {};
  }
  fs::create_directories(run.out, error);
  if (error) return Error{"cannot make the folder " + run.out + ": " + error.message()};
  return write_file_atomically(mark, kept_command() + "\n", true);
}

bool is_done(const Job& job) {
  std::error_code error;
  const auto made = fs::last_write_time(job.result, error);
  return !error && made >= fs::last_write_time(job.recording, error) && !error;
}

[[noreturn]] void work(const FolderRun& run, const std::vector<Job>& jobs, Shared& shared) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends with the program
  limit_threads(1);
  hide_progress();
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
  for (std::size_t i = shared.next++; i < jobs.size() && stop_requested() == 0; i = shared.next++) {
    if (const Status done = run.job(jobs[i].recording.string(), jobs[i].result.string()); !done)
      std::strncpy(shared.problems[i], done.error().message.c_str(), Shared::kMessage - 1);
    ++shared.done;
  }
  _exit(0);
}

// `left`: the jobs whose messages are in `shared`.
Status write_table(const FolderRun& run, const std::vector<Job>& jobs, const std::vector<Job>& left,
                   const Shared& shared) {
  std::vector<std::string> keys;
  std::vector<FolderRun::Row> rows;
  for (const Job& job : jobs) {
    rows.push_back(is_done(job) ? run.row(job.result.string()) : FolderRun::Row{});
    for (const auto& [key, value] : rows.back())
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  }
  Table table{.name = run.table};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    table.begin_row();
    table.add({"recording", ""}, jobs[i].recording.stem().string());
    for (const std::string& key : keys) {
      const auto found = std::ranges::find(rows[i], key, &std::pair<std::string, nlohmann::ordered_json>::first);
      table.add({key, ""}, found != rows[i].end() ? found->second : nlohmann::ordered_json(""));
    }
    const auto at = std::ranges::find(left, jobs[i].recording, &Job::recording);
    table.add({"problem", ""}, at != left.end() ? shared.problems[at - left.begin()] : "");
  }
  return write_file_atomically(run.out + "/" + run.table + ".csv", table_csv(table), true);
}

}  // namespace

bool is_folder(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

Result<std::vector<std::string>> recordings_in(const std::vector<std::string>& paths) {
  std::vector<std::string> all;
  for (const std::string& path : paths) {
    if (!is_folder(path)) {
      all.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
      if (entry.path().extension() == ".csv") found.push_back(entry.path().string());
    if (error) return Error{"cannot list the folder " + path + ": " + error.message()};
    if (found.empty()) return Error{"found no .csv file in the folder " + path + ", expected recordings"};
    std::ranges::sort(found);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

Status run_folder(const FolderRun& run) {
  const auto jobs = jobs_of(run);
  if (!jobs) return jobs.error();
  if (const Status entered = enter(run); !entered) return entered;
  std::vector<Job> left;
  std::ranges::copy_if(*jobs, std::back_inserter(left), [&](const Job& job) { return run.force || !is_done(job); });
  Shared* const shared = Shared::make(jobs->size());
  if (shared == nullptr) return Error{"out of memory"};
  ProgressLine line(run.label);
  std::vector<pid_t> workers;
  const std::size_t count = std::min(left.size(), static_cast<std::size_t>(thread_count()));
  for (std::size_t i = 0; i < count; ++i) {
    const pid_t child = fork();
    if (child == 0) work(run, left, *shared);
    if (child > 0) workers.push_back(child);
  }
  if (workers.empty() && !left.empty()) return Error{"cannot start a process"};
  bool stopped = false;
  for (std::size_t ended = 0; ended < workers.size();) {
    const double share = static_cast<double>(shared->done) / static_cast<double>(std::max<std::size_t>(1, left.size()));
    if (!line.update(share) && !std::exchange(stopped, true))
      for (const pid_t child : workers) kill(child, SIGTERM);
    if (waitpid(-1, nullptr, WNOHANG) > 0)
      ++ended;
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (const Status written = write_table(run, *jobs, left, *shared); !written) return written;
  std::string problems;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (is_done(left[i])) continue;
    ++failed;
    problems += "\n  " + left[i].recording.string() + ": " +
                (shared->problems[i][0] != '\0' ? shared->problems[i]
                 : stopped                      ? "interrupted"
                                                : "its process ended");
  }
  std::printf("%zu of %zu recordings are done, %zu of them before; table %s/%s.csv\n", jobs->size() - failed,
              jobs->size(), jobs->size() - left.size(), run.out.c_str(), run.table.c_str());
  if (failed == 0) return {};
  return Error{std::to_string(failed) + " of " + std::to_string(jobs->size()) +
               " recordings are not done; the same command continues:" + problems};
}

}  // namespace palpate::cli
