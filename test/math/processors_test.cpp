// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/processors.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>

#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

class Quota : public ::testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder_.file(file)).parent_path());
    folder_.write(file, text);
  }
  double of(const std::string& groups) const { return processorQuota(folder_.path(), groups).value_or(-1); }

  TemporaryFolder folder_;
};

TEST_F(Quota, IsTheLeastOfAGroupAndThoseItIsIn) {
  write("cpu.max", "max 100000\n");
  write("user.slice/cpu.max", "150000 100000\n");
  write("user.slice/run.scope/cpu.max", "400000 100000\n");
  EXPECT_EQ(of("0::/user.slice/run.scope\n"), 1.5);
  EXPECT_EQ(of("0::/user.slice\n"), 1.5);
  EXPECT_EQ(of("0::/\n"), -1);
}

TEST_F(Quota, OfAContainerIsAtItsRoot) {
  write("cpu.max", "200000 100000\n");
  EXPECT_EQ(of("0::/\n"), 2);
  EXPECT_EQ(of("0::/docker/0123abc\n"), 2) << "paths of the host";
}

TEST_F(Quota, OfVersion1IsOfTheControllerCpu) {
  write("cpu,cpuacct/job/cpu.cfs_quota_us", "50000\n");
  write("cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  write("cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  write("cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(of("5:memory:/job\n4:cpu,cpuacct:/job\n0::/\n"), 0.5);
  EXPECT_EQ(of("5:cpuset:/job\n4:cpu,cpuacct:/other\n"), -1);
}

TEST_F(Quota, IsNoneWhereNothingSaysSo) {
  for (const char* groups : {"", "\n", "nonsense", "0::", "1:cpu:/", "0::/none"}) EXPECT_EQ(of(groups), -1) << groups;
  write("cpu.max", "0 0\n");
  EXPECT_EQ(of("0::/\n"), -1);
}

TEST(Processors, AreThoseOfTheAffinity) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_GE(usableProcessors(), 1);
  EXPECT_LE(usableProcessors(), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu) {
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(usableProcessors(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
}

}  // namespace
}  // namespace viscera
