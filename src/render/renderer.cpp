// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/renderer.h"

#include <cassert>

#include "gpu/gl.h"
#include "gpu/stage_clock.h"
#include "render/obstacle_painter.h"
#include "render/overlay_painter.h"
#include "render/tissue_painter.h"
#include "render/tool_painter.h"

namespace viscera {

namespace {

constexpr float kBackground[] = {0.0056f, 0.0066f, 0.0080f, 1.0f};  // linear light: a neutral, slightly cool near-black

void prepareDrawing() {
  glDisable(GL_SCISSOR_TEST);  // clearing and resolving heed it
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDepthRange(0, 1);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glDisable(GL_CULL_FACE);  // tissue is seen from inside through a cut, but for what DrawnPart says
  glCullFace(GL_BACK);
  glFrontFace(GL_CW);  // the image is drawn upside down, which turns every winding
}

void clearImage() {
  glEnable(GL_FRAMEBUFFER_SRGB);
  glClearColor(kBackground[0], kBackground[1], kBackground[2], kBackground[3]);
  glClearDepth(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

MeshView viewOf(const Surface& surface, const DrawnSkin* skin) {
  return {surface.positions().id(), surface.normals().id(), surface.colors().id(),    surface.liveIndices().id(),
          surface.liveCount(),      surface.rests().id(),   surface.liveChartsView(), skin ? &skin->parts() : nullptr};
}

}  // namespace

Renderer::Renderer(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
                   const std::vector<ObstacleConfig>& obstacles, const Model* model)
    : cameras_(cameras),
      styluses_(styluses),
      tissue_(std::make_unique<TissuePainter>(model)),
      tools_(std::make_unique<ToolPainter>(styluses)) {
  if (!obstacles.empty()) obstacles_ = std::make_unique<ObstaclePainter>(obstacles);
  for (const CameraConfig& camera : cameras) {
    camera_poses_.push_back(opticalPose(camera));
    geometries_.emplace_back();
    targets_.emplace_back(camera.width_px, camera.height_px, camera.supersampling);
  }
}

Renderer::~Renderer() = default;

void Renderer::draw(size_t camera, const Surface& surface, const ToolMotions& motions, const DrawnSkin* skin) {
  draw(camera, viewOf(surface, skin), motions);
}

void Renderer::draw(size_t camera, const MeshView& mesh, const ToolMotions& motions) {
  const auto drawTissue = [&](const Pose& pose, const Eigen::Matrix4f& clip) {
    tissue_->draw(mesh, toolShadows(motions, styluses_, pose), pose, clip);
  };
  drawImage(camera, motions, drawTissue, [](const Pose&, const Eigen::Matrix4f&) {});
}

void Renderer::draw(size_t camera, const Model& model, const OverlayLook& look, const ToolMotions& motions) {
  if (!overlays_) overlays_ = std::make_unique<OverlayPainter>(model);
  overlays_->follow(look);
  const MeshView mesh = viewOf(*look.surface, look.skin);
  const auto drawTissue = [&](const Pose& pose, const Eigen::Matrix4f& clip) {
    if (look.shown.has(Overlay::kStrain)) {
      overlays_->drawStrain(look, mesh, pose, clip);
    } else {
      tissue_->draw(mesh, toolShadows(motions, styluses_, pose), pose, clip);
    }
  };
  drawImage(camera, motions, drawTissue, [&](const Pose& pose, const Eigen::Matrix4f& clip) {
    overlays_->draw(look, cameras_[camera].supersampling, pose, clip);
  });
}

/// @param drawTissue, drawOver  (optical_from_tissue, clip_from_optical): before and after obstacles and tools
template <class DrawTissue, class DrawOver>
void Renderer::drawImage(size_t camera, const ToolMotions& motions, DrawTissue drawTissue, DrawOver drawOver) {
  assert(camera < cameras_.size());
  const gpu::TimedStage timed(gpu::Stage::kRender);
  const Pose optical_from_tissue = camera_poses_[camera].inverse();
  const Eigen::Matrix4f clip_from_optical = clipFromOptical(cameras_[camera]);
  targets_[camera].bindForDrawing();
  prepareDrawing();
  clearImage();
  drawTissue(optical_from_tissue, clip_from_optical);
  if (obstacles_) obstacles_->draw(obstacle_poses_, optical_from_tissue, clip_from_optical);
  tools_->draw(motions, optical_from_tissue, clip_from_optical);
  drawOver(optical_from_tissue, clip_from_optical);
  targets_[camera].resolve();
  ++renders_;
}

void Renderer::drawGeometry(size_t camera, const Surface& surface, const ToolMotions& motions, const DrawnSkin* skin) {
  drawGeometry(camera, viewOf(surface, skin), motions);
}

void Renderer::drawGeometry(size_t camera, const MeshView& mesh, const ToolMotions& motions) {
  const gpu::TimedStage timed(gpu::Stage::kRender);
  const CameraConfig& config = cameras_[camera];
  std::unique_ptr<GeometryTarget>& target = geometries_[camera];
  if (!target) target = std::make_unique<GeometryTarget>(config.width_px, config.height_px);
  if (!geometry_program_) geometry_program_ = gpu::Program::graphics("mesh.vert", "geometry.frag");
  const Pose optical_from_tissue = camera_poses_[camera].inverse();
  const Eigen::Matrix4f clip_from_optical = clipFromOptical(config);
  prepareDrawing();
  target->bindEmpty();
  tissue_->drawGeometry(geometry_program_, mesh, optical_from_tissue, clip_from_optical);
  if (obstacles_) {
    obstacles_->drawGeometry(geometry_program_, obstacle_poses_, optical_from_tissue, clip_from_optical);
  }
  tools_->drawGeometry(geometry_program_, motions, optical_from_tissue, clip_from_optical);
  ++renders_;
}

void Renderer::bindLast(size_t camera) const {
  targets_[camera].bindForReading();
}

}  // namespace viscera
