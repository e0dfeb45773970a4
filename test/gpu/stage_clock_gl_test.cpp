// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/stage_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "gpu/gl.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

using namespace viscera::gpu;

namespace {

/// A GPU that takes 1, 2, 4, 8 ... ns between successive time stamps, so that a sum determines its terms.
class ScriptedTime {
 public:
  ScriptedTime() {
    counter = __glewQueryCounter;
    available = __glewGetQueryObjectiv;
    result = __glewGetQueryObjectui64v;
    __glewQueryCounter = [](GLuint query, GLenum) { stamps[query] = (GLuint64{1} << asked++) - 1; };
    __glewGetQueryObjectiv = [](GLuint, GLenum, GLint* there) { *there = all_there; };
    __glewGetQueryObjectui64v = [](GLuint query, GLenum, GLuint64* time_ns) { *time_ns = stamps.at(query); };
    stamps.clear();
    asked = 0;
    all_there = true;
  }
  ~ScriptedTime() {
    __glewQueryCounter = counter;
    __glewGetQueryObjectiv = available;
    __glewGetQueryObjectui64v = result;
  }
  static inline bool all_there = true;
  static inline int asked = 0;  ///< number of time stamps

 private:
  static inline std::map<GLuint, GLuint64> stamps;
  static inline PFNGLQUERYCOUNTERPROC counter = nullptr;
  static inline PFNGLGETQUERYOBJECTIVPROC available = nullptr;
  static inline PFNGLGETQUERYOBJECTUI64VPROC result = nullptr;
};

class StageClockTest : public ::testing::Test {
 protected:
  static int64_t ns(const StageClock::Time& time) { return std::llround(1e9 * time.seconds); }

  Context context_;
};

const StageClock::Time& of(const std::array<StageClock::Time, kStages>& times, Stage stage) {
  return times[static_cast<size_t>(stage)];
}

}  // namespace

TEST_F(StageClockTest, TimeBelongsToTheInnermostStageAndOutsideOfStagesToNone) {
  const ScriptedTime time;
  StageClock clock(16);
  {
    const TimedStage step(Stage::kStep);    // 1 ns
    const TimedStage cells(Stage::kCells);  // 2 ns, then 4 ns in `step` again, then 8 ns outside of stages
  }
  { const TimedStage step(Stage::kStep); }
  const auto& times = clock.collect();
  EXPECT_EQ(ns(of(times, Stage::kCells)), 2);
  EXPECT_EQ(ns(of(times, Stage::kStep)), 1 + 4 + 16);
  EXPECT_EQ(of(times, Stage::kStep).count, 2u);
  EXPECT_EQ(of(times, Stage::kCells).count, 1u);
  EXPECT_EQ(of(times, Stage::kCut).count, 0u);
}

TEST_F(StageClockTest, StagesAreLeftOutRatherThanWaitedForWhereTheGpuIsBehind) {
  const ScriptedTime time;
  StageClock clock(4);
  ScriptedTime::all_there = false;
  for (int i = 0; i < 5; ++i) const TimedStage step(Stage::kStep);
  EXPECT_EQ(clock.untimed(), 3u);
  EXPECT_EQ(of(clock.collect(), Stage::kStep).seconds, 0);
  EXPECT_EQ(ns(of(clock.collect(true), Stage::kStep)), 1 + 4);
  ScriptedTime::all_there = true;
  { const TimedStage step(Stage::kStep); }
  EXPECT_EQ(of(clock.collect(), Stage::kStep).count, 3u);
}

TEST_F(StageClockTest, WithoutAClockNothingIsAsked) {
  const ScriptedTime time;
  { const TimedStage step(Stage::kStep); }
  EXPECT_EQ(ScriptedTime::asked, 0);
}

TEST_F(StageClockTest, TimingMakesNoOpenGlObject) {
  StageClock clock(4);
  const size_t before = objectsCreated();
  for (int i = 0; i < 20; ++i) const TimedStage step(Stage::kStep);
  clock.collect(true);
  EXPECT_EQ(objectsCreated(), before);
}

TEST_F(StageClockTest, RealTimeStampsDoNotGoBackwards) {
  StageClock clock;
  for (int i = 0; i < 20; ++i) const TimedStage step(Stage::kStep);
  const double seconds = of(clock.collect(true), Stage::kStep).seconds;
  EXPECT_GE(seconds, 0);
  EXPECT_LT(seconds, 10);
}

TEST_F(StageClockTest, AClockThatWaitsTakesTheTimeOnTheHost) {
  const auto clock = StageClock::waiting();
  {
    const TimedStage render(Stage::kRender);
    const TimedStage light(Stage::kLight);
  }
  EXPECT_EQ(of(clock->collect(true), Stage::kLight).count, 1u);
  EXPECT_GE(of(clock->collect(true), Stage::kLight).seconds, 0);
  EXPECT_EQ(of(clock->collect(true), Stage::kTools).count, 0u);
  EXPECT_EQ(clock->untimed(), 0u);
}

TEST_F(StageClockTest, ThereIsOnePerThread) {
  const StageClock clock(4);
  EXPECT_THROW(StageClock(4), viscera::GpuError);
}
