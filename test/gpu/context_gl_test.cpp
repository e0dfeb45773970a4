// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/gpu/context.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "gpu/buffer.h"
#include "gpu/limits.h"
#include "gpu/program.h"
#include "gpu/readback.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::gpu;

namespace {

class Gpu : public ::testing::Test {
 protected:
  Context context_;
};

}  // namespace

TEST_F(Gpu, NamesTheDeviceItTook) {
  EXPECT_FALSE(context_.renderer().empty());
  int taken = 0;
  for (const DeviceAttempt& attempt : context_.attempts()) {
    taken += attempt.taken ? 1 : 0;
    EXPECT_FALSE(attempt.reason.empty());
  }
  EXPECT_EQ(taken, 1);
}

TEST_F(Gpu, GoesToAnotherThreadAndBackAndToOneAtATime) {
  Buffer<uint32_t> buffer(std::vector<uint32_t>{1, 2, 3});
  bool taken_too_early = true, taken = false;
  std::vector<uint32_t> seen;
  std::thread([&] { taken_too_early = context_.makeCurrent(); }).join();
  context_.release();
  std::thread([&] {
    taken = context_.makeCurrent();
    seen = buffer.read();
    buffer.write({4, 5, 6});
    context_.release();
  }).join();
  EXPECT_FALSE(taken_too_early);
  EXPECT_TRUE(taken);
  EXPECT_EQ(seen, (std::vector<uint32_t>{1, 2, 3}));
  ASSERT_TRUE(context_.makeCurrent());
  EXPECT_EQ(buffer.read(), (std::vector<uint32_t>{4, 5, 6}));
}

TEST_F(Gpu, BufferStartsAtZeroAndKeepsWhatIsWritten) {
  for (size_t count : {1u, 63u, 64u, 65u, 1234u}) {
    Buffer<uint32_t> buffer(count);
    EXPECT_EQ(buffer.read(), std::vector<uint32_t>(count, 0));
    std::vector<uint32_t> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = static_cast<uint32_t>(i * 2654435761u);
    buffer.write(values);
    EXPECT_EQ(buffer.read(), values);
  }
}

TEST_F(Gpu, ReadbackHandsOverInOrderAndRefusesWhenFull) {
  Buffer<uint32_t> buffer(std::vector<uint32_t>{1, 2, 3});
  ReadbackRing ring(12, 2);
  EXPECT_EQ(ring.collect(nullptr), nullptr);
  EXPECT_TRUE(ring.request({buffer.id(), 0, 12}, 7));
  buffer.write({9, 8, 7});
  EXPECT_TRUE(ring.request({buffer.id(), 4, 8}, 8));
  EXPECT_FALSE(ring.request({buffer.id(), 0, 4}, 9));
  uint64_t tag = 0;
  const auto* first = static_cast<const uint32_t*>(ring.collect(&tag, true));
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(tag, 7u);
  EXPECT_EQ(first[2], 3u);
  ring.release();
  const auto* second = static_cast<const uint32_t*>(ring.collect(&tag, true));
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(tag, 8u);
  EXPECT_EQ(second[1], 7u);
  ring.release();
  EXPECT_EQ(ring.inFlight(), 0);
}

TEST_F(Gpu, MissingShaderIsNamed) {
  try {
    Program::compute("no_such.comp");
    FAIL() << "compiled a shader that does not exist";
  } catch (const GpuError& e) {
    EXPECT_NE(std::string(e.what()).find("no_such.comp"), std::string::npos);
  }
}

TEST_F(Gpu, CompileErrorCarriesTheDriversLog) {
  try {
    Program::compute("lattice.glsl", {"kBrickEdge broken("}).finish();  // a define that breaks the source
    FAIL() << "compiled a broken shader";
  } catch (const GpuError& e) {
    EXPECT_NE(std::string(e.what()).find("layout.h"), std::string::npos) << e.what();
  }
}

TEST_F(Gpu, CompileErrorsAreToldWhereManyAreMade) {
  Limits ahead = driverLimits();
  ahead.compiles_ahead = true;
  pretendDriverLimits(ahead);
  const MadePrograms made;
  const Program good = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  EXPECT_NO_THROW(made.require());
  {
    const Program broken = Program::compute("lattice.glsl", {"kBrickEdge broken("});
    EXPECT_THROW(made.require(), GpuError);
  }
  EXPECT_NO_THROW(made.require()) << "what is gone is not asked for";
  clearDriverLimits();
}

TEST(GpuContext, UnknownDeviceIsRefusedWithTheListOfThoseThereAre) {
  try {
    Context context(4711);
    FAIL() << "took a device that does not exist";
  } catch (const GpuError& e) {
    EXPECT_NE(std::string(e.what()).find("device 4711"), std::string::npos) << e.what();
  }
}

/// Two scenes, of which one replaces the other.
TEST(GpuContext, OutlivesAnotherOneOfTheSameDevice) {
  auto first = std::make_unique<Context>();
  first->release();
  Context second;
  second.release();
  first.reset();
  ASSERT_TRUE(second.makeCurrent());
  EXPECT_NO_THROW(checkErrors("the second context"));
}

TEST(GpuContext, AScopeMakesTheFormerOneCurrentAgain) {
  Context first;
  const Buffer<uint32_t> ones(std::vector<uint32_t>{1, 1});
  {
    const ContextScope former;
    Context second;
    const Buffer<uint32_t> twos(std::vector<uint32_t>{2, 2});
    EXPECT_FALSE(first.isCurrent());
    EXPECT_THROW(first.requireCurrent(), GpuError);
    {
      const ContextScope scope(first);
      EXPECT_EQ(ones.read(), (std::vector<uint32_t>{1, 1}));
    }
    EXPECT_TRUE(second.isCurrent());
    EXPECT_EQ(twos.read(), (std::vector<uint32_t>{2, 2}));
    first.release();
    EXPECT_TRUE(second.isCurrent()) << "the one that is released is not the current one";
  }
  EXPECT_TRUE(first.isCurrent());
  first.release();
  {
    const ContextScope scope(first);
    first.requireCurrent();
  }
  EXPECT_FALSE(first.isCurrent());
  ASSERT_TRUE(first.makeCurrent());
}

TEST(GpuContext, AScopeIsRefusedWhatAnotherThreadHas) {
  Context context;
  std::thread([&] { EXPECT_THROW(const ContextScope scope(context), GpuError); }).join();
  EXPECT_TRUE(context.isCurrent());
}
