// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/renderer.h"

#include <algorithm>
#include <cassert>
#include <type_traits>

#include "gpu/gl.h"
#include "gpu/software.h"
#include "gpu/stage_clock.h"
#include "render/obstacle_painter.h"
#include "render/overlay_painter.h"
#include "render/tissue_painter.h"
#include "render/tool_painter.h"
#include "render/tube_painter.h"

namespace viscera {

namespace {

constexpr int kSamples = 2;                                         // of a pixel along each axis, by default
constexpr float kBackground[] = {0.0056f, 0.0066f, 0.0080f, 1.0f};  // linear light: a neutral, slightly cool near-black

void prepareDrawing() {
  glDisable(GL_SCISSOR_TEST);  // it affects clearing and resolving
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDepthRange(0, 1);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glDisable(GL_CULL_FACE);  // a cut shows tissue from inside
  glFrontFace(GL_CW);       // the image is drawn upside down, which reverses every winding
}

void clearImage() {
  glEnable(GL_FRAMEBUFFER_SRGB);
  glClearColor(kBackground[0], kBackground[1], kBackground[2], kBackground[3]);
  glClearDepth(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

int samplesOf(const CameraConfig& camera) {
  return camera.supersampling == 0 ? kSamples : camera.supersampling;
}

/// Draws no overlays.
struct Nothing {
  template <class View>
  void operator()(const View&, bool) const {}
};

}  // namespace

Renderer::Renderer(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
                   const std::vector<ObstacleConfig>& obstacles, const Model* model, bool marks)
    : model_(model), styluses_(styluses) {
  for (const CameraConfig& camera : cameras) {
    cameras_.push_back(pinholeOf(camera));
    lenses_.push_back(camera.distortion.any() ? std::make_unique<Lens>(camera) : nullptr);
  }
  if (std::any_of(cameras_.begin(), cameras_.end(),
                  [](const CameraConfig& camera) { return camera.light == CameraLight::kLens; }))
    light_features_.emplace_back("LENS_LIGHT");
  makeTissue(marks, false);
  tools_ = std::make_unique<ToolPainter>(styluses, light_features_);
  if (!obstacles.empty()) obstacles_ = std::make_unique<ObstaclePainter>(obstacles, light_features_);
  for (const CameraConfig& camera : cameras_) {
    camera_poses_.push_back(opticalPose(camera));
    geometries_.emplace_back();
    targets_.emplace_back();
    lit_targets_.emplace_back();
    if (lightsPixels(camera) && tissue_->lightsPixels()) {
      lit_targets_.back() = std::make_unique<GBuffer>(camera.width_px, camera.height_px);
    }
    if (lit_targets_.back()) continue;
    targets_.back() = std::make_unique<RenderTarget>(camera.width_px, camera.height_px, samplesOf(camera));
  }
}

bool Renderer::lightsPixels(const CameraConfig& camera) const {
  return camera.supersampling == 0 && gpu::isSoftware() && camera.width_px * camera.height_px <= GBuffer::kMostPixels;
}

/// Makes the shaders of tissue. Those with marks or paint are made when there is something to draw with them.
void Renderer::makeTissue(bool marks, bool paint) {
  has_marks_ = marks;
  has_paint_ = paint;
  std::vector<std::string> features = light_features_;
  if (std::any_of(cameras_.begin(), cameras_.end(),
                  [](const CameraConfig& camera) { return camera.contact_shadows > 0; }))
    features.emplace_back("CONTACTS");
  if (marks) features.emplace_back("MARKS");
  if (paint) features.emplace_back("PAINT");
  const auto by_pixels = [this](const CameraConfig& camera) { return lightsPixels(camera); };
  tissue_ = std::make_unique<TissuePainter>(model_, !std::all_of(cameras_.begin(), cameras_.end(), by_pixels),
                                            std::any_of(cameras_.begin(), cameras_.end(), by_pixels), features);
  if (has_marks_) tissue_->showMarks(marks_);
}

void Renderer::showMarks(const std::shared_ptr<const VisibleMarks>& marks) {
  marks_ = marks;
  if (marks && !has_marks_ && model_) return makeTissue(true, has_paint_);
  if (has_marks_) tissue_->showMarks(marks);
}

Renderer::~Renderer() = default;

void Renderer::addTubes(const std::vector<TubeStyle>& sutures) {
  sutures_ = std::make_unique<TubePainter>(sutures, light_features_);
}

/// Returns the width of a pixel at a distance of 1.
double Renderer::pixelOf(size_t camera) const {
  return 1 / intrinsics(cameras_[camera]).fy;
}

void Renderer::draw(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs) {
  draw(camera, meshOf(surface, runs), motions);
}

void Renderer::draw(size_t camera, const MeshView& mesh, const ToolMotions& motions) {
  drawImage(camera, mesh, motions, true, Nothing{});
}

void Renderer::draw(size_t camera, const Model& model, const OverlayStyle& style, const ToolMotions& motions) {
  if (!overlays_) overlays_ = std::make_unique<OverlayPainter>(model);
  overlays_->follow(style);
  const MeshView mesh = meshOf(*style.surface, style.runs);
  const bool strain = style.shown.has(Overlay::kStrain);
  const Lens* lens = lenses_[camera].get();  // not for legends
  drawImage(camera, mesh, motions, !strain, [&](const View& view, bool before_tools) {
    if (before_tools) {
      if (strain) overlays_->drawStrain(style, mesh, view.optical_from_tissue, view.clip_from_optical);
    } else {
      overlays_->draw(style, samplesOf(cameras_[camera]), view.optical_from_tissue, view.clip_from_optical);
      if (strain && !lens) overlays_->drawLegend(style.strain_range);
    }
  });
  if (!strain || !lens) return;
  lens->bindForDrawing();
  overlays_->drawLegend(style.strain_range);
}

MeshView Renderer::meshOf(const Surface& surface, const IndexRuns* runs) const {
  const uint32_t colors = shown_colors_ ? shown_colors_ : surface.colors().id();
  return {surface.positions().id(), surface.normals().id(),   colors, surface.liveIndices().id(), surface.liveCount(),
          surface.rests().id(),     surface.liveChartsView(), runs,   surface.needsPaint()};
}

Renderer::View Renderer::viewOf(size_t camera) const {
  return {camera, camera_poses_[camera].inverse(), clipFromOptical(cameras_[camera])};
}

/// Draws an image. @param tissue  draw it   @param drawOver  called with the view, and whether it is before obstacles
/// and tools or after
template <class DrawOver>
void Renderer::drawImage(size_t camera, const MeshView& mesh, const ToolMotions& motions, bool tissue,
                         DrawOver drawOver) {
  assert(camera < cameras_.size());
  const gpu::TimedStage timed(gpu::Stage::kRender);
  const View view = viewOf(camera);
  if (tissue && mesh.painted && !has_paint_ && model_) makeTissue(has_marks_, true);
  lightFor(cameras_[camera]);
  prepareDrawing();
  if (lit_targets_[camera]) {
    drawPixels(view, mesh, motions, tissue, drawOver);
  } else {
    drawSamples(view, mesh, motions, tissue, drawOver);
  }
  if (lenses_[camera]) {
    const gpu::TimedStage resolving(gpu::Stage::kResolve);
    lenses_[camera]->bend();
  }
  ++renders_;
}

void Renderer::lightFor(const CameraConfig& camera) {
  tissue_->lightFor(camera);
  tools_->lightFor(camera);
  if (obstacles_) obstacles_->lightFor(camera);
  if (sutures_) sutures_->lightFor(camera);
}

template <class DrawOver>
void Renderer::drawSamples(const View& view, const MeshView& mesh, const ToolMotions& motions, bool tissue,
                           DrawOver drawOver) {
  const RenderTarget& target = *targets_[view.camera];
  target.bindForDrawing();
  clearImage();
  if (tissue) drawTissue(view, mesh, motions);
  drawRest(view, motions, drawOver);
  const gpu::TimedStage resolving(gpu::Stage::kResolve);
  target.resolve();
}

/// Draws tissue with lighting per pixel, then all else, with supersampling, over it.
template <class DrawOver>
void Renderer::drawPixels(const View& view, const MeshView& mesh, const ToolMotions& motions, bool tissue,
                          DrawOver drawOver) {
  const GBuffer& target = *lit_targets_[view.camera];
  glEnable(GL_FRAMEBUFFER_SRGB);
  const bool by_pixels = tissue && mesh.rests != 0;
  if (by_pixels) {
    tissue_->drawPixels(target, cameras_[view.camera], mesh,
                        toolShadows(motions, styluses_, cameras_[view.camera], view.optical_from_tissue),
                        view.optical_from_tissue, view.clip_from_optical, kBackground, pause_);
  } else {
    target.bindSeen();
    target.bindImage();
    glClearBufferfv(GL_COLOR, 0, kBackground);
  }
  const bool any_over =
      !by_pixels || obstacles_ || sutures_ || tools_->showsAny(motions) || !std::is_same_v<DrawOver, Nothing>;
  if (any_over) {
    if (by_pixels && pause_ && std::is_same_v<DrawOver, Nothing>) pause_();
    target.bindOver();
    if (tissue && !by_pixels) drawTissue(view, mesh, motions);
    drawRest(view, motions, drawOver);
    const gpu::TimedStage resolving(gpu::Stage::kResolve);
    tissue_->light().putOver(target);
  }
  target.bindForReading();
}

/// Draws tissue with lighting per sample.
void Renderer::drawTissue(const View& view, const MeshView& mesh, const ToolMotions& motions) {
  const gpu::TimedStage timed(gpu::Stage::kTissue);
  tissue_->draw(mesh, toolShadows(motions, styluses_, cameras_[view.camera], view.optical_from_tissue),
                view.optical_from_tissue, view.clip_from_optical);
}

/// Draws everything but tissue.
template <class DrawOver>
void Renderer::drawRest(const View& view, const ToolMotions& motions, DrawOver drawOver) {
  {
    const gpu::TimedStage before(gpu::Stage::kOverlays);
    drawOver(view, true);
  }
  {
    const gpu::TimedStage tools(gpu::Stage::kTools);
    if (obstacles_) obstacles_->draw(obstacle_poses_, view.optical_from_tissue, view.clip_from_optical);
    if (sutures_)
      sutures_->draw(visible_tubes_, view.optical_from_tissue, view.clip_from_optical, pixelOf(view.camera));
    tools_->draw(motions, view.optical_from_tissue, view.clip_from_optical);
  }
  const gpu::TimedStage after(gpu::Stage::kOverlays);
  drawOver(view, false);
}

void Renderer::drawGeometry(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs) {
  drawGeometry(camera, meshOf(surface, runs), motions);
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
  if (sutures_) {
    sutures_->drawGeometry(geometry_program_, visible_tubes_, optical_from_tissue, clip_from_optical, pixelOf(camera));
  }
  tools_->drawGeometry(geometry_program_, motions, optical_from_tissue, clip_from_optical);
  if (lenses_[camera]) lenses_[camera]->bend(*target);
  ++renders_;
}

void Renderer::bindLast(size_t camera) const {
  if (lenses_[camera]) {
    lenses_[camera]->bindForReading();
  } else if (lit_targets_[camera]) {
    lit_targets_[camera]->bindForReading();
  } else {
    targets_[camera]->bindForReading();
  }
}

}  // namespace viscera
