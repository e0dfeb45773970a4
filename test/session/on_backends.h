// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "session/block_session.h"
#include "support/gpu_fixture.h"

namespace viscera::test {

/// One test body for sessions on either backend.
class OnSceneBackend : public GpuTest, public ::testing::WithParamInterface<Backend> {
 protected:
  static Scene scene(Scene out = blockScene()) {
    out.solver.backend = GetParam();
    return out;
  }
  /// Returns what a session's first camera sees now.
  static ImageFrame picture(Session& session, PictureKind kind = PictureKind::kColor) {
    FrameRequest outputs;
    outputs.of(kind) = {true};
    Pictures pictures = session.show(outputs);
    EXPECT_EQ(pictures.images.size(), 1U);
    return pictures.images.empty() ? ImageFrame{} : std::move(pictures.images.back());
  }
};

inline std::string sceneBackendName(const ::testing::TestParamInfo<Backend>& info) {
  return info.param == Backend::kCpu ? "cpu" : "gpu";
}
#define VISCERA_ON_EVERY_BACKEND(suite)                                                                            \
  INSTANTIATE_TEST_SUITE_P(Backends, suite, ::testing::Values(::viscera::Backend::kGpu, ::viscera::Backend::kCpu), \
                           ::viscera::test::sceneBackendName)

}  // namespace viscera::test
