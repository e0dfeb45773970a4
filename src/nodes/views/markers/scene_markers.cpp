// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/scene_markers.h"

#include <algorithm>
#include <cmath>

#include "model/scene/tool_kinds.h"
#include "nodes/ros/conversions.h"
#include "render/shapes/obstacle_shape.h"
#include "session/tube_styles.h"
#include "solver/processes/suture/needle_shape.h"
#include "viscera/model/scene/scene.h"
#include "viscera/render/camera.h"

namespace viscera::nodes {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr size_t kMostParts = 4;        ///< most colours of a tool or obstacle; the ids of the next one follow
constexpr double kLetterShare = 0.025;  ///< height of a letter over the first camera's distance from its target
constexpr double kLetterWithoutCamera_m = 0.01;
constexpr double kLetterWidth = 0.65;  ///< width of a letter with its gap, relative to its height
constexpr double kLineHeight = 1.6;    ///< line height relative to a letter's: rviz looks down at about 30 degrees
constexpr double kLeastArrow_m = 1e-4;
constexpr double kLeastSuture_m = 5e-4;  ///< least width of a line [m]; rviz loses lines that are thinner than a pixel
constexpr double kArrowWidth = 2.5;      ///< width in radii of the shaft: forces are mostly along it
constexpr double kHeldPoint_m = 1.5e-3;
constexpr size_t kMarkWidths = 8;        ///< widths of the lines of marks: a marker has lines of one width
constexpr double kSceneMarkersHead = 2;  ///< width and length of an arrow's head, relative to its width

geometry_msgs::Point toPoint(const Vector3d& p_m) {
  geometry_msgs::Point out;
  out.x = p_m.x(), out.y = p_m.y(), out.z = p_m.z();
  return out;
}

void paint(const std::array<uint8_t, 4>& color, Marker& marker) {
  constexpr float kFull = 255;
  marker.color.r = static_cast<float>(color[0]) / kFull;
  marker.color.g = static_cast<float>(color[1]) / kFull;
  marker.color.b = static_cast<float>(color[2]) / kFull;
  marker.color.a = static_cast<float>(color[3]) / kFull;
}

double letterHeight(const Scene& scene) {
  if (scene.cameras.empty()) return kLetterWithoutCamera_m;
  return kLetterShare * (scene.cameras[0].position_m - scene.cameras[0].target_m).norm();
}

bool isObscuring(const Label& a, const Label& b, double height_m) {
  const Vector3d apart_m = a.position_m - b.position_m;
  const double widths_m = kLetterWidth * height_m * static_cast<double>(a.text.size() + b.text.size()) / 2;
  return std::abs(apart_m.z()) < kLineHeight * height_m && apart_m.head<2>().norm() < widths_m;
}

/// Returns whether two poses are equal except for rounding.
bool isSame(const Pose& a, const Pose& b) {
  constexpr double kApart_m = 1e-9, kApart_rad = 1e-6;
  return (a.position_m - b.position_m).norm() < kApart_m && a.orientation.angularDistance(b.orientation) < kApart_rad;
}

std::vector<Vector3d> pointsOf(const ToolShape& shape) {
  std::vector<Vector3d> points_m;
  for (const ToolVertex& vertex : shape.vertices)
    points_m.emplace_back(vertex.position_m[0], vertex.position_m[1], vertex.position_m[2]);
  return points_m;
}

}  // namespace

SceneStyle styleOf(const Frame& frame, const StylusSamples& samples) {
  SceneStyle style{frame.tools, frame.obstacles, frame.reactions, frame.sutures, frame.held_m, frame.needles};
  style.marks = frame.marks;
  style.strands = frame.strands;
  for (size_t s = 0; s < samples.size(); ++s)
    style.in_tf[s] = samples[s].valid && frame.tools[s].present && isSame(samples[s].pose, frame.tools[s].to);
  return style;
}

void partLabels(std::vector<Label>& labels, double height_m) {
  constexpr double kPast = 1 + 1e-9;  // rounding must not leave two labels in contact
  for (size_t i = 1; i < labels.size(); ++i) {
    // Each move passes one of the earlier labels, and none is met twice.
    for (size_t j = 0; j < i;) {
      if (!isObscuring(labels[i], labels[j], height_m)) {
        ++j;
        continue;
      }
      labels[i].position_m.z() = labels[j].position_m.z() + kPast * kLineHeight * height_m;
      j = 0;
    }
  }
}

SceneMarkers::SceneMarkers(const Scene& scene, const PublishOptions& options)
    : frame_(scene.environment.tissue_frame),
      arrow_m_per_n_(options.force_arrow_m_per_n),
      letter_m_(letterHeight(scene)),
      sutures_(stylesOf(scene)) {
  for (const StylusConfig& stylus : scene.styluses) {
    styluses_.push_back(stylus);
    tool_frames_.push_back(toolFrame(stylus, options.frame_prefix));
    auto& shapes = tools_.emplace_back();
    for (const ToolMode mode : {ToolMode::kNone, stylus.idle, stylus.button1, stylus.button2})
      shapes[mode] = partsOf(toolShape(stylus, mode));
  }
  for (const ObstacleConfig& obstacle : scene.obstacles) {
    const ToolShape shape = obstacleShape(obstacle);
    obstacles_.push_back({obstacle.name, partsOf(shape), pointsOf(shape)});
  }
  for (const CameraConfig& camera : scene.cameras)
    if (camera.stylus.empty()) cameras_.push_back({camera.name, camera.position_m});
  if (!scene.cameras.empty()) middle_m_ = scene.cameras[0].target_m;
}

SceneMarkers::Parts SceneMarkers::partsOf(const ToolShape& shape) {
  Parts parts;
  for (const uint32_t index : shape.indices) {
    const ToolVertex& vertex = shape.vertices[index];
    const auto same = [&](const Part& part) { return part.color == vertex.color; };
    auto part = std::find_if(parts.begin(), parts.end(), same);
    if (part == parts.end()) part = parts.insert(part, {vertex.color, {}});
    part->corners.push_back(toPoint({vertex.position_m[0], vertex.position_m[1], vertex.position_m[2]}));
  }
  return parts;
}

MarkerArray SceneMarkers::at(const SceneStyle& style, const ros::Time& stamp) const {
  MarkerArray out;
  for (size_t s = 0; s < styluses_.size(); ++s) {
    addTool(s, style, stamp, out);
    addForce(s, style, stamp, out);
    addHeld(s, style, stamp, out);
  }
  for (size_t i = 0; i < std::min(obstacles_.size(), style.obstacles.size()); ++i)
    addParts("obstacles", kMostParts * i, obstacles_[i].parts, style.obstacles[i], "", stamp, out);
  addTubes(style, stamp, out);
  addNeedles(style, stamp, out);
  addStrands(style, stamp, out);
  addMarks(style, stamp, out);
  addNames(style, stamp, out);
  addText("", stamp, out);
  return out;
}

MarkerArray SceneMarkers::telling(const std::string& text, const ros::Time& stamp) const {
  MarkerArray out;
  Marker& all = out.markers.emplace_back(marker("preparing", 0, stamp));
  all.action = Marker::DELETEALL;
  addText(text, stamp, out);
  return out;
}

Marker SceneMarkers::marker(const char* names, size_t id, const ros::Time& stamp) const {
  Marker out;
  out.header.frame_id = frame_;
  out.header.stamp = stamp;
  out.ns = names;
  out.id = static_cast<int32_t>(id);
  out.pose.orientation.w = 1;
  out.scale.x = out.scale.y = out.scale.z = 1;
  return out;
}

/// Adds the parts of a mesh and deletes the remaining ids.
void SceneMarkers::addParts(const char* names, size_t first_id, const Parts& parts, const Pose& pose,
                            const std::string& frame, const ros::Time& stamp, MarkerArray& out) const {
  for (size_t i = 0; i < kMostParts; ++i) {
    Marker& marker = out.markers.emplace_back(this->marker(names, first_id + i, stamp));
    marker.type = Marker::TRIANGLE_LIST;
    marker.action = i < parts.size() ? Marker::ADD : Marker::DELETE;
    if (i >= parts.size()) continue;
    if (frame.empty()) {
      marker.pose = toMessage(pose);
    } else {
      marker.header.frame_id = frame;
      marker.header.stamp = ros::Time();  // the newest transform
      marker.frame_locked = true;
    }
    paint(parts[i].color, marker);
    marker.points = parts[i].corners;
  }
}

void SceneMarkers::addTool(size_t stylus, const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  static const Parts kNothing;
  const StylusMotion& motion = style.tools[stylus];
  const auto shape = tools_[stylus].find(motion.mode);
  const bool shown = motion.present && shape != tools_[stylus].end();
  const bool jaws = shown && kindOf(motion.mode).jaws;
  const Parts turned = jaws ? partsOf(toolShape(styluses_[stylus], motion.mode, motion.opens_to_rad)) : kNothing;
  addParts("tools", kMostParts * stylus,
           jaws    ? turned
           : shown ? shape->second
                   : kNothing,
           motion.to, style.in_tf[stylus] ? tool_frames_[stylus] : "", stamp, out);
}

/// Adds the force as an arrow from the tip, in the direction of the force on the stylus.
void SceneMarkers::addForce(size_t stylus, const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  constexpr std::array<uint8_t, 4> kYellow = {250, 210, 40, 200};  // transparent, since it hides the tool
  const Vector3d arrow_m = arrow_m_per_n_ * style.reactions[stylus].force_n;
  Marker& marker = out.markers.emplace_back(this->marker("forces", stylus, stamp));
  marker.type = Marker::ARROW;
  marker.action = Marker::DELETE;
  if (!style.tools[stylus].present || !arrow_m.allFinite() || arrow_m.norm() < kLeastArrow_m) return;
  marker.action = Marker::ADD;
  const Vector3d& tip_m = style.tools[stylus].to.position_m;
  marker.points = {toPoint(tip_m), toPoint(tip_m + arrow_m)};
  const double width_m = kArrowWidth * shaftRadius(styluses_[stylus]);
  marker.scale.x = width_m;
  marker.scale.y = kSceneMarkersHead * width_m;
  marker.scale.z = std::min(kSceneMarkersHead * width_m, 0.5 * arrow_m.norm());
  paint(kYellow, marker);
}

void SceneMarkers::addHeld(size_t stylus, const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  constexpr std::array<uint8_t, 4> kBlue = {120, 220, 255, 255};  // differs from tissue, tools and arrows
  Marker& marker = out.markers.emplace_back(this->marker("held", stylus, stamp));
  marker.type = Marker::POINTS;
  marker.action = style.tools[stylus].present && !style.held_m[stylus].empty() ? Marker::ADD : Marker::DELETE;
  if (marker.action == Marker::DELETE) return;
  marker.pose = toMessage(style.tools[stylus].to);
  marker.scale.x = marker.scale.y = kHeldPoint_m;
  paint(kBlue, marker);
  for (const Vector3d& position_m : style.held_m[stylus]) marker.points.push_back(toPoint(position_m));
}

/// Adds a polyline: a tube would need tens of points for each of its points. @param positions_m  fewer than two: no
/// line
void SceneMarkers::addLine(const char* names, size_t id, const TubeStyle& how, const std::vector<Vector3d>& positions_m,
                           const ros::Time& stamp, MarkerArray& out) const {
  Marker& marker = out.markers.emplace_back(this->marker(names, id, stamp));
  marker.type = Marker::LINE_STRIP;
  marker.action = positions_m.size() > 1 ? Marker::ADD : Marker::DELETE;
  if (marker.action == Marker::DELETE) return;
  marker.scale.x = std::max(2 * how.radius_m, kLeastSuture_m);
  paint(how.color, marker);
  for (const Vector3d& position_m : positions_m) marker.points.push_back(toPoint(position_m));
}

void SceneMarkers::addNeedles(const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  for (size_t i = 0, id = 0; i < sutures_.size(); ++i) {
    const TubeStyle& how = sutures_[i];
    if (how.part != TubeKind::kNeedle) continue;
    std::vector<Vector3d> positions_m;
    for (const NeedleState& needle : style.needles)
      if (needle.suture == how.suture)
        positions_m = NeedleShape(needle.radius_m, needle.arc_rad, needle.wire_radius_m).positions(needle.pose);
    addLine("needles", id++, how, positions_m, stamp, out);
  }
}

/// Adds all strands as lines of one marker, if the scene has any attachments.
void SceneMarkers::addStrands(const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  const auto how = std::find_if(sutures_.begin(), sutures_.end(),
                                [](const TubeStyle& one) { return one.part == TubeKind::kStrand; });
  if (how == sutures_.end()) return;
  Marker& marker = out.markers.emplace_back(this->marker("strands", 0, stamp));
  marker.type = Marker::LINE_LIST;
  marker.action = style.strands.empty() ? Marker::DELETE : Marker::ADD;
  marker.scale.x = kLeastSuture_m;
  paint(how->color, marker);
  for (const VisibleTube& strand : style.strands) {
    marker.points.push_back(toPoint(strand.positions_m.front()));
    marker.points.push_back(toPoint(strand.positions_m.back()));
  }
}

void SceneMarkers::addTubes(const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  size_t sutures = 0, clips = 0;
  for (const TubeStyle& style : sutures_) {
    sutures += style.part == TubeKind::kSuture;
    if (style.part == TubeKind::kClip) clips = style.most;
  }
  const TubeStyle* const clip = clips > 0 ? &sutures_.back() : nullptr;
  for (size_t i = 0; i < (sutures > 0 ? sutures + kMostParted : 0) + clips; ++i) {
    static const std::vector<Vector3d> kNone;
    const bool there = i < style.sutures.size();
    const bool is_clip = there && clip && style.sutures[i].part == TubeKind::kClip;
    const TubeStyle& how = is_clip ? *clip : sutures_[there ? style.sutures[i].suture : 0];
    addLine("sutures", i, how, there ? style.sutures[i].positions_m : kNone, stamp, out);
  }
}

/// Adds the lines of marks, one marker for each width; the last one also has all wider ones.
void SceneMarkers::addMarks(const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  std::vector<float> widths_m;
  for (const MarkPiece& piece : style.mark_pieces) widths_m.push_back(piece.width_m);
  std::sort(widths_m.begin(), widths_m.end());
  widths_m.erase(std::unique(widths_m.begin(), widths_m.end()), widths_m.end());
  const size_t first = out.markers.size(), count = std::min(kMarkWidths, widths_m.size());
  for (size_t i = 0; i < kMarkWidths; ++i) {
    Marker& marker = out.markers.emplace_back(this->marker("marks", i, stamp));
    marker.type = Marker::LINE_LIST;
    marker.action = i < count ? Marker::ADD : Marker::DELETE;
    if (i < count) marker.scale.x = static_cast<double>(widths_m[i]);
    marker.color.a = 1;
  }
  for (const MarkPiece& piece : style.mark_pieces) {
    const auto width = std::lower_bound(widths_m.begin(), widths_m.end(), piece.width_m) - widths_m.begin();
    Marker& marker = out.markers[first + std::min(static_cast<size_t>(width), count - 1)];
    std_msgs::ColorRGBA color;
    const Vector3f& of_mark = style.marks->styles[piece.mark].color;
    color.r = of_mark.x(), color.g = of_mark.y(), color.b = of_mark.z(), color.a = 1;
    for (const Vector3f& end_m : {piece.from_m, piece.to_m}) {
      marker.points.push_back(toPoint(end_m.cast<double>()));
      marker.colors.push_back(color);
    }
  }
}

/// Adds a text. @param text  empty: none
void SceneMarkers::addText(const std::string& text, const ros::Time& stamp, MarkerArray& out) const {
  constexpr std::array<uint8_t, 4> kWhite = {255, 255, 255, 255};
  Marker& marker = out.markers.emplace_back(this->marker("preparing", 0, stamp));
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.action = text.empty() ? Marker::DELETE : Marker::ADD;
  marker.pose.position = toPoint(middle_m_);
  marker.scale.z = letter_m_;
  marker.text = text;
  paint(kWhite, marker);
}

void SceneMarkers::addNames(const SceneStyle& style, const ros::Time& stamp, MarkerArray& out) const {
  constexpr std::array<uint8_t, 4> kWhite = {255, 255, 255, 255};
  std::vector<Label> labels = cameras_;
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const Vector3d beyond_m(0, 0, styluses_[s].shaft_length_m + letter_m_);
    if (style.tools[s].present) labels.push_back({styluses_[s].name, style.tools[s].to * beyond_m});
  }
  for (size_t i = 0; i < std::min(obstacles_.size(), style.obstacles.size()); ++i) {
    Vector3d position_m = style.obstacles[i].position_m;
    for (const Vector3d& point_m : obstacles_[i].points_m)
      position_m.z() = std::max(position_m.z(), (style.obstacles[i] * point_m).z());
    labels.push_back({obstacles_[i].name, position_m + Vector3d(0, 0, letter_m_)});
  }
  partLabels(labels, letter_m_);
  for (size_t i = 0; i < cameras_.size() + styluses_.size() + obstacles_.size(); ++i) {
    Marker& marker = out.markers.emplace_back(this->marker("names", i, stamp));
    marker.type = Marker::TEXT_VIEW_FACING;
    marker.action = i < labels.size() ? Marker::ADD : Marker::DELETE;
    if (i >= labels.size()) continue;
    marker.pose.position = toPoint(labels[i].position_m);
    marker.scale.z = letter_m_;
    marker.text = labels[i].text;
    paint(kWhite, marker);
  }
}

}  // namespace viscera::nodes
