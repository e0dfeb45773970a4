// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/text.h"

namespace viscera {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// Returns the lines of a sweep's table by number of the run; commas within cells are not handled.
std::map<int, std::string> rowsOf(const std::string& folder) {
  std::map<int, std::string> out;
  for (const std::string& line : linesOf(readFile(folder + "/results.csv"))) {
    if (line.rfind("run,", 0) == 0 || line.rfind(",", 0) == 0) continue;  // names, units
    EXPECT_TRUE(out.emplace(std::stoi(line), line).second) << "twice in the table: " << line;
  }
  return out;
}

class Sweep : public ::testing::Test {
 protected:
  std::string plan(const std::string& text) { return folder_.write("plan.yaml", "scene: block.yaml\n" + text); }
  Ending sweep(const std::string& plan, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"sweep", plan, "--out", out_});
    return viscera(more);
  }
  /// Starts a worker process, which may be killed.
  pid_t worker(const std::string& plan) const {
    const pid_t child = fork();
    if (child != 0) return child;
    execl(kCommand, kCommand, "sweep", plan.c_str(), "--out", out_.c_str(), "--jobs", "1", nullptr);
    _exit(127);
  }
  size_t results() const {
    size_t count = 0;
    std::error_code error;
    for (const auto& run : fs::directory_iterator(out_ + "/runs", error))
      count += fs::exists(run.path() / "result.json");
    return count;
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene), out_ = folder_.file("out");
};

TEST_F(Sweep, RunsEveryCombinationOnceAndSaysWhatEachGave) {
  const std::string file = plan(
      "seconds: 0.02\n"
      "set: {solver.tick_hz: 200}\n"
      "list: [{environment.gravity_m_per_s2: [0, 0, -9.81]}, {environment.gravity_m_per_s2: [0, 0, 0]}]\n"
      "grid: {solver.dt_fraction: [0.5, 0.6, 0.7]}\n");
  const Ending ending = sweep(file);
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"results.csv: 6 runs, 0 given up"}));
  const std::vector<std::string> lines = linesOf(readFile(out_ + "/results.csv"));
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[0].rfind("run,ended,failures,environment.gravity_m_per_s2,solver.dt_fraction,", 0), 0u) << lines[0];
  EXPECT_EQ(lines[3].rfind("1,done,0,\"[0, 0, -9.81]\",0.6,", 0), 0u) << lines[3];
  EXPECT_EQ(lines[5].rfind("3,done,0,\"[0, 0, 0]\",0.5,", 0), 0u) << lines[5];
  const Ending alone = viscera({"run", scene_, "--no-view", "--seconds", "0.02", "--set", "solver.tick_hz=200", "--set",
                                "environment.gravity_m_per_s2=[0, 0, -9.81]", "--set", "solver.dt_fraction=0.6"});
  const auto json = nlohmann::json::parse(linesOf(alone.out).back());
  EXPECT_TRUE(says(lines[3], {json["state_hash"].get<std::string>().c_str()}));
}

TEST_F(Sweep, EveryRunIsOnceInTheTableWhereAWorkerIsKilled) {
  std::string tenths;
  for (int i = 0; i < 3; ++i) tenths += (i ? ", " : "") + std::to_string(0.3 + 0.01 * i);
  const std::string file = plan("seconds: 0.01\ngrid: {solver.dt_fraction: [" + tenths +
                                "], environment.gravity_m_per_s2: [[0, 0, -1], [0, 0, -2], [0, 0, -3], [0, 0, -4], "
                                "[0, 0, -5], [0, 0, -6], [0, 0, -7], [0, 0, -8], [0, 0, -9], [0, 0, -10]]}\n");
  const pid_t killed = worker(file), other = worker(file);
  for (int i = 0; results() < 15 && i < 3000; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  kill(killed, SIGKILL);
  int status = -1;
  waitpid(killed, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  waitpid(other, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  const std::map<int, std::string> rows = rowsOf(out_);
  EXPECT_EQ(rows.size(), 30u);
  for (const auto& [run, row] : rows) EXPECT_TRUE(says(row, {",done,0,"})) << run;
  EXPECT_EQ(results(), 30u);
}

TEST_F(Sweep, HasALineOfUnitsBelowTheNames) {
  EXPECT_EQ(sweep(plan("seconds: 0.02\ngrid: {\"bodies[0].material.young_modulus_pa\": [1e4, -1]}\n"), {"--tries", "1"})
                .status,
            1);
  const std::vector<std::string> lines = linesOf(readFile(out_ + "/results.csv"));
  ASSERT_EQ(lines.size(), 4u);
  std::map<std::string, std::string> units;
  std::istringstream names(lines[0]), below(lines[1]);
  for (std::string name, unit; std::getline(names, name, ',');) {
    std::getline(below, unit, ',');
    units[name] = unit;
  }
  EXPECT_EQ(units.at("run"), "");
  EXPECT_EQ(units.at("bodies[0].material.young_modulus_pa"), "Pa");
  EXPECT_EQ(units.at("max_speed_m_per_s"), "m/s");
  EXPECT_EQ(units.at("node_updates_per_s"), "1/s");
  EXPECT_EQ(units.at("dt_s"), "s");
  EXPECT_EQ(units.at("max_stretch"), "");
  EXPECT_TRUE(says(lines[3], {"1,failed,1,-1,", "young_modulus_pa"}));
}

/// In containers that share a folder two workers may have the same process id: each must leave the other's drafts
/// alone.
TEST_F(Sweep, LeavesDraftsOfOthersAlone) {
  const std::string file = plan("seconds: 0.01\n"), others = "half of a table";
  fs::create_directories(out_);
  const pid_t child = fork();
  if (child == 0) {  // a worker with a known process id
    for (const char* of : {"plan.txt", "results.csv"})
      std::ofstream(out_ + "/" + of + "." + std::to_string(getpid()) + ".draft") << others;
    execl(kCommand, kCommand, "sweep", file.c_str(), "--out", out_.c_str(), nullptr);
    _exit(127);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(rowsOf(out_).size(), 1u);
  size_t drafts = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out_)) {
    if (entry.path().extension() != ".draft") continue;
    ++drafts;
    EXPECT_EQ(readFile(entry.path()), others) << entry.path();
  }
  EXPECT_EQ(drafts, 2u);
}

/// The pad's force grows with stiffness and with incompressibility.
TEST_F(Sweep, ShippedCalibrationDistinguishesMaterials) {
  const Ending ending = viscera({"sweep", sourceFolder() + "/config/sweeps/calibration.yaml", "--out", out_});
  EXPECT_EQ(ending.status, 0) << ending.err;
  std::vector<double> forces;
  for (int run = 0; run < 15; ++run) {
    const std::string file = out_ + "/runs/" + (run < 10 ? "00000" : "0000") + std::to_string(run) + "/result.json";
    const auto result = nlohmann::json::parse(readFile(file));
    EXPECT_EQ(result["roll_backs"], 0) << run;
    forces.push_back(result["peak_force_n"]);
  }
  for (size_t run = 3; run < 15; ++run) EXPECT_GT(forces[run], 1.2 * forces[run - 3]) << run;         // by E
  for (const size_t run : {1, 2, 4, 5, 7, 8}) EXPECT_GT(forces[run], 1.02 * forces[run - 1]) << run;  // by nu
}

TEST_F(Sweep, GoesOnWhereItWasEnded) {
  const std::string file = plan("seconds: 0.02\ngrid: {solver.dt_fraction: [0.5, 0.6]}\n");
  EXPECT_EQ(sweep(file).status, 0);
  const std::string first = out_ + "/runs/000000/result.json", second = out_ + "/runs/000001/result.json";
  const auto made = fs::last_write_time(first);
  const std::string before = readFile(second);
  fs::remove(second);
  EXPECT_EQ(sweep(file).status, 0);
  EXPECT_EQ(fs::last_write_time(first), made);
  EXPECT_EQ(nlohmann::json::parse(readFile(second))["state_hash"], nlohmann::json::parse(before)["state_hash"]);
}

TEST_F(Sweep, TriesAgainAndSaysWhatFailed) {
  const std::string file = plan("seconds: 0.02\ngrid: {solver.dt_fraction: [0.5, 7]}\n");
  Ending ending = sweep(file, {"--tries", "3"});
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(says(ending.out, {"2 runs, 1 given up"}));
  EXPECT_TRUE(says(ending.err, {"run 1 of 2 failed: exit status", "solver.dt_fraction"}));
  EXPECT_EQ(ending.err.find("exit status"), ending.err.rfind("exit status")) << "once";
  EXPECT_TRUE(says(rowsOf(out_)[0], {"0,done,0,0.5,"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,failed,3,7,", "solver.dt_fraction"}));
  EXPECT_EQ(sweep(file, {"--tries", "3"}).err.find("run 1"), std::string::npos);  // a run that was given up stays so
  ending = sweep(file, {"--tries", "1", "--retry"});
  EXPECT_TRUE(says(ending.err, {"run 1 of 2 failed"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,failed,1,7,"}));
}

TEST_F(Sweep, ARunOverItsLimitIsKilledAndTheNextIsDone) {
  constexpr int kLimit_s = 3;        // the second run takes a quarter of a second, the first a minute or more
  constexpr double kFarLess_s = 40;  // than the first run would take
  const std::string file = plan(
      "seconds: 0.5\n"
      "set: {solver.integrator: pd}\n"
      "grid: {solver.iterations: [10000, 1]}\n");
  const auto start = std::chrono::steady_clock::now();
  const Ending ending = sweep(file, {"--run-limit-s", std::to_string(kLimit_s), "--tries", "1", "--jobs", "1"});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(ending.status, 1) << ending.err;
  EXPECT_GE(took.count(), kLimit_s);
  EXPECT_LT(took.count(), kFarLess_s);
  EXPECT_TRUE(says(rowsOf(out_)[0], {"0,failed,1,10000,", "killed after 3 s"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,done,0,1,"}));
}

TEST_F(Sweep, IsGivenToSlurmAsAJobArray) {
  // Replaces Slurm's sbatch: records its arguments, and runs two of the array's jobs.
  folder_.write("sbatch", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > " + folder_.file("given") +
                              "\nsh \"$last\" && sh \"$last\"\n");
  fs::permissions(folder_.file("sbatch"), fs::perms::owner_all);
  const std::string file = plan("seconds: 0.02\ngrid: {solver.dt_fraction: [0.5, 0.6]}\n");
  const std::vector<std::string> arguments = {
      "sweep", file, "--out", out_, "--slurm", "3", "--sbatch", "--partition=small --time=5", "--run-limit-s", "600"};
  const Ending ending = viscera(arguments, {"PATH=" + folder_.path() + ":/usr/bin:/bin"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_EQ(readFile(folder_.file("given")), "--partition=small --time=5 " + out_ + "/slurm.sh\n");
  EXPECT_TRUE(
      says(readFile(out_ + "/slurm.sh"), {"#SBATCH --array=0-2\n", "#SBATCH --requeue\n", " --run-limit-s 600 "}));
  EXPECT_EQ(rowsOf(out_).size(), 2u);
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,done,0,0.6,"}));
  const Ending absent = viscera(arguments, {"PATH=" + folder_.file("out")});
  EXPECT_TRUE(says(absent.err, {"sbatch", "was not found", "slurm.sh"}));
}

TEST_F(Sweep, RefusesWhatItDoesNotUnderstand) {
  const auto fault = [&](const std::string& text) { return sweep(plan(text)).err; };
  EXPECT_TRUE(says(fault("grit: {}\n"), {"plan.yaml:2: unknown key 'grit'", "grid"}));
  EXPECT_TRUE(says(fault("grid: {solver.dt_fraction: 0.5}\n"), {"plan.yaml:2: ", "list of values"}));
  EXPECT_TRUE(says(fault("list: {solver.dt_fraction: 0.5}\n"), {"plan.yaml:2: ", "list of maps"}));
  EXPECT_TRUE(says(fault("view: perhaps\n"), {"plan.yaml:2: ", "true or false", "perhaps"}));
  EXPECT_TRUE(says(fault("set: {solver.dt_fraction: 0.5}\ngrid: {solver.dt_fraction: [0.6]}\n"),
                   {"plan.yaml: ", "solver.dt_fraction", "two values"}));
  EXPECT_TRUE(says(fault("seconds: 0.01\nset: {solver.dt_fracton: 0.5}\n"),
                   {"plan.yaml:3: ", "unknown key 'solver.dt_fracton'", "dt_fraction"}));
  EXPECT_TRUE(says(fault("grid: {solver.dt_fraction: [0.5], \"bodies[3].spacing_m\": [0.01]}\n"),
                   {"plan.yaml:2: ", "no bodies[3]"}));
  EXPECT_TRUE(says(fault("grid: {solver.dt_fraction: [7, 0.5], solver.tick: [7]}\n"), {"unknown key 'solver.tick'"}));
  EXPECT_TRUE(says(fault("list:\n- {solver.dt_fraction: 0.5}\n- {solver.tick: 7}\n"),
                   {"plan.yaml:4: ", "unknown key 'solver.tick'"}));
  EXPECT_TRUE(says(sweep(folder_.write("lost.yaml", "scene: absent\n")).err, {"'absent' is neither a file"}));
  EXPECT_FALSE(fs::exists(out_)) << "a run was begun";
  EXPECT_TRUE(says(sweep(folder_.write("none.yaml", "seconds: 1\n")).err, {"none.yaml: 'scene' is missing"}));
  EXPECT_TRUE(says(sweep(folder_.file("absent.yaml")).err, {"absent.yaml"}));
  EXPECT_EQ(sweep(plan("seconds: 0.01\n")).status, 0);
  EXPECT_TRUE(says(fault("seconds: 0.02\n"), {out_ + " contains the runs of another plan"}));
}

}  // namespace
}  // namespace viscera
