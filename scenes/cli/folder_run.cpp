#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "engine/base/files.h"
#include "scenes/cli/verbs.h"
#include "scenes/report/publish.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// Why a job has failed, in memory that it shares with this process; a longer message is cut.
using Problem = std::array<char, 1024>;

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

[[noreturn]] void work(const FolderRun& run, const Job& job, Problem& problem) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // ends with the program
  limit_threads(1);
  hide_progress();
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
  if (const Status done = run.job(job.recording.string(), job.result.string()); !done)
    std::strncpy(problem.data(), done.error().message.c_str(), problem.size() - 1);
  _exit(0);
}

// Runs the jobs, each in a process of its own. Returns false if the user has stopped them.
Result<bool> run_jobs(const FolderRun& run, const std::vector<Job>& jobs, Problem* problems) {
  ProgressLine line(run.label);
  std::vector<pid_t> workers;
  bool stopped = false;
  for (std::size_t begun = 0; !workers.empty() || (begun < jobs.size() && !stopped);) {
    if (begun < jobs.size() && !stopped && workers.size() < static_cast<std::size_t>(thread_count())) {
      const pid_t child = fork();
      if (child == 0) work(run, jobs[begun], problems[begun]);
      if (child < 0 && workers.empty()) return Error{"cannot start a process"};
      if (child > 0) workers.push_back(child), ++begun;
    }
    const double share = static_cast<double>(begun - workers.size()) / static_cast<double>(jobs.size());
    if (!line.update(share) && !std::exchange(stopped, true))
      for (const pid_t child : workers) kill(child, SIGTERM);
    if (const pid_t ended = waitpid(-1, nullptr, WNOHANG); ended > 0)
      std::erase(workers, ended);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return !stopped;
}

// `problems`: of the jobs in `left`.
Status write_table(const FolderRun& run, const std::vector<Job>& jobs, const std::vector<Job>& left,
                   const Problem* problems) {
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
    table.add({"problem", ""}, at != left.end() ? problems[at - left.begin()].data() : "");
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
  const std::size_t bytes = std::max<std::size_t>(1, left.size()) * sizeof(Problem);
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);  // all zero
  if (memory == MAP_FAILED) return Error{"out of memory"};
  auto* const problems = static_cast<Problem*>(memory);
  const auto complete = run_jobs(run, left, problems);
  if (!complete) return complete.error();
  if (const Status written = write_table(run, *jobs, left, problems); !written) return written;
  std::string words;
  std::size_t failed = 0;
  bool corrects = false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (is_done(left[i])) continue;
    ++failed;
    std::string problem = problems[i].data();
    corrects = corrects || !problem.empty();
    if (problem.empty()) problem = *complete ? "its process ended" : "interrupted";
    const std::string& name = left[i].recording.string();
    words += "\n  " + (problem.starts_with(name) ? problem : name + ": " + problem);
  }
  std::printf("%zu of %zu recordings are done, %zu of them before; table %s/%s.csv\n", jobs->size() - failed,
              jobs->size(), jobs->size() - left.size(), run.out.c_str(), run.table.c_str());
  if (failed == 0) return {};
  return Error{
      std::to_string(failed) + " of " + std::to_string(jobs->size()) + " recordings are not done; " +
      (corrects ? "correct what is said of them, then the same command continues:" : "the same command continues:") +
      words};
}

}  // namespace palpate::cli
