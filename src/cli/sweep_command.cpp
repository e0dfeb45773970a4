// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "cli/commands.h"
#include "cli/sweep_folder.h"
#include "math/number_text.h"
#include "math/out_file.h"
#include "math/processors.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

constexpr std::chrono::milliseconds kRetryAfter{500};  // period of checking runs that others have claimed

/// Returns the last line of a file that is not empty.
std::string lastLine(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

std::string shellQuoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// A pipe that a program keeps open while it runs.
class LifeLine {
 public:
  LifeLine() {
    if (pipe2(ends_, O_CLOEXEC) != 0) throw Error("a session cannot be started: no more files can be opened");
  }
  ~LifeLine() {
    close(ends_[0]);
    letGo();
  }
  LifeLine(const LifeLine&) = delete;
  LifeLine& operator=(const LifeLine&) = delete;
  int held() const { return ends_[1]; }  ///< end of the pipe that the program inherits
  /// Closes this process's end, so that only the program keeps the pipe open.
  void letGo() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }
  /// Waits for the program's end. @param limit_s  0: no limit   @return false: it has not ended in time
  bool endsWithin(int limit_s) const {
    using std::chrono::milliseconds;
    constexpr milliseconds kLongestWait{3'600'000};  // limit of one call
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(limit_s);
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
      if (limit_s > 0 && left.count() <= 0) return false;
      pollfd closed{ends_[0], POLLIN, 0};
      if (poll(&closed, 1, limit_s > 0 ? static_cast<int>(std::min(left, kLongestWait).count()) : -1) > 0) return true;
    }
  }

 private:
  int ends_[2];
};

/// Runs a program until it ends or its time is over. It does not outlive the calling thread.
/// @param inherited  file descriptor that it inherits   @param limit_s  0: none
/// @return its wait status; nothing: it was killed because its time was over
std::optional<int> runToEnd(const std::string& program, const std::vector<std::string>& arguments,
                            const std::string& out, const std::string& err, int inherited, int limit_s) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  LifeLine life;
  const pid_t parent = getpid(), child = fork();
  if (child < 0) throw Error("a session cannot be started: no more processes can be created");
  if (child == 0) {  // only system calls are allowed between fork and exec
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    for (const int kept : {inherited, life.held()}) fcntl(kept, F_SETFD, 0);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  life.letGo();
  const bool ended = life.endsWithin(limit_s);
  if (!ended) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return ended ? std::optional<int>(status) : std::nullopt;
}

/// Returns a text on how a program without a result ended. @param ended  result of runToEnd()
std::string howItFailed(const std::optional<int>& ended, int limit_s, const std::string& last_line) {
  if (!ended) return "killed after " + std::to_string(limit_s) + " s (--run-limit-s)";
  return (WIFSIGNALED(*ended) ? "ended by signal " + std::to_string(WTERMSIG(*ended))
                              : "exit status " + std::to_string(WEXITSTATUS(*ended))) +
         ": " + last_line;
}

class Sweep {
 public:
  Sweep(const SweepOptions& options, const SweepPlan& plan)
      : options_(options), plan_(plan), folder_(options.out, plan, options.tries) {
    program_ = std::filesystem::read_symlink("/proc/self/exe").string();
    if (options.retry) folder_.clearFailures();
  }

  /// Runs the sweep. @return number of runs that were given up
  size_t run() {
    std::vector<std::thread> threads;
    for (int i = 0; i < options_.jobs; ++i) threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (fault_) std::rethrow_exception(fault_);
    folder_.writeTable();
    size_t given_up = 0;
    for (size_t run = 0; run < plan_.runs.size(); ++run)
      given_up += folder_.state(run) == SweepFolder::State::kGivenUp ? 1 : 0;
    return given_up;
  }

 private:
  /// Claims and runs free runs until none is open. Runs of other processes are checked again, since those may die.
  void work() {
    try {
      while (!stop_) {
        bool open = false, did = false;
        for (size_t run = 0; run < plan_.runs.size() && !stop_; ++run) {
          if (folder_.state(run) != SweepFolder::State::kOpen) continue;
          open = true;
          const std::optional<SweepFolder::Claim> claim = folder_.claim(run);
          if (!claim) continue;
          make(run, *claim);
          did = true;
        }
        if (!open) return;
        if (!did) std::this_thread::sleep_for(kRetryAfter);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!fault_) fault_ = std::current_exception();
      stop_ = true;
    }
  }

  void make(size_t run, const SweepFolder::Claim& claim) {
    const std::string run_folder = folder_.runFolder(run);
    std::vector<std::string> arguments = plan_.arguments(run);
    // Concurrent sessions use one CPU thread each. The state hash does not depend on it.
    if (options_.jobs > 1 && !plan_.sets("solver.threads"))
      arguments.insert(arguments.end(), {"--set", "solver.threads=1"});
    if (plan_.keep) arguments.insert(arguments.end(), {"--out", run_folder + "/out"});
    const std::optional<int> ended = runToEnd(program_, arguments, run_folder + "/output.txt",
                                              run_folder + "/error.txt", claim.file(), options_.run_limit_s);
    const std::string said = lastLine(run_folder + "/output.txt");
    const std::string why = howItFailed(ended, options_.run_limit_s, lastLine(run_folder + "/error.txt"));
    const bool done = ended == 0 && nlohmann::json::parse(said, nullptr, false).is_object();
    if (done)
      folder_.keepResult(run, said);
    else
      folder_.keepFailure(run, why);
    const std::lock_guard<std::mutex> lock(mutex_);
    std::cerr << "run " << run << " of " << plan_.runs.size() << (done ? " done" : " failed");
    if (!done && !std::exchange(printed_reason_, true)) std::cerr << ": " << why;
    std::cerr << std::endl;
  }

  const SweepOptions& options_;
  const SweepPlan& plan_;
  SweepFolder folder_;
  std::string program_;
  std::mutex mutex_;
  std::exception_ptr fault_;
  std::atomic<bool> stop_{false};
  bool printed_reason_ = false;  ///< whether the first failure was printed; all are in the folder
};

/// Submits a job array of Slurm. Each job works on the remaining runs; a requeued job continues.
void submit(const SweepOptions& options) {
  const auto absolute = [](const std::string& path) { return shellQuoted(std::filesystem::absolute(path).string()); };
  const char* launcher = std::getenv("VISCERA_LAUNCHER");  // of a bundle: finds the libraries of each machine
  const std::string program = launcher ? launcher : std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string script = options.out + "/slurm.sh", jobs = options.jobs > 0 ? std::to_string(options.jobs) : "";
  TextOut text;
  text << "#!/bin/sh\n#SBATCH --job-name=viscera\n#SBATCH --array=0-" << options.slurm - 1
       << "\n#SBATCH --requeue\n#SBATCH --output=" << std::filesystem::absolute(options.out).string()
       << "/slurm-%A_%a.txt\nexec " << shellQuoted(program) << " sweep " << absolute(options.plan) << " --out "
       << absolute(options.out) << " --tries " << options.tries << " --run-limit-s " << options.run_limit_s
       << " --jobs " << (jobs.empty() ? "\"${SLURM_CPUS_PER_TASK:-1}\"" : jobs) << "\n";
  writeFile(script, FileKind::kText, text.str());
  const int status = std::system(("sbatch " + options.sbatch + " " + absolute(script)).c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw Error("sbatch, the command of Slurm that submits jobs, was not found; its script is in " + script);
  if (status != 0) throw Error("sbatch refused " + script);
}

}  // namespace

int sweep(const SweepOptions& given) {
  SweepOptions options = given;
  if (options.jobs == 0) options.jobs = usableProcessors();
  const SweepPlan plan = readSweepPlan(options.plan);
  if (options.slurm > 0) {
    const SweepFolder folder(options.out, plan, options.tries);
    if (options.retry) folder.clearFailures();
    submit(given);
    return 0;
  }
  const size_t given_up = Sweep(options, plan).run();
  std::cout << options.out << "/results.csv: " << plan.runs.size() << " runs, " << given_up << " given up\n";
  return given_up > 0 ? 1 : 0;
}

}  // namespace viscera::cli
