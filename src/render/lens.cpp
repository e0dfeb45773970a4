// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/lens.h"

#include <string>
#include <vector>

#include "gpu/gl.h"
#include "layout/seen.h"
#include "render/deferred_lighting.h"
#include "render/g_buffer.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Returns a new texture. @throws GpuError  the driver refuses the size
uint32_t checkedTexture(GLenum format, int width, int height, GLenum filter) {
  const uint32_t id = makeTexture(format, width, height, filter);
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR) return id;
  glDeleteTextures(1, &id);
  throw GpuError("cannot create a texture of " + std::to_string(width) + " x " + std::to_string(height) +
                 " pixels for a lens with distortion: " + gpu::glErrorText(code));
}

/// Returns where in the image of its pinhole each pixel of a camera looks [2 * width * height, px].
std::vector<float> sightsOf(const CameraConfig& camera, const CameraConfig& pinhole) {
  const Intrinsics k = intrinsics(pinhole);
  std::vector<float> out;
  out.reserve(size_t{2} * static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px));
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column) {
      const Vector3d sight = lineOfSight(camera, {column + 0.5, row + 0.5});
      out.push_back(static_cast<float>(k.fx * sight.x() + k.cx));
      out.push_back(static_cast<float>(k.fy * sight.y() + k.cy));
    }
  }
  return out;
}

}  // namespace

Lens::Lens(const CameraConfig& camera)
    : bend_(gpu::Program::graphics("whole.vert", "lens.frag")), image_(camera.width_px, camera.height_px, 1) {
  const CameraConfig pinhole = pinholeOf(camera);
  width_ = pinhole.width_px;
  height_ = pinhole.height_px;
  steepest_ = DeferredLighting::kSteepest / static_cast<float>(intrinsics(pinhole).fx);
  colors_ = checkedTexture(GL_SRGB8_ALPHA8, width_, height_, GL_LINEAR);
  sights_ = checkedTexture(GL_RG32F, camera.width_px, camera.height_px, GL_NEAREST);
  const std::vector<float> sights = sightsOf(camera, pinhole);
  glTextureSubImage2D(sights_, 0, 0, 0, camera.width_px, camera.height_px, GL_RG, GL_FLOAT, sights.data());
}

Lens::~Lens() {
  for (const uint32_t texture : {sights_, colors_, depths_, labels_}) {
    if (texture) glDeleteTextures(1, &texture);
  }
}

void Lens::bend() {
  glCopyTextureSubImage2D(colors_, 0, 0, 0, 0, 0, width_, height_);
  glBindTextureUnit(layout::kUnitPinhole, colors_);
  image_.bindForDrawing();
  draw(bend_);
  image_.bindForReading();
}

void Lens::bend(const GeometryTarget& seen) {
  if (!geometry_) {
    bend_geometry_ = gpu::Program::graphics("whole.vert", "lens.frag", {"GEOMETRY"});
    bend_geometry_.set("steepest", steepest_);
    depths_ = checkedTexture(GL_R32F, width_, height_, GL_NEAREST);
    labels_ = checkedTexture(GL_R8UI, width_, height_, GL_NEAREST);
    geometry_ = std::make_unique<GeometryTarget>(image_.width(), image_.height());
  }
  seen.bindDepths();
  glCopyTextureSubImage2D(depths_, 0, 0, 0, 0, 0, width_, height_);
  seen.bindLabels();
  glCopyTextureSubImage2D(labels_, 0, 0, 0, 0, 0, width_, height_);
  glBindTextureUnit(layout::kUnitPinholeDepths, depths_);
  glBindTextureUnit(layout::kUnitPinholeLabels, labels_);
  geometry_->bindEmpty();
  draw(bend_geometry_);
}

void Lens::draw(const gpu::Program& program) const {
  glBindTextureUnit(layout::kUnitSights, sights_);
  glBindVertexArray(nothing_.id());
  glDisable(GL_DEPTH_TEST);
  program.use();
  program.set("clip_depth", 0.0F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

}  // namespace viscera
