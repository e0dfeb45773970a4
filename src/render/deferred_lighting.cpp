// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/deferred_lighting.h"

#include "gpu/gl.h"
#include "gpu/stage_clock.h"

namespace viscera {

namespace {

std::vector<std::string> with(std::vector<std::string> features, const std::string& one_more) {
  features.push_back(one_more);
  return features;
}

void drawWhole(const gpu::Program& program, float clip_depth) {
  program.set("clip_depth", clip_depth);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Sets the size of a sample in texture coordinates.
void setTexel(const gpu::Program& program, const GBuffer& target) {
  const float texel[] = {0.5F / static_cast<float>(target.width()), 0.5F / static_cast<float>(target.height())};
  program.set("texel", texel);
}

}  // namespace

DeferredLighting::DeferredLighting(const std::vector<std::string>& features)
    : parts_(gpu::Program::graphics("whole.vert", "pixel_classes.frag")),
      one_(gpu::Program::graphics("whole.vert", "deferred_lighting.frag", features)),
      several_(gpu::Program::graphics("whole.vert", "deferred_lighting.frag", with(features, "SEVERAL"))),
      over_(gpu::Program::graphics("whole.vert", "over.frag")) {}

/// Sorts pixels by depth, so that a rasteriser runs each program only on its pixels: several surfaces 0.25, nothing
/// 0.5, one 1.
void DeferredLighting::light(const GBuffer& target, const CameraConfig& camera, const Pose& optical_from_tissue,
                             const float (&background)[4], const std::function<void()>& pause) const {
  const Intrinsics k = intrinsics(camera);
  const DepthRange range = depthRange(camera);
  const float nearness[] = {static_cast<float>(1 / range.near_m),
                            static_cast<float>(1 / range.far_m - 1 / range.near_m)};
  target.bindImage();
  glBindVertexArray(nothing_.id());
  {
    const gpu::TimedStage timed(gpu::Stage::kEdges);
    glClearBufferfv(GL_COLOR, 0, background);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthFunc(GL_ALWAYS);
    parts_.use();
    parts_.set("nearness", nearness);
    parts_.set("steepest", kSteepest / static_cast<float>(k.fx));
    setTexel(parts_, target);
    drawWhole(parts_, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
  }
  const float lens[] = {static_cast<float>(k.fx), static_cast<float>(k.fy), static_cast<float>(k.cx),
                        static_cast<float>(k.cy)};
  const float behind[] = {background[0], background[1], background[2]};
  const Eigen::Matrix4f optical = poseMatrix(optical_from_tissue);
  for (const gpu::Program* program : programs()) {
    if (pause) pause();
    const gpu::TimedStage timed(program == &one_ ? gpu::Stage::kLight : gpu::Stage::kEdges);
    program->use();
    program->set("nearness", nearness);
    program->set("lens", lens);
    program->set("background", behind);
    setTexel(*program, target);
    program->setMatrix("optical_from_mesh", optical.data());
    glDepthFunc(program == &one_ ? GL_LESS : GL_GREATER);
    drawWhole(*program, program == &one_ ? 0.5F : -0.25F);  // depths 0.75 and 0.375
  }
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glBindVertexArray(0);
}

void DeferredLighting::putOver(const GBuffer& target) const {
  target.bindImage();
  target.readOver();
  glBindVertexArray(nothing_.id());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  over_.use();
  setTexel(over_, target);
  drawWhole(over_, 0);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

}  // namespace viscera
