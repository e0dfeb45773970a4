// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "nodes/ros/publish_options.h"
#include "render/shapes/tool_shape.h"
#include "render/thread_painter.h"
#include "viscera/layout/limits.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/session/frame.h"
#include "viscera/tools/stylus.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// Where tools, obstacles and threads are, and what the hands feel.
struct SceneLook {
  ToolMotions tools;
  std::vector<Pose> obstacles;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  ShownThreads threads = {};                                            ///< without needles
  std::array<std::vector<Vector3d>, layout::kMaxStyluses> held_m = {};  ///< see Frame
  std::vector<SeenNeedle> needles = {};
  std::array<bool, layout::kMaxStyluses> in_tf = {};  ///< the tool is where its frame in tf is
};
/// @param samples  as the frames of the tools in tf have them
SceneLook lookOf(const Frame& frame, const StylusSamples& samples);

/// A name that stands upright in space.
struct Label {
  std::string text;
  Vector3d position_m;  ///< of its middle
};

/// Moves labels upwards until none stands in another's place.
/// @param height_m  of a letter
void partLabels(std::vector<Label>& labels, double height_m);

/// What the camera shows beside the tissue, as markers for rviz: tools and obstacles as meshes, threads and needles
/// as lines, forces as arrows, nodes that are held as points, names; or, as long as there is no tissue, what is done
/// for it. Namespaces `tools`, `obstacles`, `threads`, `needles`, `forces`, `held`, `names`, `preparing`. What is not
/// there is told as DELETE, so that any array is the whole truth. A mesh of a tool that is where its frame in tf is
/// stands in that frame, and goes with it.
class SceneMarkers {
 public:
  SceneMarkers(const Scene& scene, const PublishOptions& options);
  visualization_msgs::MarkerArray at(const SceneLook& look, const ros::Time& stamp) const;
  /// A text where the first camera looks, and nothing else.
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
    std::vector<Vector3d> points_m;  ///< of its shape
  };
  static Parts partsOf(const ToolShape& shape);
  visualization_msgs::Marker marker(const char* names, size_t id, const ros::Time& stamp) const;
  /// @param frame  in tf that the parts are locked to; empty: they are in the tissue frame
  void addParts(const char* names, size_t first_id, const Parts& parts, const Pose& pose, const std::string& frame,
                const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addTool(size_t stylus, const SceneLook& look, const ros::Time& stamp,
               visualization_msgs::MarkerArray& out) const;
  void addForce(size_t stylus, const SceneLook& look, const ros::Time& stamp,
                visualization_msgs::MarkerArray& out) const;
  void addHeld(size_t stylus, const SceneLook& look, const ros::Time& stamp,
               visualization_msgs::MarkerArray& out) const;
  void addLine(const char* names, size_t id, const ThreadLook& how, const std::vector<Vector3d>& places_m,
               const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addNeedles(const SceneLook& look, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addThreads(const SceneLook& look, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addText(const std::string& text, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;
  void addNames(const SceneLook& look, const ros::Time& stamp, visualization_msgs::MarkerArray& out) const;

  const std::string frame_;
  const double arrow_m_per_n_, letter_m_;
  std::vector<StylusConfig> styluses_;
  std::vector<std::string> tool_frames_;          ///< [styluses]
  std::vector<std::map<ToolMode, Parts>> tools_;  ///< [styluses]
  std::vector<Obstacle> obstacles_;
  std::vector<ThreadLook> threads_;
  std::vector<Label> cameras_;
  Vector3d middle_m_ = Vector3d::Zero();  ///< of the view
};

}  // namespace viscera::nodes
