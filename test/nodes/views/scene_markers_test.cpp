// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/scene_markers.h"

#include <gtest/gtest.h>

#include "nodes/views/markers/scene_marker_publisher.h"
#include "viscera/model/scene/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>

namespace viscera::nodes {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kRounding_m = 1e-9;  // float corners of a shape of 0.1 m

Scene scene() {
  Scene scene;
  scene.environment.tissue_frame = "room/tissue";
  StylusConfig left, right;
  left.name = "left";
  right.name = "right";
  right.idle = ToolMode::kCut;
  scene.styluses = {left, right};
  ObstacleConfig ball;
  ball.name = "ball";
  ball.shape = ObstacleShape::kSphere;
  ball.radius_m = 0.03;
  scene.obstacles = {ball};
  return scene;
}

SceneStyle style() {
  SceneStyle style;
  style.obstacles = {Pose{{0.2, 0, 0}, Quaterniond::Identity()}};
  style.tools[0].present = true;
  style.tools[0].mode = ToolMode::kProbe;
  style.tools[0].to.position_m = {0, 0.1, 0};
  style.reactions[0].force_n = {0, 0, 2};
  return style;
}

MarkerArray markersOf(const SceneStyle& style) {
  return SceneMarkers(scene(), {}).at(style, ros::Time(3));
}

std::vector<Marker> shown(const MarkerArray& array, const std::string& names) {
  std::vector<Marker> out;
  for (const Marker& marker : array.markers)
    if (marker.ns == names && marker.action == Marker::ADD) out.push_back(marker);
  return out;
}

TEST(SceneMarkers, ToolsAreTheTrianglesThatTheCameraShowsWhereTheyAre) {
  const auto tools = shown(markersOf(style()), "tools");
  ASSERT_FALSE(tools.empty());
  size_t corners = 0;
  for (const Marker& tool : tools) {
    EXPECT_EQ(tool.type, Marker::TRIANGLE_LIST);
    EXPECT_EQ(tool.header.frame_id, "room/tissue");
    EXPECT_EQ(tool.pose.position.y, 0.1);
    EXPECT_TRUE(tool.colors.empty());  // rviz would switch lighting off
    corners += tool.points.size();
  }
  EXPECT_EQ(corners, toolShape(scene().styluses[0], ToolMode::kProbe).indices.size());
}

TEST(SceneMarkers, AModeHasItsOwnShape) {
  SceneStyle grabbing = style();
  grabbing.tools[0].mode = ToolMode::kGrab;
  size_t corners = 0;
  const auto tools = shown(markersOf(grabbing), "tools");
  for (const Marker& tool : tools) corners += tool.points.size();
  EXPECT_EQ(corners, toolShape(scene().styluses[0], ToolMode::kGrab).indices.size());
  EXPECT_TRUE(std::any_of(tools.begin(), tools.end(), [](const Marker& tool) { return tool.color.a < 1; }));
}

TEST(SceneMarkers, FingersStandAsFarOpenAsTheirTool) {
  const auto width_m = [](double opening_rad) {
    SceneStyle grabbing = style();
    grabbing.tools[0].mode = ToolMode::kGrab;
    grabbing.tools[0].opens_to_rad = opening_rad;
    double widest_m = 0;
    for (const Marker& tool : shown(markersOf(grabbing), "tools")) {
      for (const geometry_msgs::Point& point : tool.points)  // solid, near the tip
        if (tool.color.a == 1 && point.z < 0.002) widest_m = std::max(widest_m, std::abs(point.x));
    }
    return widest_m;
  };
  constexpr double kFinger_m = 0.0015, kLength_m = 0.014;  // thickness of a finger; length of those of mode grab
  EXPECT_LT(width_m(0), kFinger_m);
  EXPECT_NEAR(width_m(0.6), kLength_m * std::sin(0.3), kFinger_m);
}

TEST(SceneMarkers, MarksOnTissueAreLinesInTheirColoursOneMarkerPerWidth) {
  auto marks = std::make_shared<VisibleMarks>();
  marks->styles = {{Vector3f(1, 0, 0), MarkPattern::kSolid}, {Vector3f(0, 0.5F, 1), MarkPattern::kDouble}};
  SceneStyle marked = style();
  marked.marks = marks;
  marked.mark_pieces = {{0, Vector3f(0, 0, 0), Vector3f(0.01F, 0, 0), 0.002F},
                        {1, Vector3f(0, 0, 0), Vector3f(0, 0.01F, 0), 0.001F},
                        {1, Vector3f(0, 0.01F, 0), Vector3f(0, 0.02F, 0), 0.001F}};
  const auto lines = shown(markersOf(marked), "marks");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].type, Marker::LINE_LIST);
  EXPECT_EQ(lines[0].header.frame_id, "room/tissue");
  EXPECT_FLOAT_EQ(lines[0].scale.x, 0.001F);
  ASSERT_EQ(lines[0].points.size(), 4U);
  ASSERT_EQ(lines[0].colors.size(), 4U);
  EXPECT_FLOAT_EQ(lines[0].colors[0].g, 0.5F);
  EXPECT_FLOAT_EQ(lines[1].points[1].x, 0.01F);
  EXPECT_FLOAT_EQ(lines[1].colors[0].r, 1);
  EXPECT_TRUE(shown(markersOf(style()), "marks").empty());
}

TEST(SceneMarkers, ATextStandsInThePlaceOfTheTissueUntilThereIsSome) {
  Scene seen = scene();
  CameraConfig camera;
  camera.target_m = {0.1, 0.2, 0.3};
  seen.cameras = {camera};
  const SceneMarkers markers(seen, {});
  const auto texts = shown(markers.telling("preparing: 62 %", ros::Time(3)), "preparing");
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0].type, Marker::TEXT_VIEW_FACING);
  EXPECT_EQ(texts[0].text, "preparing: 62 %");
  EXPECT_EQ(texts[0].header.frame_id, "room/tissue");
  EXPECT_EQ(texts[0].pose.position.y, 0.2);
  EXPECT_GT(texts[0].scale.z, 0);
  const MarkerArray after = markers.at(style(), ros::Time(4));
  EXPECT_TRUE(std::any_of(after.markers.begin(), after.markers.end(), [](const Marker& marker) {
    return marker.ns == "preparing" && marker.action == Marker::DELETE;
  }));
  EXPECT_TRUE(shown(after, "preparing").empty());
}

TEST(SceneMarkers, ForcesAreArrowsFromTheTipInTheScaleThatIsAskedFor) {
  PublishOptions options;
  options.force_arrow_m_per_n = 0.05;
  const auto forces = shown(SceneMarkers(scene(), options).at(style(), ros::Time(3)), "forces");
  ASSERT_EQ(forces.size(), 1u);
  ASSERT_EQ(forces[0].points.size(), 2u);
  EXPECT_EQ(forces[0].points[0].y, 0.1);
  EXPECT_NEAR(forces[0].points[1].z, 0.1, kRounding_m);
}

TEST(SceneMarkers, ForcesThatAreNoneOrNotFiniteHaveNoArrow) {
  SceneStyle none = style();
  none.reactions[0].force_n.setZero();
  EXPECT_TRUE(shown(markersOf(none), "forces").empty());
  none.reactions[0].force_n.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(shown(markersOf(none), "forces").empty());
}

TEST(SceneMarkers, ObstaclesAreInTheirTrueSizeAtTheirPose) {
  const auto obstacles = shown(markersOf(style()), "obstacles");
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_EQ(obstacles[0].pose.position.x, 0.2);
  double farthest_m = 0;
  for (const auto& p : obstacles[0].points) farthest_m = std::max(farthest_m, Vector3d(p.x, p.y, p.z).norm());
  EXPECT_NEAR(farthest_m, 0.03, 1e-6);
}

TEST(SceneMarkers, WhatIsNotThereIsDeletedUnderTheIdsThatItHad) {
  const MarkerArray present = markersOf(style()), absent = markersOf(SceneStyle{{}, style().obstacles, {}});
  std::set<std::pair<std::string, int>> deleted;
  for (const Marker& marker : absent.markers)
    if (marker.action == Marker::DELETE) deleted.emplace(marker.ns, marker.id);
  for (const std::string names : {"tools", "forces"})
    for (const Marker& marker : shown(present, names)) EXPECT_TRUE(deleted.count({names, marker.id})) << names;
  EXPECT_EQ(shown(present, "names").size(), 2u);
  EXPECT_EQ(shown(absent, "names").size(), 1u);
}

TEST(SceneMarkers, NoTwoMarkersShareAnId) {
  std::set<std::pair<std::string, int>> ids;
  const MarkerArray array = markersOf(style());
  for (const Marker& marker : array.markers) EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second) << marker.ns;
}

TEST(SceneMarkers, SuturesAreLinesThroughTheirNodesOnceTheyArePlaced) {
  Scene with = scene();
  SutureConfig suture;
  suture.radius_m = 1e-3;
  suture.material = SutureMaterial::kPolypropylene;
  suture.path = {{Vector3d(0.05, 0, 0)}};
  with.sutures = {suture, suture};
  with.sutures[1].radius_m = 1e-5;
  const SceneMarkers markers(with, {});
  SceneStyle placed = style();
  EXPECT_TRUE(shown(markers.at(placed, ros::Time(3)), "sutures").empty());
  placed.sutures = {{0, TubeKind::kSuture, {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0.01}}},
                    {1, TubeKind::kSuture, {{0, 1, 0}, {0, 2, 0}}}};
  const auto lines = shown(markers.at(placed, ros::Time(3)), "sutures");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].type, Marker::LINE_STRIP);
  EXPECT_EQ(lines[0].header.frame_id, "room/tissue");
  EXPECT_EQ(lines[0].scale.x, 2e-3);
  EXPECT_GT(lines[0].color.b, lines[0].color.r);
  ASSERT_EQ(lines[0].points.size(), 3u);
  EXPECT_EQ(lines[0].points[2].x, 0.02);
  EXPECT_EQ(lines[0].points[2].z, 0.01);
  EXPECT_EQ(lines[1].id, 1);
  EXPECT_GT(lines[1].scale.x, 1e-4) << "wide enough to be seen";
}

TEST(SceneMarkers, ClipsAreLinesBehindThoseOfSutures) {
  Scene with = scene();
  with.styluses[0].button1 = ToolMode::kClip;
  const SceneMarkers markers(with, {});
  SceneStyle placed = style();
  EXPECT_TRUE(shown(markers.at(placed, ros::Time(3)), "sutures").empty());
  placed.sutures = {{0, TubeKind::kClip, {{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.002, 0}, {0, 0.002, 0}}}};
  const auto lines = shown(markers.at(placed, ros::Time(3)), "sutures");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].points.size(), 4u);
  EXPECT_EQ(lines[0].scale.x, 1e-3);
}

TEST(SceneMarkers, NeedlesAreLinesAlongTheirWireFromTheTip) {
  Scene with = scene();
  SutureConfig suture;
  suture.path = {{Vector3d(0.05, 0, 0)}};
  with.sutures = {suture, suture};
  with.sutures[1].needle.arc = NeedleArc::kHalfCircle;
  const SceneMarkers markers(with, {});
  SceneStyle placed = style();
  EXPECT_TRUE(shown(markers.at(placed, ros::Time(3)), "needles").empty());
  NeedleState needle;
  needle.suture = 1;
  needle.pose.position_m = {0, 0, 0.1};
  needle.radius_m = 0.01;
  needle.arc_rad = M_PI;
  needle.wire_radius_m = 0.0004;
  placed.needles = {needle};
  const auto lines = shown(markers.at(placed, ros::Time(3)), "needles");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].type, Marker::LINE_STRIP);
  ASSERT_GT(lines[0].points.size(), 8U);
  EXPECT_NEAR(lines[0].points.front().x, 0.01, kRounding_m);
  EXPECT_NEAR(lines[0].points.back().x, -0.01, kRounding_m);
  EXPECT_NEAR(lines[0].points[lines[0].points.size() / 2].z, 0.09, 1e-4) << "the tip heads for +z";
}

TEST(SceneMarkers, StrandsAreLinesOfOneMarkerWhereTheSceneHasAttachments) {
  Scene with = scene();
  SceneStyle placed = style();
  placed.strands.resize(2);
  for (VisibleTube& strand : placed.strands)
    strand = {0, TubeKind::kStrand, std::vector<Vector3d>(kStrandNodes, Vector3d(0, 0, 0.1))};
  EXPECT_TRUE(shown(SceneMarkers(with, {}).at(placed, ros::Time(3)), "strands").empty());
  with.attachments.resize(1);
  const SceneMarkers markers(with, {});
  const auto lines = shown(markers.at(placed, ros::Time(3)), "strands");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].type, Marker::LINE_LIST);
  EXPECT_EQ(lines[0].points.size(), 4U);
  EXPECT_TRUE(shown(markers.at(style(), ros::Time(3)), "strands").empty());
}

TEST(SceneMarkers, ToolsThatAreWhereTheirFramesAreGoWithThese) {
  SceneStyle style = viscera::nodes::style();
  style.in_tf[0] = true;
  PublishOptions options;
  options.frame_prefix = "room/";
  for (const Marker& tool : shown(SceneMarkers(scene(), options).at(style, ros::Time(3)), "tools")) {
    EXPECT_EQ(tool.header.frame_id, "room/left_tool");
    EXPECT_TRUE(tool.frame_locked);
    EXPECT_EQ(tool.header.stamp, ros::Time()) << "the newest";
    EXPECT_EQ(tool.pose.position.y, 0);
    EXPECT_EQ(tool.pose.orientation.w, 1);
  }
}

TEST(SceneMarkers, AToolThatIsHeldBackIsNotWhereItsFrameIs) {
  Frame frame;
  StylusSamples samples;
  samples[0].valid = samples[1].valid = true;
  frame.tools[0].present = frame.tools[1].present = true;
  frame.tools[1].to.position_m.x() = 0.001;
  const SceneStyle style = styleOf(frame, samples);
  EXPECT_TRUE(style.in_tf[0]);
  EXPECT_FALSE(style.in_tf[1]);
  samples[0].valid = false;
  EXPECT_FALSE(styleOf(frame, samples).in_tf[0]) << "its frame is not sent";
}

class SentMeshesTest : public ::testing::Test {
 protected:
  /// Returns the ids of tools that are sent for these contents.
  std::vector<int> tools(const SceneStyle& style, double time_s) {
    const auto now = SteadyTime(std::chrono::hours(1)) +
                     std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(time_s));
    std::vector<int> out;
    const MarkerArray news = sent_.newsOf(markers_.at(style, ros::Time(time_s)), now);
    for (const Marker& marker : news.markers)
      if (marker.ns == "tools") out.push_back(marker.id);
    names_ = shown(news, "names").size();
    return out;
  }
  const SceneMarkers markers_{scene(), {}};
  SentMeshes sent_;
  size_t names_ = 0;
};

TEST_F(SentMeshesTest, AreSentOnceAndAgainAsTheyChange) {
  SceneStyle style = viscera::nodes::style();
  style.in_tf[0] = true;
  const size_t all = tools(style, 0).size();
  EXPECT_GE(all, 8U) << "of two styluses, present or not";
  style.tools[0].to.position_m.x() = 0.01;
  EXPECT_TRUE(tools(style, 0.1).empty()) << "its frame has moved";
  EXPECT_EQ(names_, 2U) << "all else is in every array";
  style.tools[0].mode = ToolMode::kGrab;
  EXPECT_FALSE(tools(style, 0.2).empty());
  EXPECT_TRUE(tools(style, 0.3).empty());
  style.tools[0].present = false;
  EXPECT_FALSE(tools(style, 0.4).empty()) << "gone";
  EXPECT_TRUE(tools(style, 0.5).empty());
  EXPECT_EQ(tools(style, 5.1).size(), all) << "every 5 s, for bags that are split";
  EXPECT_TRUE(tools(style, 5.2).empty());
  sent_.clear();
  EXPECT_EQ(tools(style, 5.3).size(), all);
}

TEST_F(SentMeshesTest, OfToolsThatAreNotInTheirFramesAreSentAsTheyMove) {
  SceneStyle style = viscera::nodes::style();
  tools(style, 0);
  EXPECT_TRUE(tools(style, 0.1).empty());
  style.tools[0].to.position_m.x() = 0.01;
  EXPECT_FALSE(tools(style, 0.2).empty());
}

TEST(SceneMarkers, NamesAtOnePositionAreWrittenAboveEachOther) {
  constexpr double kLetter_m = 0.01;
  std::vector<Label> labels(4, Label{"left", {0.1, 0, 0}});
  labels[3].position_m = {0.5, 0, 0};
  partLabels(labels, kLetter_m);
  EXPECT_EQ(labels[0].position_m.z(), 0);
  EXPECT_EQ(labels[3].position_m.z(), 0);  // far enough
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_GT(std::abs(labels[i].position_m.z() - labels[j].position_m.z()), kLetter_m) << i << " " << j;
}

TEST(SceneMarkers, NodesThatAreHeldArePointsThatGoWithTheTool) {
  SceneStyle style = viscera::nodes::style();
  EXPECT_TRUE(shown(markersOf(style), "held").empty());
  style.held_m[0] = {{0, 0, 0.001}, {0.002, 0, 0}};
  const auto held = shown(markersOf(style), "held");
  ASSERT_EQ(held.size(), 1U);
  EXPECT_EQ(held[0].type, Marker::POINTS);
  EXPECT_EQ(held[0].pose.position.y, 0.1);
  ASSERT_EQ(held[0].points.size(), 2U);
  EXPECT_EQ(held[0].points[1].x, 0.002);
  style.tools[0].present = false;
  EXPECT_TRUE(shown(markersOf(style), "held").empty());
}

}  // namespace
}  // namespace viscera::nodes
