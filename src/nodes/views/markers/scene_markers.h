// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nodes/ros/publish_options.h"
#include "render/shapes/tool_shape.h"
#include "render/tube_painter.h"
#include "viscera/layout/limits.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/session/frame.h"
#include "viscera/surface/skin_marks.h"
#include "viscera/tools/stylus.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Poses of tools, obstacles and sutures, and the forces on the styluses.
struct SceneStyle {
  ToolMotions tools;
  std::vector<Pose> obstacles;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  VisibleTubes sutures = {};                                            ///< sutures without needles
  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m = {};  ///< see Frame
  std::vector<NeedleState> needles = {};
  std::array<bool, layout::kMaxStyluses> in_tf = {};  ///< whether the tool's pose is that of its frame in tf
  std::shared_ptr<const VisibleMarks> marks = {};     ///< marks on the tissue; null: none
  std::vector<MarkPiece> mark_pieces = {};            ///< their lines on a recent surface
  VisibleTubes strands = {};
};
/// Returns the contents of a frame. @param samples  samples that determine the tool frames in tf
SceneStyle styleOf(const Frame& frame, const StylusSamples& samples);

/// A name that is drawn upright in space.
struct Label {
  std::string text;
  Vector3d position_m;  ///< position of its centre [m]
};

/// Moves labels upwards until none overlaps another.
/// @param height_m  height of a letter [m]
void partLabels(std::vector<Label>& labels, double height_m);

/// Everything that the camera shows in addition to the tissue, as markers for rviz: tools and obstacles as meshes,
/// sutures, needles and marks on the tissue as lines, forces as arrows, held nodes as points, names. While there is no
/// tissue, a text shows the progress instead. The namespaces are `tools`, `obstacles`, `sutures`, `needles`, `marks`,
/// `forces`, `held`, `names` and `preparing`. Absent objects are sent as DELETE, so any array is complete. The mesh of
/// a tool is in the tool's tf frame if the tool's pose is that of the frame, and moves with it.
class SceneMarkers {
 public:
  SceneMarkers(const Scene& scene, const PublishOptions& options);
  visualization_msgs::MarkerArray at(const SceneStyle& style, const ros::Time& stamp) const;
  /// Returns markers with a text where the first camera looks, and nothing else.
  visualization_msgs::MarkerArray telling(const std::string& text, const ros::Time& stamp) const;

 private:
  /// Triangles of one colour.
  struct Part {
    std::array<uint8_t, 4> color;
    std::vector<geometry_msgs::Point> corners;
  };
  using Parts = std::vector<Part>;
  struct Obstacle {
    std::string name;
    Parts parts;
    std::vector<Vector3d> points_m;  ///< points of its shape [m]
  };
  static Parts partsOf(const ToolShape& shape);
  visualization_msgs::Marker marker(const char* names, size_t id, const ros::Time& stamp) const;
  /// @param frame  tf frame to which the parts are locked; empty: the tissue frame
  void addParts(const char* names, size_t first_id, const Parts& parts, const Pose& pose, const std::string& frame,
                const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addTool(size_t stylus, const SceneStyle& style, const ros::Time& stamp,
               visualization_msgs::MarkerArray& out) const;
  void addForce(size_t stylus, const SceneStyle& style, const ros::Time& stamp,
                visualization_msgs::MarkerArray& out) const;
  void addHeld(size_t stylus, const SceneStyle& style, const ros::Time& stamp,
               visualization_msgs::MarkerArray& out) const;
  void addLine(const char* names, size_t id, const TubeStyle& how, const std::vector<Vector3d>& positions_m,
               const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addNeedles(const SceneStyle& style, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addStrands(const SceneStyle& style, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addTubes(const SceneStyle& style, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addText(const std::string& text, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addMarks(const SceneStyle& style, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addNames(const SceneStyle& style, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;

  const std::string frame_;
  const double arrow_m_per_n_, letter_m_;
  std::vector<StylusConfig> styluses_;
  std::vector<std::string> tool_frames_;          ///< [styluses]
  std::vector<std::map<ToolMode, Parts>> tools_;  ///< [styluses]
  std::vector<Obstacle> obstacles_;
  std::vector<TubeStyle> sutures_;
  std::vector<Label> cameras_;
  Vector3d middle_m_ = Vector3d::Zero();  ///< centre of the view [m]
};

}  // namespace viscera::nodes
