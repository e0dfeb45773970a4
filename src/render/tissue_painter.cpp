// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tissue_painter.h"

#include <algorithm>
#include <cmath>

#include "gpu/stage_clock.h"
#include "layout/bindings.h"
#include "math/srgb.h"
#include "render/mesh_parts.h"
#include "render/mesh_uniforms.h"

namespace viscera {

namespace {

void describe(VertexArray& inputs) {
  inputs.describe(kPositionInput, kPositionInput, 3, GL_FLOAT, GL_FALSE, 0);
  inputs.describe(kNormalInput, kNormalInput, 4, GL_INT_2_10_10_10_REV, GL_TRUE, 0);
  inputs.describe(kColorInput, kColorInput, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
}

void bindMesh(const VertexArray& inputs, const MeshView& mesh) {
  glVertexArrayVertexBuffer(inputs.id(), kPositionInput, mesh.positions, 0, 3 * sizeof(float));
  glVertexArrayVertexBuffer(inputs.id(), kNormalInput, mesh.normals, 0, sizeof(uint32_t));
  glVertexArrayVertexBuffer(inputs.id(), kColorInput, mesh.colors, 0, sizeof(uint32_t));
}

Vector3f linear(const Vector3d& srgb) {
  return srgb.unaryExpr(&linearFromSrgb).cast<float>();
}

/// Sets the uniforms of shaders/draw/grain.glsl for the bodies.
void setFinishes(const gpu::Program& program, const Model& model) {
  constexpr size_t kLayers = 4;  // of a body in grain.glsl, and at most in a scene
  std::vector<float> finishes(4 * layout::kMaxBodies), walls(finishes), layers(4 * kLayers * layout::kMaxBodies);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const size_t count = std::min(body.layers.size(), kLayers);
    finishes[4 * b] = static_cast<float>(body.roughness);
    finishes[4 * b + 1] = static_cast<float>(body.color_variation);
    finishes[4 * b + 2] = static_cast<float>(count);
    finishes[4 * b + 3] = static_cast<float>(body.specular_wetness);
    walls[4 * b] = static_cast<float>(body.cut_wall_texture);
    for (size_t i = 0; i < count; ++i) {
      const Vector3f color = linear(body.layers[i].color);
      std::copy_n(color.data(), 3, &layers[4 * (kLayers * b + i)]);
      layers[4 * (kLayers * b + i) + 3] = static_cast<float>(body.layers[i].depth_m);
    }
  }
  program.setVectors("body_finish", finishes.data(), 4, layout::kMaxBodies);
  program.setVectors("body_walls", walls.data(), 4, layout::kMaxBodies);
  program.setVectors("body_layers", layers.data(), 4, kLayers * layout::kMaxBodies);
}

void setShadows(const gpu::Program& program, const ToolShadows& shadows) {
  program.set("shafts", shadows.count);
  program.set("contacts", shadows.contact > 0 ? shadows.count : 0);
  program.set("contact", shadows.contact);
  if (shadows.count == 0) return;
  const auto count = static_cast<size_t>(shadows.count);
  program.setVectors("shaft_tips", shadows.tips[0].data(), 4, count);
  program.setVectors("shaft_ends", shadows.ends[0].data(), 4, count);
}

}  // namespace

TissuePainter::TissuePainter(const Model* model, bool samples, bool pixels, std::vector<std::string> features)
    : program_(gpu::Program::graphics("mesh.vert", "tissue.frag", features)),
      has_marks_(std::find(features.begin(), features.end(), "MARKS") != features.end()) {
  describe(inputs_);
  if (model == nullptr) return;
  const auto is_tissue = [](const Body& body) { return !body.skin.two_sided; };
  if (std::any_of(model->bodies.begin(), model->bodies.end(), is_tissue))
    grain_ = std::make_unique<GrainTexture>(pixels);
  detail_ = std::make_unique<DetailTextures>(*model);
  if (!detail_->any()) detail_.reset();
  if (!grain_ && !detail_ && !has_marks_) return;
  describe(tissue_inputs_);
  tissue_inputs_.describe(kRestInput, kRestInput, 4, GL_FLOAT, GL_FALSE, 0);
  if (grain_) features.emplace_back("GRAIN");
  const auto any = [model](double Body::*finish) {
    return std::any_of(model->bodies.begin(), model->bodies.end(),
                       [finish](const Body& body) { return body.*finish > 0; });
  };
  if (any(&Body::specular_wetness)) features.emplace_back("FILM");
  if (any(&Body::cut_wall_texture)) features.emplace_back("WALL_GRAIN");
  if (detail_) features.emplace_back("DETAIL");
  if (pixels && (grain_ || detail_)) {
    light_ = std::make_unique<DeferredLighting>(features);
    for (const gpu::Program* program : light_->programs()) {
      if (!grain_) continue;
      setFinishes(*program, *model);
      program->set("steepest_grain", GrainTexture::kSteepest);
    }
  }
  features.emplace_back("REST");
  if (samples || !light_) {
    tissue_program_ = gpu::Program::graphics("mesh.vert", "tissue.frag", features);
    depth_program_ = gpu::Program::graphics("mesh.vert", "depth.frag");
    if (grain_) setFinishes(tissue_program_, *model);
  }
  features.emplace_back("SRGB");
  if (light_) seen_program_ = gpu::Program::graphics("mesh.vert", "tissue_g_buffer.frag", features);
}

void TissuePainter::lightFor(const CameraConfig& camera) {
  setLight(program_, camera);
  if (tissue_program_) setLight(tissue_program_, camera);
  if (!light_) return;
  for (const gpu::Program* program : light_->programs()) setLight(*program, camera);
}

/// Binds a mesh with its rest positions, and textures.
void TissuePainter::bindAtRest(const MeshView& mesh) const {
  bindMesh(tissue_inputs_, mesh);
  glVertexArrayVertexBuffer(tissue_inputs_.id(), kRestInput, mesh.rests, 0, 4 * sizeof(float));
  if (grain_) grain_->bind();
  if (detail_) detail_->bind();
  if (marks_.any()) marks_.bind();
  glBindVertexArray(tissue_inputs_.id());
}

/// Draws what bindAtRest() has bound, with the program in use.
void TissuePainter::drawAtRest(const gpu::Program& program, const MeshView& mesh) const {
  if (detail_) glBindTextureUnit(layout::kUnitShownCharts, mesh.charts);
  drawParts(mesh, tissue_inputs_, [&](const IndexRun& run) {
    if (detail_) program.set("first_chart", static_cast<int32_t>(run.first / 3));
  });
}

void TissuePainter::draw(const MeshView& mesh, const ToolShadows& shadows, const Pose& optical_from_tissue,
                         const Eigen::Matrix4f& clip_from_optical) {
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);  // kernels wrote these buffers
  if (tissue_program_ && mesh.rests != 0) {
    bindAtRest(mesh);
    depth_program_.use();
    setMeshMatrices(depth_program_, optical_from_tissue, clip_from_optical);
    drawParts(mesh, tissue_inputs_, [](const IndexRun&) {});
    glDepthFunc(GL_LEQUAL);
    useWith(tissue_program_, shadows, optical_from_tissue, clip_from_optical);
    if (has_marks_) marks_.set(tissue_program_);
    drawAtRest(tissue_program_, mesh);
    glDepthFunc(GL_LESS);
  } else {
    bindMesh(inputs_, mesh);
    glBindVertexArray(inputs_.id());
    useWith(program_, shadows, optical_from_tissue, clip_from_optical);
    drawParts(mesh, inputs_, [](const IndexRun&) {});
  }
  glBindVertexArray(0);
}

void TissuePainter::drawPixels(const GBuffer& target, const CameraConfig& camera, const MeshView& mesh,
                               const ToolShadows& shadows, const Pose& optical_from_tissue,
                               const Eigen::Matrix4f& clip_from_optical, const float (&background)[4],
                               const std::function<void()>& pause) {
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);  // kernels wrote these buffers
  {
    const gpu::TimedStage timed(gpu::Stage::kTissue);
    target.bindSeen();
    bindAtRest(mesh);
    seen_program_.use();
    setMeshMatrices(seen_program_, optical_from_tissue, clip_from_optical);
    drawAtRest(seen_program_, mesh);
  }
  if (pause) pause();
  for (const gpu::Program* program : light_->programs()) {
    setShadows(*program, shadows);
    if (has_marks_) marks_.set(*program);
  }
  if (grain_) grain_->bindSlopes();
  light_->light(target, camera, optical_from_tissue, background, pause);
}

void TissuePainter::drawGeometry(const gpu::Program& program, const MeshView& mesh, const Pose& optical_from_tissue,
                                 const Eigen::Matrix4f& clip_from_optical) {
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);  // kernels wrote these buffers
  bindMesh(inputs_, mesh);
  glBindVertexArray(inputs_.id());
  program.use();
  setMeshMatrices(program, optical_from_tissue, clip_from_optical);
  program.set("label", uint32_t{0});
  drawParts(mesh, inputs_, [](const IndexRun&) {});
  glBindVertexArray(0);
}

void TissuePainter::useWith(const gpu::Program& program, const ToolShadows& shadows, const Pose& optical_from_tissue,
                            const Eigen::Matrix4f& clip_from_optical) {
  program.use();
  setMeshMatrices(program, optical_from_tissue, clip_from_optical);
  setShadows(program, shadows);
}

}  // namespace viscera
