// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#ifdef VISCERA_HDF5
#include <hdf5.h>
#endif

#include "cli/small_scene.h"
#include "support/text.h"

namespace viscera {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// Lines of a sweep's table by number of the run; commas in cells are not looked for.
std::map<int, std::string> rowsOf(const std::string& folder) {
  std::map<int, std::string> out;
  for (const std::string& line : linesOf(readFile(folder + "/results.csv"))) {
    if (line.rfind("run,", 0) == 0) continue;
    EXPECT_TRUE(out.emplace(std::stoi(line), line).second) << "twice in the table: " << line;
  }
  return out;
}

#ifdef VISCERA_HDF5
/// A table that `viscera sweep --hdf5` has written.
class Hdf5Table {
 public:
  explicit Hdf5Table(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0) << path;
  }
  ~Hdf5Table() { H5Fclose(file_); }
  bool has(const std::string& name) const { return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0; }
  std::vector<double> numbers(const std::string& name) const {
    return read<double>(name, H5T_FLOAT, H5Tcopy(H5T_NATIVE_DOUBLE));
  }
  std::vector<std::string> texts(const std::string& name) const {
    const std::vector<char*> texts = read<char*>(name, H5T_STRING, textType());
    return {texts.begin(), texts.end()};
  }
  std::string unit(const std::string& name) const {
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    char* text = nullptr;
    if (H5Aexists(dataset, "unit") > 0) H5Aread(H5Aopen(dataset, "unit", H5P_DEFAULT), textType(), &text);
    return text ? text : "";
  }

 private:
  static hid_t textType() {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return type;
  }
  template <class T>
  std::vector<T> read(const std::string& name, H5T_class_t kind, hid_t type) const {
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    EXPECT_EQ(H5Tget_class(H5Dget_type(dataset)), kind) << name;
    std::vector<T> out(static_cast<size_t>(H5Sget_simple_extent_npoints(H5Dget_space(dataset))));
    EXPECT_GE(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), 0) << name;
    return out;
  }
  hid_t file_;
};
const std::vector<std::string> kTables = {"--hdf5"};
#else
const std::vector<std::string> kTables = {};
#endif

class Sweep : public ::testing::Test {
 protected:
  std::string plan(const std::string& text) { return folder_.write("plan.yaml", "scene: block.yaml\n" + text); }
  Ending sweep(const std::string& plan, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"sweep", plan, "--out", out_});
    return viscera(more);
  }
  /// A worker beside this process, which may be killed.
  pid_t worker(const std::string& plan) const {
    const pid_t child = fork();
    if (child != 0) return child;
    execl(VISCERA_COMMAND, VISCERA_COMMAND, "sweep", plan.c_str(), "--out", out_.c_str(), "--jobs", "1",
          kTables.empty() ? nullptr : kTables[0].c_str(), nullptr);
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
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[0].rfind("run,ended,failures,environment.gravity_m_per_s2,solver.dt_fraction,", 0), 0u) << lines[0];
  EXPECT_EQ(lines[2].rfind("1,done,0,\"[0, 0, -9.81]\",0.6,", 0), 0u) << lines[2];
  EXPECT_EQ(lines[4].rfind("3,done,0,\"[0, 0, 0]\",0.5,", 0), 0u) << lines[4];
  const Ending alone = viscera({"run", scene_, "--no-view", "--seconds", "0.02", "--set", "solver.tick_hz=200", "--set",
                                "environment.gravity_m_per_s2=[0, 0, -9.81]", "--set", "solver.dt_fraction=0.6"});
  const auto json = nlohmann::json::parse(linesOf(alone.out).back());
  EXPECT_TRUE(says(lines[2], {json["state_hash"].get<std::string>().c_str()}));
}

TEST_F(Sweep, EveryRunIsOnceInTheTableWhereAWorkerIsKilled) {
  std::string tenths;
  for (int i = 0; i < 20; ++i) tenths += (i ? ", " : "") + std::to_string(0.3 + 0.01 * i);
  const std::string file = plan("seconds: 0.01\ngrid: {solver.dt_fraction: [" + tenths +
                                "], environment.gravity_m_per_s2: [[0, 0, -1], [0, 0, -2], [0, 0, -3], [0, 0, -4], "
                                "[0, 0, -5], [0, 0, -6], [0, 0, -7], [0, 0, -8], [0, 0, -9], [0, 0, -10]]}\n");
  const pid_t killed = worker(file), other = worker(file);
  for (int i = 0; results() < 40 && i < 3000; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  kill(killed, SIGKILL);
  int status = -1;
  waitpid(killed, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  waitpid(other, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  const std::map<int, std::string> rows = rowsOf(out_);
  EXPECT_EQ(rows.size(), 200u);
  for (const auto& [run, row] : rows) EXPECT_TRUE(says(row, {",done,0,"})) << run;
  EXPECT_EQ(results(), 200u);
#ifdef VISCERA_HDF5
  const Hdf5Table table(out_ + "/results.h5");
  const std::vector<double> runs = table.numbers("run");
  EXPECT_EQ(std::set<double>(runs.begin(), runs.end()).size(), 200u);
  EXPECT_EQ(runs.size(), 200u);
  const std::vector<std::string> hashes = table.texts("metrics/state_hash");
  ASSERT_EQ(hashes.size(), 200u);
  for (size_t i = 0; i < runs.size(); ++i) EXPECT_TRUE(says(rows.at(static_cast<int>(runs[i])), {hashes[i].c_str()}));
  for (const std::string& ended : table.texts("ended")) EXPECT_EQ(ended, "done");
#endif
}

#ifdef VISCERA_HDF5
TEST_F(Sweep, WritesNumbersAndTextsWithUnitsAsHdf5) {
  const std::string file = plan(
      "seconds: 0.02\n"
      "grid: {\"bodies[0].material.young_modulus_pa\": [1e4, 2e4, -1],\n"
      "       environment.gravity_m_per_s2: [[0, 0, -9.81]]}\n");
  EXPECT_EQ(sweep(file, {"--hdf5", "--tries", "1"}).status, 1);
  const Hdf5Table table(out_ + "/results.h5");
  EXPECT_EQ(table.numbers("run"), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(table.texts("ended"), (std::vector<std::string>{"done", "done", "failed"}));
  EXPECT_EQ(table.numbers("failures"), (std::vector<double>{0, 0, 1}));
  EXPECT_TRUE(says(table.texts("last_failure")[2], {"young_modulus_pa"}));
  EXPECT_EQ(table.numbers("keys/bodies[0].material.young_modulus_pa"), (std::vector<double>{1e4, 2e4, -1}));
  EXPECT_EQ(table.texts("keys/environment.gravity_m_per_s2")[1], "[0, 0, -9.81]");
  EXPECT_EQ(table.texts("metrics/state_hash")[2], "");
  const std::vector<double> speed = table.numbers("metrics/max_speed_m_per_s");
  EXPECT_GT(speed[0], 0);
  EXPECT_TRUE(std::isnan(speed[2]));
  EXPECT_EQ(table.unit("keys/bodies[0].material.young_modulus_pa"), "Pa");
  EXPECT_EQ(table.unit("metrics/max_speed_m_per_s"), "m/s");
  EXPECT_EQ(table.unit("metrics/node_updates_per_s"), "1/s");
  EXPECT_EQ(table.unit("metrics/dt_s"), "s");
  EXPECT_EQ(table.unit("metrics/max_stretch"), "");
  EXPECT_FALSE(table.has("metrics/nothing"));
}
#else
TEST_F(Sweep, SaysThatItHasNoHdf5) {
  const Ending ending = sweep(plan("seconds: 0.02\n"), {"--hdf5"});
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(says(ending.err, {"built without HDF5", "results.csv"}));
}
#endif

/// In containers that share a folder two workers may have one process number: a draft of one is not the other's.
TEST_F(Sweep, LeavesDraftsOfOthersAlone) {
  const std::string file = plan("seconds: 0.01\n"), others = "half of a table";
  fs::create_directories(out_);
  const pid_t child = fork();
  if (child == 0) {  // a worker whose number is known before it starts
    for (const char* of : {"plan.txt", "results.csv"})
      std::ofstream(out_ + "/" + of + "." + std::to_string(getpid()) + ".draft") << others;
    execl(VISCERA_COMMAND, VISCERA_COMMAND, "sweep", file.c_str(), "--out", out_.c_str(), nullptr);
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

/// The stiffer, and the less compressible, the harder the pad presses back.
TEST_F(Sweep, ShippedCalibrationTellsMaterialsApart) {
  const Ending ending = viscera({"sweep", VISCERA_SOURCE_DIR "/config/sweeps/calibration.yaml", "--out", out_});
  EXPECT_EQ(ending.status, 0) << ending.err;
  std::vector<double> forces;
  for (int run = 0; run < 15; ++run) {
    const std::string file = out_ + "/runs/" + (run < 10 ? "00000" : "0000") + std::to_string(run) + "/result.json";
    const auto result = nlohmann::json::parse(readFile(file));
    EXPECT_EQ(result["governor_trips"], 0) << run;
    forces.push_back(result["peak_force_n"]);
  }
  for (size_t run = 3; run < 15; ++run) EXPECT_GT(forces[run], 1.2 * forces[run - 3]) << run;         // E
  for (const size_t run : {1, 2, 4, 5, 7, 8}) EXPECT_GT(forces[run], 1.02 * forces[run - 1]) << run;  // nu
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
  EXPECT_TRUE(says(rowsOf(out_)[0], {"0,done,0,0.5,"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,failed,3,7,", "solver.dt_fraction"}));
  EXPECT_EQ(sweep(file, {"--tries", "3"}).err.find("run 1"), std::string::npos);  // given up stays so
  ending = sweep(file, {"--tries", "1", "--retry"});
  EXPECT_TRUE(says(ending.err, {"run 1 of 2 failed"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,failed,1,7,"}));
}

TEST_F(Sweep, ARunOverItsLimitIsKilledAndTheNextIsDone) {
  constexpr int kLimit_s = 5;        // the second run takes a quarter of a second, the first a minute or more
  constexpr double kFarLess_s = 40;  // than the first would take
  const std::string file = plan(
      "seconds: 0.5\n"
      "set: {solver.integrator: vbd}\n"
      "grid: {solver.iterations: [10000, 1]}\n");
  const auto start = std::chrono::steady_clock::now();
  const Ending ending = sweep(file, {"--run-limit-s", std::to_string(kLimit_s), "--tries", "1", "--jobs", "1"});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(ending.status, 1) << ending.err;
  EXPECT_GE(took.count(), kLimit_s);
  EXPECT_LT(took.count(), kFarLess_s);
  EXPECT_TRUE(says(rowsOf(out_)[0], {"0,failed,1,10000,", "over its 5 s"}));
  EXPECT_TRUE(says(rowsOf(out_)[1], {"1,done,0,1,"}));
}

TEST_F(Sweep, IsGivenToSlurmAsAJobArray) {
  // In place of Slurm's sbatch: takes what it is given, and does what two of the array's jobs would.
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
  EXPECT_TRUE(says(absent.err, {"sbatch is not there", "slurm.sh"}));
}

TEST_F(Sweep, RefusesWhatItDoesNotUnderstand) {
  const auto fault = [&](const std::string& text) { return sweep(plan(text)).err; };
  EXPECT_TRUE(says(fault("grit: {}\n"), {"plan.yaml:2: unknown key 'grit'", "grid"}));
  EXPECT_TRUE(says(fault("grid: {solver.dt_fraction: 0.5}\n"), {"plan.yaml:2: ", "list of values"}));
  EXPECT_TRUE(says(fault("list: {solver.dt_fraction: 0.5}\n"), {"plan.yaml:2: ", "list of maps"}));
  EXPECT_TRUE(says(fault("view: perhaps\n"), {"plan.yaml:2: ", "true or false", "perhaps"}));
  EXPECT_TRUE(says(fault("set: {solver.dt_fraction: 0.5}\ngrid: {solver.dt_fraction: [0.6]}\n"),
                   {"plan.yaml: ", "solver.dt_fraction", "two values"}));
  EXPECT_TRUE(says(sweep(folder_.write("none.yaml", "seconds: 1\n")).err, {"none.yaml: 'scene' is missing"}));
  EXPECT_TRUE(says(sweep(folder_.file("absent.yaml")).err, {"absent.yaml"}));
  EXPECT_EQ(sweep(plan("seconds: 0.01\n")).status, 0);
  EXPECT_TRUE(says(fault("seconds: 0.02\n"), {out_ + " holds the runs of another plan"}));
}

}  // namespace
}  // namespace viscera
