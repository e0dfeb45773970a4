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
#include "render/g_buffer.h"
#include "render/geometry_target.h"
#include "render/lens.h"
#include "render/render_target.h"
#include "surface/surface.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/render/camera.h"
#include "viscera/solver/visible_tube.h"
#include "viscera/surface/skin_marks.h"
#include "viscera/tools/stylus.h"

namespace viscera {

class TissuePainter;
class ToolPainter;
class ObstaclePainter;
class OverlayPainter;
class TubePainter;
struct TubeStyle;
struct OverlayStyle;

/// Triangles on the GPU; buffer names are OpenGL's.
struct MeshView {
  uint32_t positions = 0;  ///< float[3 * vertices] m, tissue frame
  uint32_t normals = 0;    ///< uint[vertices] packed as packNormal(); a null normal is shaded flat
  uint32_t colors = 0;     ///< uint[vertices] sRGB, red in the lowest byte
  uint32_t indices = 0;    ///< uint[index_count], counter-clockwise seen from outside; (0, 0, 0) draws nothing
  size_t index_count = 0;
  uint32_t rests = 0;   ///< vec4[vertices] see JoinedSkins::rests; 0: none, and no detail
  uint32_t charts = 0;  ///< texel view of uint[index_count / 3] texture charts (JoinedSkins::charts); 0: none
  const IndexRuns* runs = nullptr;  ///< those to draw; null: all
  bool painted = false;             ///< Surface::needsPaint()
};

/// Draws off-screen colour images of the surface and the tools, with one framebuffer per camera. Draws only on request.
///
/// Images are 8-bit sRGB. Their first row is OpenGL's bottom row: rows read back come top first (see clipFromOptical).
class Renderer {
 public:
  /// Antialiasing is CameraConfig::supersampling: every pixel is the mean of n x n drawn ones. Where that is 0, n is 2.
  /// A software rasteriser then lights tissue once per pixel that shows one surface, and four times at edges
  /// (DeferredLighting), not in every fragment of small triangles.
  /// @throws SceneError  a camera without a line of sight;  GpuError  a framebuffer that the driver refuses
  /// @param model  of the drawn surface, for its textures, must outlive this; null: none
  /// @param marks  whether there will be marks; else showMarks() makes the shaders for them
  Renderer(const std::vector<CameraConfig>& cameras, const std::vector<StylusConfig>& styluses,
           const std::vector<ObstacleConfig>& obstacles = {}, const Model* model = nullptr, bool marks = false);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws one camera's view and leaves its single-sample colour attachment bound for reading (for ReadbackRing). Makes
  /// no OpenGL object, and sets all the OpenGL state that it depends on.
  /// @param runs  drawn part of the surface (Surface::runsOf); null: all
  void draw(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs = nullptr);
  void draw(size_t camera, const MeshView& mesh, const ToolMotions& motions);
  /// Draws as draw() does, with overlays. Makes what they need on the first call. @param model  of look.surface, must
  /// outlive this
  void draw(size_t camera, const Model& model, const OverlayStyle& style, const ToolMotions& motions);
  /// Sets the obstacles for later images. @param poses  [obstacles] tissue frame; without a call there are none
  void placeObstacles(const std::vector<Pose>& poses) { obstacle_poses_ = poses; }
  /// Sets the colours of surfaces for later images, one per vertex; 0: their own.
  void showColors(uint32_t colors) { shown_colors_ = colors; }
  /// Sets the marks on tissue for later images, but not for depths and labels; null: none. Needs a current context.
  void showMarks(const std::shared_ptr<const VisibleMarks>& marks);
  /// Adds sutures to draw in later images, once they are placed. Needs a current context.
  void addTubes(const std::vector<TubeStyle>& sutures);
  void placeTubes(const VisibleTubes& shown) { visible_tubes_ = shown; }
  /// Sets the pose of a camera's optical frame in the tissue frame for later images; initially it is that of its keys.
  void placeCamera(size_t camera, const Pose& pose) { camera_poses_[camera] = pose; }
  /// Draws depths and labels of all that a camera sees, without tools' outlines. Makes what that needs on the first
  /// call. Binds nothing for reading: see geometry().
  void drawGeometry(size_t camera, const Surface& surface, const ToolMotions& motions, const IndexRuns* runs = nullptr);
  void drawGeometry(size_t camera, const MeshView& mesh, const ToolMotions& motions);
  /// Returns the last result of drawGeometry(), of a camera with one.
  const GeometryTarget& geometry(size_t camera) const {
    return lenses_[camera] ? lenses_[camera]->geometry() : *geometries_[camera];
  }
  /// Binds the image that was drawn last for reading, as draw() does, without drawing.
  void bindLast(size_t camera) const;
  uint64_t renders() const { return renders_; }
  /// Sets a function that is called while an image is drawn with lighting per pixel, between passes that no longer need
  /// the mesh. It may change the mesh and run kernels. Empty: none.
  void setPause(std::function<void()> pause) { pause_ = std::move(pause); }

 private:
  struct View {  ///< of one camera
    size_t camera;
    Pose optical_from_tissue;
    Eigen::Matrix4f clip_from_optical;
  };
  MeshView meshOf(const Surface& surface, const IndexRuns* runs) const;
  View viewOf(size_t camera) const;
  void makeTissue(bool marks, bool paint);
  bool lightsPixels(const CameraConfig& camera) const;
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

  std::vector<CameraConfig> cameras_;  ///< pinholes
  const Model* model_;                 ///< null: none
  bool has_marks_ = false;             ///< shaders of tissue_ draw marks
  bool has_paint_ =
      false;  ///< they draw burns and lips of cuts, which costs a quarter of an image on a software renderer
  std::shared_ptr<const VisibleMarks> marks_;
  std::vector<std::unique_ptr<Lens>> lenses_;  ///< [cameras] distortion of their images; null: none
  std::vector<StylusConfig> styluses_;
  std::vector<Pose> camera_poses_;                           ///< [cameras] of the optical frames, tissue frame
  std::vector<std::unique_ptr<RenderTarget>> targets_;       ///< [cameras] null with lighting per pixel
  std::vector<std::unique_ptr<GBuffer>> lit_targets_;        ///< [cameras] null with lighting per sample
  std::vector<std::unique_ptr<GeometryTarget>> geometries_;  ///< [cameras] null until requested
  gpu::Program geometry_program_;                            ///< empty until then
  std::unique_ptr<TissuePainter> tissue_;
  std::unique_ptr<ToolPainter> tools_;
  std::unique_ptr<ObstaclePainter> obstacles_;  ///< null where the scene has none
  std::unique_ptr<OverlayPainter> overlays_;    ///< null until requested
  std::unique_ptr<TubePainter> sutures_;        ///< null without sutures
  std::vector<Pose> obstacle_poses_;
  VisibleTubes visible_tubes_;
  uint32_t shown_colors_ = 0;
  std::vector<std::string> light_features_;  ///< of lighting shaders; features that no camera needs are left out
  uint64_t renders_ = 0;
  std::function<void()> pause_;
};

}  // namespace viscera
