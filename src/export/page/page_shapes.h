// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "export/page/page_bytes.h"
#include "render/shapes/tool_shape.h"
#include "render/tube_painter.h"
#include "viscera/session/session.h"

namespace viscera {

/// Rigid thing of a scene that is drawn: the shaft and tip of a stylus in a mode, one of its fingers, or an obstacle.
struct PageShape {
  enum class Kind : uint8_t { kTool, kFinger, kObstacle };
  Kind kind = Kind::kTool;
  size_t index = 0;  ///< of the stylus or of the obstacle
  ToolMode mode = ToolMode::kNone;

  bool operator<(const PageShape& other) const {
    return std::tie(kind, index, mode) < std::tie(other.kind, other.index, other.mode);
  }
};

/// A rigid thing where it is.
struct PlacedShape {
  PageShape shape;
  Pose pose;  ///< tissue frame
};

/// Returns the triangles of a rigid thing.
ToolShape triangleShape(const Scene& scene, const PageShape& shape);
/// Appends a shape: vertices, then indices.
void putShape(const ToolShape& shape, PageBytes& out);
/// Returns the tools and obstacles that a frame shows.
std::vector<PlacedShape> placedShapes(const Session& session, const Frame& now);

/// Returns what a page needs to know of a scene, as JSON: names, cameras, appearance of tubes.
nlohmann::ordered_json sceneJson(const Session& session, const std::vector<TubeStyle>& styles);

/// Sutures, clips and needles of a scene, with their appearance.
class SceneShapes {
 public:
  SceneShapes() = default;
  explicit SceneShapes(const Scene& scene);
  const std::vector<TubeStyle>& styles() const { return styles_; }
  /// Returns the number of the style of a tube.
  uint32_t styleOf(const VisibleTube& tube) const;

 private:
  std::vector<TubeStyle> styles_;
};

/// Returns the tubes of a moment: sutures and clips of the frame, then needles.
VisibleTubes tubesOf(const Session& session, const Frame& now);

/// Colours of the vertices of a surface mesh.
class SceneColors {
 public:
  SceneColors() = default;  ///< one colour per body and one for its walls
  explicit SceneColors(const Model& model);
  /// Returns the colour of every vertex, RGBA8: alpha as in surface/skins/part_colors.h. Walls of wounds are darker.
  std::vector<uint32_t> of(const VisibleMesh& skin) const;

 private:
  std::vector<uint32_t> whole_;  ///< of the uncut mesh
};

}  // namespace viscera
