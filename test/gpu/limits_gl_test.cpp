// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/limits.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "gpu/buffer.h"
#include "gpu/fence.h"
#include "gpu/gl.h"
#include "gpu/program.h"
#include "gpu/readback.h"
#include "gpu/storage_blocks.h"
#include "support/text.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {
namespace {

using test::messageOf;
using test::says;

TEST(GpuLimits, ThatAreTooSmallAreNamedWithWhatIsNeeded) {
  Limits driver = neededLimits();
  EXPECT_NO_THROW(requireLimits(driver, neededLimits()));
  driver.storage_bindings = 8;
  driver.groups = 1024;
  const std::string said = messageOf<GpuError>([&] { requireLimits(driver, neededLimits()); });
  EXPECT_TRUE(
      says(said, {"GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS is 8", "79", "GL_MAX_COMPUTE_WORK_GROUP_COUNT is 1024"}));
  EXPECT_EQ(said.find("TEXTURE"), std::string::npos) << said;
}

TEST(GpuFence, ThatNeverPassesIsWaitedForSoLongAndNoLonger) {
  int polls = 0;
  const auto never = [&polls](uint64_t) {
    ++polls;
    return FenceState::kPending;
  };
  const std::string said = messageOf<GpuError>([&] { awaitFence(never, "the measurements", 0.01); });
  EXPECT_TRUE(says(said, {"0.01 s", "the measurements"}));
  EXPECT_GT(polls, 0);
  EXPECT_THROW(awaitFence([](uint64_t) { return FenceState::kFailed; }, "an image"), GpuError);
  EXPECT_NO_THROW(awaitFence([](uint64_t) { return FenceState::kPassed; }, "an image"));
}

TEST(GpuFence, IsAskedOnceMoreAfterAProcessWasStopped) {
  int polls = 0;
  const auto slept = [&polls](uint64_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    return ++polls == 1 ? FenceState::kPending : FenceState::kPassed;
  };
  EXPECT_NO_THROW(awaitFence(slept, "an image", 0.01));
  EXPECT_EQ(polls, 2);
}

TEST(GpuLimits, OfAKernelsBlocksAreNamedWithItAndWhatItNeeds) {
  Limits driver = neededLimits();
  EXPECT_NO_THROW(requireStorageBlocks(driver, "x.comp", driver.storage_blocks));
  const std::string said = messageOf<GpuError>([&] { requireStorageBlocks(driver, "x.comp", 15); });
  EXPECT_TRUE(
      says(said, {"GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS is 8 and must be 15", "'x.comp'", "solver.backend: cpu"}));
}

class GpuErrors : public ::testing::Test {
 protected:
  ~GpuErrors() override { clearDriverLimits(); }
  Context context_;
};

/// Kernels with contacts that pd solves, with and without features that have their own blocks.
const std::vector<std::string> kAhead = {"GROUP_SIZE 64", "LATTICE", "AHEAD", "INCREMENT"};

TEST_F(GpuErrors, ComeBeforeAKernelHasMoreBlocksThanTheDriverAllows) {
  Limits small = driverLimits();
  EXPECT_NO_THROW(Program::compute("collision_record.comp", kAhead).finish());
  small.storage_blocks = 8;
  pretendDriverLimits(small);
  const std::string said = messageOf<GpuError>([] { Program::compute("collision_record.comp", kAhead); });
  EXPECT_TRUE(says(said, {"GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS is 8 and must be 1", "'collision_record.comp'"}));
}

class GpuErrorsOfBlocks : public GpuErrors, public ::testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(Loads, GpuErrorsOfBlocks, ::testing::Bool());

TEST_P(GpuErrorsOfBlocks, CountAsTheDriverDoes) {
  Limits limits = driverLimits();
  limits.loads = GetParam();
  pretendDriverLimits(limits);
  std::vector<std::string> tabulated = kAhead, texels = kAhead;
  tabulated.insert(tabulated.end(), {"NETWORK", "PARTS", "LAW"});
  texels.push_back("TEXELS");
  for (const auto& features : {kAhead, tabulated, texels}) {
    for (const char* kernel : {"collision_meet.comp", "measure.comp"}) {
      const Program program = Program::compute(kernel, features);
      const std::vector<std::string> defines = withLoads(kernel, features);
      program.use();
      GLint id = 0, active = 0;
      glGetIntegerv(GL_CURRENT_PROGRAM, &id);
      glGetProgramInterfaceiv(static_cast<GLuint>(id), GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &active);
      EXPECT_EQ(declaredStorageBlocks(shaderSource(kernel, defines)), static_cast<size_t>(active)) << kernel;
    }
  }
}

TEST_F(GpuErrors, OfMemoryNameTheBufferAndItsSize) {
  constexpr size_t kTooMuch = size_t{1} << 50;
  const std::string said = messageOf<GpuError>([] { RawBuffer(kTooMuch, "velocity"); });
  EXPECT_TRUE(says(said, {"'velocity'", std::to_string(kTooMuch), "spacing_m"}));
  const std::string ring = messageOf<GpuError>([] { ReadbackRing(kTooMuch, 1, "the surface"); });
  EXPECT_TRUE(says(ring, {"the surface", std::to_string(kTooMuch)}));
  EXPECT_NO_THROW(Buffer<uint32_t>(10));  // nothing is left pending
}

TEST_F(GpuErrors, LeaveNoBytesCounted) {
  const size_t before = bufferBytes();
  {
    RawBuffer kept(64, "kept");
    const RawBuffer moved = std::move(kept);
    messageOf<GpuError>([] { RawBuffer(size_t{1} << 50, "refused"); });
    EXPECT_EQ(bufferBytes(), before + 64);
  }
  EXPECT_EQ(bufferBytes(), before);
}

TEST_F(GpuErrors, OfBlocksThatAreTooLongNameTheBufferAndTheLimit) {
  Limits small = driverLimits();
  if (small.storage_block_bytes > (size_t{1} << 28)) GTEST_SUCCEED() << "such a buffer is too large for a test";
  if (small.storage_block_bytes > (size_t{1} << 28)) return;
  const RawBuffer buffer(small.storage_block_bytes + 16, "links");
  const std::string said = messageOf<GpuError>([&] { buffer.bindStorage(1); });
  EXPECT_TRUE(says(said, {"'links'", "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", std::to_string(small.storage_block_bytes)}));
}

TEST_F(GpuErrors, OfALostContextSayWhoseFaultItIs) {
  EXPECT_NO_THROW(requireNoReset(GL_NO_ERROR, "a tick"));
  EXPECT_TRUE(
      says(messageOf<GpuError>([] { requireNoReset(GL_GUILTY_CONTEXT_RESET, "a tick"); }),
           {"reset the GPU", "this program", "context and its memory are lost", "a tick", "solver.backend: cpu"}));
  EXPECT_TRUE(
      says(messageOf<GpuError>([] { requireNoReset(GL_INNOCENT_CONTEXT_RESET, "a tick"); }), {"another program"}));
  EXPECT_TRUE(
      says(messageOf<GpuError>([] { requireNoReset(GL_UNKNOWN_CONTEXT_RESET, "a tick"); }), {"for an unknown reason"}));
}

/// Only a context with this strategy reports resets; drivers without support create one without.
TEST_F(GpuErrors, ResetsAreToldOfWhereTheDriverCan) {
  GLint strategy = 0;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  EXPECT_TRUE(strategy == GL_LOSE_CONTEXT_ON_RESET || strategy == GL_NO_RESET_NOTIFICATION) << strategy;
  RecordProperty("tells_of_resets", strategy == GL_LOSE_CONTEXT_ON_RESET);
  EXPECT_NO_THROW(checkErrors("a test"));
}

TEST_F(GpuErrors, OfAKernelNameIt) {
  const Program fold = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  const Buffer<uint32_t> partials(64), stats(64);
  fold.use();
  EXPECT_EQ(lastKernel(), "sum_impulses.comp");
  glEnable(0xffff);  // an error made elsewhere
  const std::string said = messageOf<GpuError>([] { checkErrors("a test"); });
  EXPECT_TRUE(says(said, {"a test", "0x0500", "GL_INVALID_ENUM"}));
}

}  // namespace
}  // namespace viscera::gpu
