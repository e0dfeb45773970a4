// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sessions that another thread has made, of an existing model.
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "session/block_session.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

TEST(MadeBefore, AModelIsNotMadeAgain) {
  const Scene scene = blockScene();
  SessionOptions options;
  options.model = std::make_shared<const Model>(buildModel(scene));
  std::vector<std::string> stages;
  Session given(
      scene, [&](const std::string& stage, double) { stages.push_back(stage); }, options);
  EXPECT_EQ(&given.model(), options.model.get());
  EXPECT_EQ(stages, (std::vector<std::string>{"start the solver", "prepare pictures"}));
  Session made(scene);
  for (Session* session : {&given, &made}) play(*session, cut, kCutTicks);
  EXPECT_EQ(given.stateHash(), made.stateHash());
}

TEST(MadeBefore, ASessionIsSteppedByAThreadThatDidNotMakeIt) {
  for (const Backend backend : {Backend::kCpu, Backend::kGpu}) {
    Scene scene = blockScene();
    scene.solver.backend = backend;
    std::unique_ptr<gpu::Context> context;
    std::unique_ptr<Session> session;
    std::async(std::launch::async, [&] {
      context = std::make_unique<gpu::Context>();
      session = std::make_unique<Session>(scene, *context);
      if (!session->solver().onHost()) context->release();
    }).get();
    if (!session->solver().onHost()) {
      ASSERT_TRUE(context->makeCurrent());
    }
    play(*session, cut, kCutTicks);
    const uint64_t hash = session->stateHash();
    session.reset();
    context.reset();
    gpu::Context own;
    Session here(scene, own);
    play(here, cut, kCutTicks);
    EXPECT_EQ(hash, here.stateHash());
  }
}

TEST(MadeBefore, ASessionKeepsToItsContext) {
  Scene scene = blockScene();
  scene.solver.backend = Backend::kGpu;
  gpu::Context first, second;
  auto on_second = std::make_unique<Session>(scene, second);
  EXPECT_THROW(Session(scene, first), GpuError) << "it is not current";
  const gpu::ContextScope scope(first);
  Session on_first(scene, first);
  play(on_first, cut, kCutTicks);
  const uint64_t hash = on_first.stateHash();
  EXPECT_THROW(on_second->step({}, {}), GpuError);
  EXPECT_THROW(on_second->stateHash(), GpuError);
  EXPECT_THROW(on_second->reset(), GpuError);
  EXPECT_THROW(on_second->show({}), GpuError);
  {
    const gpu::ContextScope its_own(second);
    play(*on_second, cut, kCutTicks);
    EXPECT_EQ(on_second->stateHash(), hash);
  }
  on_second.reset();
  EXPECT_TRUE(first.isCurrent());
  EXPECT_EQ(on_first.stateHash(), hash) << "the other one's end has taken its buffers";
  on_first.reset();
  play(on_first, cut, kCutTicks);
  EXPECT_EQ(on_first.stateHash(), hash);
}

}  // namespace
}  // namespace viscera
