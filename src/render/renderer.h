// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu/program.h"
#include "render/geometry_target.h"
#include "render/lens.h"
#include "render/render_target.h"
#include "render/seen_target.h"
#include "surface/surface.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/render/camera.h"
#include "viscera/solver/shown_thread.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class TissuePainter;
class ToolPainter;
class ObstaclePainter;
class OverlayPainter;
class ThreadPainter;
struct ThreadLook;
struct OverlayLook;

/// Triangles that are on the GPU already; buffer names are OpenGL's.
struct MeshView {
  uint32_t positions = 0;  ///< float[3 * vertices] m, tissue frame
  uint32_t normals = 0;    ///< uint[vertices] packed as packNormal(); a null normal is shaded flat
  uint32_t colors = 0;     ///< uint[vertices] sRGB, red in the lowest byte
  uint32_t indices = 0;    ///< uint[index_count], counter-clockwise seen from outside; (0, 0, 0) draws nothing
  size_t index_count = 0;
  uint32_t rests = 0;   ///< vec4[vertices] see JoinedSkins::rests; 0: none, and no detail
  uint32_t charts = 0;  ///< texel view of uint[index_count / 3] texture charts (JoinedSkins::charts); 0: none
  const IndexRuns* runs = nullptr;  ///< those that are drawn; null: all are
};

/// Off-screen colour images of the surface and the tools, one framebuffer per camera. Draws only when asked.
///
/// Images are 8-bit sRGB. Their first row is OpenGL's bottom row: rows read back come top first (see clipFromOptical).
class Renderer {
 public:
  /// Antialiasing is CameraConfig::supersampling: every pixel is the mean of n x n drawn ones. Where that is 0, they
  /// are 2 x 2, and on a software rasteriser tissue is not lit where it is drawn, in fragments of small triangles, but
  /// once per pixel of one surface, and four times at edges (SeenLight).
  /// @throws SceneError  a camera without a line of sight;  GpuError  a framebuffer that the driver refuses
  /// @param model  whose surface is drawn: its textures are; null: none are
  Renderer(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
           const std::vector<ObstacleConfig>& obstacles = {}, const Model* model = nullptr);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws one camera's view and leaves its single-sample colour attachment bound for reading (for ReadbackRing).
  /// Makes no OpenGL object, and sets all the state that it depends on.
  /// @param runs  what is drawn of the surface (Surface::runsOf); null: all
  void draw(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs = nullptr);
  void draw(size_t camera, const MeshView& mesh, const ToolMotions& motions);
  /// As draw(), with overlays; makes what they need at the first time. @param model  of look.surface, must outlive this
  void draw(size_t camera, const Model& model, const OverlayLook& look, const ToolMotions& motions);
  /// Where obstacles are drawn from now on. @param poses  [obstacles] tissue frame; nowhere before the first call
  void placeObstacles(const std::vector<Pose>& poses) { obstacle_poses_ = poses; }
  /// Colours that surfaces are drawn in from now on in place of their own, which are of as many vertices; 0: their own.
  void showColors(uint32_t colors) { shown_colors_ = colors; }
  /// Threads that are drawn from now on, once they are placed. Needs a current context.
  void addThreads(const std::vector<ThreadLook>& threads);
  void placeThreads(const ShownThreads& shown) { shown_threads_ = shown; }
  /// Where a camera's optical frame is in what is drawn from now on, tissue frame; at first where its keys say.
  void placeCamera(size_t camera, const Pose& pose) { camera_poses_[camera] = pose; }
  /// Draws how far away what a camera sees is and what it is, tools' outlines left out; makes what that needs at the
  /// first time. Nothing is bound for reading: see geometry().
  void drawGeometry(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs = nullptr);
  void drawGeometry(size_t camera, const MeshView& mesh, const ToolMotions& motions);
  /// What was drawn so last, of a camera of which it was.
  const GeometryTarget& geometry(size_t camera) const {
    return lenses_[camera] ? lenses_[camera]->geometry() : *geometries_[camera];
  }
  /// Leaves the image that was drawn last bound for reading, as draw() does, without drawing.
  void bindLast(size_t camera) const;
  uint64_t renders() const { return renders_; }
  /// Is called while an image is being drawn whose pixels are lit, whenever the mesh is not needed for it any more and
  /// a pass is at its end: it may move the mesh and run kernels. Empty: nothing is.
  void setPause(std::function<void()> pause) { pause_ = std::move(pause); }

 private:
  struct View {  ///< of one camera
    size_t camera;
    Pose optical_from_tissue;
    Eigen::Matrix4f clip_from_optical;
  };
  MeshView meshOf(const Surface& surface, const IndexRuns* runs) const;
  View viewOf(size_t camera) const;
  void lightFor(const CameraConfig& camera);
  double pixelOf(size_t camera) const;
  template <class DrawOver>
  void drawImage(size_t camera, const MeshView& mesh, const ToolMotions& motions, bool tissue, DrawOver drawOver);
  template <class DrawOver>
  void drawSamples(const View& view, const MeshView& mesh, const ToolMotions& motions, bool tissue, DrawOver drawOver);
  void drawTissue(const View& view, const MeshView& mesh, const ToolMotions& motions);
  template <class DrawOver>
  void drawRest(const View& view, const ToolMotions& motions, DrawOver drawOver);
  template <class DrawOver>
  void drawPixels(const View& view, const MeshView& mesh, const ToolMotions& motions, bool tissue, DrawOver drawOver);

  std::vector<CameraConfig> cameras_;          ///< pinholes
  std::vector<std::unique_ptr<Lens>> lenses_;  ///< [cameras] what bends their images; null: nothing does
  std::vector<StylusConfig> styluses_;
  std::vector<Pose> camera_poses_;                           ///< [cameras] of the optical frames, tissue frame
  std::vector<std::unique_ptr<RenderTarget>> targets_;       ///< [cameras] null where pixels are lit
  std::vector<std::unique_ptr<SeenTarget>> lit_targets_;     ///< [cameras] null where samples are lit
  std::vector<std::unique_ptr<GeometryTarget>> geometries_;  ///< [cameras] null until one is wanted
  gpu::Program geometry_program_;                            ///< none until then
  std::unique_ptr<TissuePainter> tissue_;
  std::unique_ptr<ToolPainter> tools_;
  std::unique_ptr<ObstaclePainter> obstacles_;  ///< null where the scene has none
  std::unique_ptr<OverlayPainter> overlays_;    ///< null until one is wanted
  std::unique_ptr<ThreadPainter> threads_;      ///< null where there are none
  std::vector<Pose> obstacle_poses_;
  ShownThreads shown_threads_;
  uint32_t shown_colors_ = 0;
  std::vector<std::string>
      light_features_;  ///< of shaders that light what is drawn: what no camera asks for is left out
  uint64_t renders_ = 0;
  std::function<void()> pause_;
};

}  // namespace viscera
