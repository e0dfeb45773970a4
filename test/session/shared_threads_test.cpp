// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many sessions in one process, without OpenGL, on shared threads.
#include <gtest/gtest.h>

#include <thread>

#include "session/block_session.h"

namespace viscera {
namespace {

using namespace test;

constexpr int kSessions = 10, kThreads = 2, kTicks = 20;

/// Returns scenes that all differ.
Scene sceneOf(int which) {
  Scene scene = blockScene();
  scene.cameras.clear();
  scene.bodies[0].spacing_m = 2 * kHalfM / (4 + which % 5);  // whole cells
  scene.bodies[0].material.young_modulus_pa = 10000 + 1000 * which;
  return scene;
}
StylusSamples samplesOf(int which, int tick) {
  return which % 2 ? cut(tick) : press(tick);
}

uint64_t hashAlone(int which) {
  Session session(sceneOf(which));
  for (int t = 1; t <= kTicks; ++t) session.step(samplesOf(which, t), {});
  return session.stateHash();
}

TEST(SharedThreads, TenSessionsSteppedFromTwoThreadsEndAsEachAlone) {
  SessionOptions options;
  options.threads = makeThreadPool(3);
  std::vector<uint64_t> hashes(kSessions);
  const auto stepEverySecond = [&](int first) {
    std::vector<std::unique_ptr<Session>> sessions;
    for (int s = first; s < kSessions; s += kThreads) {
      sessions.push_back(std::make_unique<Session>(sceneOf(s), Progress{}, options));
    }
    for (int t = 1; t <= kTicks; ++t) {
      for (size_t i = 0; i < sessions.size(); ++i) {
        sessions[i]->step(samplesOf(first + kThreads * static_cast<int>(i), t), {});
      }
    }
    for (size_t i = 0; i < sessions.size(); ++i) {
      hashes[static_cast<size_t>(first) + kThreads * i] = sessions[i]->stateHash();
    }
  };
  std::vector<std::thread> threads;
  for (int first = 0; first < kThreads; ++first) threads.emplace_back(stepEverySecond, first);
  for (std::thread& thread : threads) thread.join();
  for (int s = 0; s < kSessions; ++s) EXPECT_EQ(hashes[static_cast<size_t>(s)], hashAlone(s)) << s;
}

TEST(SharedThreads, AreNamedByTheBackend) {
  SessionOptions options;
  options.threads = makeThreadPool(5);
  Scene scene = sceneOf(0);
  scene.solver.threads = 2;
  EXPECT_NE(Session(scene, {}, options).solver().backend().find("5 threads"), std::string::npos);
}

}  // namespace
}  // namespace viscera
