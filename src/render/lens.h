// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "gpu/program.h"
#include "render/geometry_target.h"
#include "render/render_target.h"
#include "render/vertex_array.h"
#include "viscera/render/camera.h"

namespace viscera {

/// Distorts the image of a pinhole camera to that of a camera with distortion, by one line of sight per pixel, computed
/// once. Owner of shaders/draw/lens.frag, with whole.vert.
class Lens {
 public:
  /// Needs a current context. @param camera  with distortion; it distorts images of pinholeOf(camera)
  /// @throws GpuError  a size that the driver refuses
  explicit Lens(const CameraConfig& camera);
  ~Lens();
  Lens(const Lens&) = delete;
  Lens& operator=(const Lens&) = delete;

  /// Distorts the image that is bound for reading, and binds the result for reading.
  void bend();
  /// Binds the last result for drawing.
  void bindForDrawing() const { image_.bindForDrawing(); }
  void bindForReading() const { image_.bindForReading(); }
  /// Distorts depths and labels, without interpolation across borders.
  void bend(const GeometryTarget& seen);
  const GeometryTarget& geometry() const { return *geometry_; }  ///< the last result

 private:
  void draw(const gpu::Program& program) const;

  int width_, height_;  ///< of the pinhole
  float steepest_;      ///< see lens.frag
  gpu::Program bend_, bend_geometry_;
  RenderTarget image_;
  std::unique_ptr<GeometryTarget> geometry_;  ///< null until requested
  uint32_t sights_ = 0, colors_ = 0, depths_ = 0, labels_ = 0;
  VertexArray nothing_;
};

}  // namespace viscera
