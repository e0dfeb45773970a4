// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/host_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

using namespace viscera;

namespace {

constexpr double kKiB = 1024, kMiB = 1024 * kKiB;

class HostMemory : public ::testing::Test {
 protected:
  void put(const std::string& path, const std::string& text) {
    const std::filesystem::path at = root_ + path;
    std::filesystem::create_directories(at.parent_path());
    std::ofstream(at) << text;
  }
  test::TemporaryFolder folder_;
  std::string root_ = folder_.path();
};

}  // namespace

TEST_F(HostMemory, IsWhatTheMachineHasWhereNoGroupLimitsIt) {
  EXPECT_TRUE(std::isinf(availableBytes(root_)));
  put("/proc/meminfo", "MemTotal: 16000 kB\nMemAvailable:   8000 kB\n");
  put("/proc/self/cgroup", "0::/user\n");
  put("/sys/fs/cgroup/user/memory.max", "max\n");
  put("/sys/fs/cgroup/user/memory.current", "5000\n");
  EXPECT_EQ(availableBytes(root_), 8000 * kKiB);
}

TEST_F(HostMemory, IsWhatAGroupOfVersion2OrOneAroundItLeaves) {
  put("/proc/meminfo", "MemAvailable: 16000000 kB\n");
  put("/proc/self/cgroup", "0::/box/inner\n");
  put("/sys/fs/cgroup/box/inner/memory.max", "max\n");
  put("/sys/fs/cgroup/box/inner/memory.current", "1048576\n");
  put("/sys/fs/cgroup/box/memory.max", "104857600\n");
  put("/sys/fs/cgroup/box/memory.current", "41943040\n");
  put("/sys/fs/cgroup/box/memory.stat", "anon 5\ninactive_file 10485760\n");
  EXPECT_EQ(availableBytes(root_), 70 * kMiB);
}

TEST_F(HostMemory, IsWhatAGroupOfVersion1Leaves) {
  put("/proc/meminfo", "MemAvailable: 16000000 kB\n");
  put("/proc/self/cgroup", "4:cpu,cpuacct:/\n3:memory:/docker/x\n");
  put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "209715200\n");  // a container sees its own group here
  put("/sys/fs/cgroup/memory/memory.usage_in_bytes", "104857600\n");
  EXPECT_EQ(availableBytes(root_), 100 * kMiB);
}

TEST(TissueMemory, ThatIsNotThereIsRefusedWithTheSpacingThatFits) {
  constexpr size_t kCells = 8000000;
  constexpr double kTaken = kCells * kBytesPerFilledCell;
  EXPECT_NO_THROW(requireTissueMemory(kCells, 0.001, kBytesPerFilledCell, kTaken));
  const std::string said = test::messageOf<LatticeError>(
      [] { requireTissueMemory(kCells, 0.001, kBytesPerFilledCell, kTaken / 8); });  // half as many in each direction
  EXPECT_TRUE(test::says(said, {"8000000 cells", "spacing_m >= 0.0021"}));
}

TEST(TissueMemory, CountsWhatContactsTakeWhereTheyAreSolvedForToo) {
  Scene scene;
  const double alone = bytesPerFilledCell(scene);
  EXPECT_EQ(alone, kBytesPerFilledCell);
  scene.solver.integrator = Integrator::kPd;
  EXPECT_EQ(bytesPerFilledCell(scene), alone);
  scene.collision.enabled = true;
  // 16 ends of pairs per node, each with two rows of 16 bytes and a word; three rows and two words per node.
  constexpr double kPairs = 16 * (2 * 16 + 4) + 3 * 16 + 2 * 4;
  EXPECT_GT(bytesPerFilledCell(scene), alone + kPairs);
  constexpr size_t kCells = 1000000;
  const double left = kCells * (alone + kPairs);
  EXPECT_THROW(requireTissueMemory(kCells, 0.001, bytesPerFilledCell(scene), left), LatticeError);
  scene.solver.integrator = Integrator::kLeapfrog;
  EXPECT_GT(bytesPerFilledCell(scene), alone);
  EXPECT_NO_THROW(requireTissueMemory(kCells, 0.001, bytesPerFilledCell(scene), left));
}
