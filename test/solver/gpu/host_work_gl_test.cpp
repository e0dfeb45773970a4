// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Work of the host for a substep on the GPU, and whether it waits for it.
#include <set>

#include "gpu/gl.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

int calls = 0;

/// Counts the calls of one OpenGL function during its lifetime. @tparam Entry  GLEW's pointer to it
template <auto& Entry>
class Counted {
 public:
  Counted() {
    original_ = Entry;
    Entry = count(original_);
  }
  ~Counted() { Entry = original_; }

 private:
  template <class... Arguments>
  static auto count(void (*)(Arguments...)) {
    return [](Arguments... arguments) {
      ++calls;
      original_(arguments...);
    };
  }
  static inline std::remove_reference_t<decltype(Entry)> original_ = nullptr;
};

template <auto&... Entries>
struct AllCounted : Counted<Entries>... {};

/// All functions that a substep of the solver calls.
using SubstepCalls =
    AllCounted<__glewUseProgram, __glewUniform1ui, __glewUniform1f, __glewUniform3fv, __glewUniform4fv,
               __glewProgramUniform1ui, __glewProgramUniform1f, __glewProgramUniform3fv, __glewProgramUniform4fv,
               __glewBindBufferBase, __glewBindBufferRange, __glewBindBuffersBase, __glewBindTextureUnit,
               __glewBindTextures, __glewBindBuffer, __glewDispatchCompute, __glewDispatchComputeIndirect,
               __glewMemoryBarrier, __glewNamedBufferSubData>;

/// A GPU that, as reported by fences, has finished no work since the last finishAll().
class SlowGpu {
 public:
  SlowGpu() {
    original_fence = __glewFenceSync;
    original_wait = __glewClientWaitSync;
    __glewFenceSync = [](GLenum condition, GLbitfield flags) {
      return *unfinished.insert(original_fence(condition, flags)).first;
    };
    __glewClientWaitSync = [](GLsync fence, GLbitfield flags, GLuint64 timeout) {
      return timeout == 0 && unfinished.count(fence) ? GL_TIMEOUT_EXPIRED : original_wait(fence, flags, timeout);
    };
  }
  ~SlowGpu() {
    __glewFenceSync = original_fence;
    __glewClientWaitSync = original_wait;
    finishAll();
  }
  static void finishAll() {
    glFinish();
    unfinished.clear();
  }

 private:
  static inline std::set<GLsync> unfinished;
  static inline PFNGLFENCESYNCPROC original_fence = nullptr;
  static inline PFNGLCLIENTWAITSYNCPROC original_wait = nullptr;
};

class HostWork : public GpuTest {
 protected:
  /// Returns the number of OpenGL calls of one more substep in a tick, after a tick that has set up everything.
  double callsPerSubstep(Scene scene, const Model& model, const ToolMotions& motions = {}) const {
    constexpr int kFew = 12, kMany = 36;  // multiples of the interval of sleep checks
    int in_tick[2];
    for (int substeps : {kFew, kMany}) {
      scene.solver.tick_hz *= substeps == kMany ? static_cast<double>(kFew) / kMany : 1;
      scene.solver.substeps = substeps;
      GpuSolver solver(model, scene);
      solver.step(motions);
      const SubstepCalls counted;
      calls = 0;
      solver.step(motions);
      in_tick[substeps == kMany] = calls;
    }
    return (in_tick[1] - in_tick[0]) / static_cast<double>(kMany - kFew);
  }

  const Model model_ = modelOf({boxBody({4, 4, 4}, 0.01)});
};

}  // namespace

TEST_F(HostWork, PlainSubstepTakesFiveOpenGlCalls) {
  // use, dispatch, barrier, and the state's buffers and texel views
  EXPECT_EQ(callsPerSubstep(sceneWith(Integrator::kLeapfrog, model_, 10, 0.5), model_), 5);
}

TEST_F(HostWork, SleepTakesOneMoreASubstepAndACheckInEverySixth) {
  // The list that is dispatched over. For a check: use, number, dispatch, barrier for the speeds and for the lists, and
  // the substep's own kernel again.
  Scene scene = sceneWith(Integrator::kLeapfrog, model_, 10, 0.5);
  scene.solver.sleep_speed_m_per_s = 1e-9;
  const double calls = callsPerSubstep(scene, model_);
  EXPECT_GT(calls, 6) << "no look was counted";
  EXPECT_LE(calls, 6 + 10.0 / 6);
}

TEST_F(HostWork, CellsOfALawTakeThreeMoreAndAProbeFive) {
  const Model law = modelOf({ofLaw(boxBody({4, 4, 4}, 0.01))});
  EXPECT_EQ(callsPerSubstep(sceneWith(Integrator::kLeapfrog, law, 10, 0.5), law), 8);
  const Scene probed = sceneWith(Integrator::kLeapfrog, model_, 10, 0.5, 20, {StylusConfig{}});
  // The motions; the list of nodes; and use, dispatch, barrier for the contact with springs.
  EXPECT_EQ(callsPerSubstep(probed, model_, probeAt({0.02, 0.02, 0.038})), 10);
}

TEST_F(HostWork, GovernedTickIsNotWaitedForUntilTheNextOneHasStarted) {
  Scene scene = sceneWith(Integrator::kLeapfrog, model_, 10, 0.5);
  scene.solver.stability_monitor = true;
  const SlowGpu slow;
  GpuSolver solver(model_, scene);
  for (int t = 0; t < 20; ++t) {
    SlowGpu::finishAll();
    solver.step({});
  }
  EXPECT_EQ(solver.waits(), 0u);
  layout::TickStats stats;
  while (solver.pollStats(stats, true)) {
  }
  EXPECT_EQ(solver.waits(), 1u) << "the last tick was done at once: nothing was tested";
}
