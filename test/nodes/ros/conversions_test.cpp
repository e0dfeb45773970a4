// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/conversions.h"
#include "nodes/views/surface_messages.h"

#include <gtest/gtest.h>

#include <cstring>

#include <limits>

#include "viscera/render/camera.h"

namespace viscera::nodes {
namespace {

constexpr double kRounding = 1e-12;  // [m], [N] double rounding of several operations

/// Returns two bodies: a square of two triangles, and a single triangle. @param shown  remaining vertices of each
VisibleTopology twoBodies(const std::vector<uint32_t>& square = {0, 1, 2, 2, 1, 3},
                          const std::vector<uint32_t>& flap = {4, 5, 6}) {
  VisibleTopology skin;
  skin.revision = 1;
  skin.vertices = 13;
  skin.triangles = square;
  skin.triangles.insert(skin.triangles.end(), flap.begin(), flap.end());
  skin.bodies = {{"square", Vector3d(1, 0, 0)}, {"flap", Vector3d(0, 1, 0)}};
  skin.patches = {{0, SurfaceKind::kSkin, 0, square.size() / 3},
                  {1, SurfaceKind::kSkin, square.size() / 3, flap.size() / 3}};
  return skin;
}

/// Number of vertices of the two uncut bodies; six more are in reserve for cuts.
constexpr size_t kUsedVertices = 7;

/// Returns the vertices that are sent for these triangles.
SentVertices followed(const VisibleTopology& skin) {
  SentVertices sent(twoBodies());
  sent.follow(skin);
  return sent;
}

SurfaceFrame frameOf(const VisibleTopology& skin) {
  SurfaceFrame frame;
  frame.tick = 12;
  for (size_t i = 0; i < 3 * skin.vertices; ++i) frame.positions_m.push_back(0.25f * static_cast<float>(i));
  frame.normals.assign(skin.vertices, 7u);
  frame.topology = std::make_shared<VisibleTopology>(skin);
  return frame;
}

TEST(Conversions, PoseSurvivesARoundTrip) {
  const Pose pose{{0.1, -0.2, 0.3}, Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()))};
  const Pose back = fromMessage(toMessage(pose));
  EXPECT_EQ(back.position_m, pose.position_m);
  EXPECT_EQ(back.orientation.coeffs(), pose.orientation.coeffs());
}

TEST(Conversions, TransformNamesParentAndChild) {
  const Pose pose{{1, 2, 3}, Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitY()))};
  const auto message = toTransform(pose, "tissue", "left_tool", ros::Time(5));
  EXPECT_EQ(message.header.frame_id, "tissue");
  EXPECT_EQ(message.child_frame_id, "left_tool");
  EXPECT_EQ(message.header.stamp, ros::Time(5));
  const Pose back = fromMessage(message.transform);
  EXPECT_EQ(back.position_m, pose.position_m);
  EXPECT_EQ(back.orientation.coeffs(), pose.orientation.coeffs());
}

TEST(Conversions, PoseWithAnyNumberThatIsNotFiniteIsSeen) {
  EXPECT_TRUE(isFinite(Pose{}));
  for (int i = 0; i < 3; ++i) {
    Pose pose;
    pose.position_m[i] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(isFinite(pose));
  }
  for (int i = 0; i < 4; ++i) {
    Pose pose;
    pose.orientation.coeffs()[i] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(isFinite(pose));
  }
}

TEST(Conversions, WrenchIsTurnedIntoTheFrameOfTheDevice) {
  Reaction reaction;
  reaction.force_n = {1, 0, 0};
  reaction.torque_nm = {0, 0, 2};
  const Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
  const auto message = toWrench(reaction, turn, "base", ros::Time(3));
  EXPECT_EQ(message.header.frame_id, "base");
  EXPECT_NEAR(message.wrench.force.x, 0, kRounding);
  EXPECT_NEAR(message.wrench.force.y, 1, kRounding);
  EXPECT_NEAR(message.wrench.torque.z, 2, kRounding);
}

TEST(Conversions, WrenchThatIsNotFiniteBecomesZero) {
  Reaction reaction;
  reaction.force_n = {1, std::numeric_limits<double>::quiet_NaN(), 0};
  reaction.torque_nm = {1, 1, 1};
  const auto message = toWrench(reaction, Quaterniond::Identity(), "base", ros::Time(3));
  EXPECT_EQ(message.wrench.force.x, 0);
  EXPECT_EQ(message.wrench.force.y, 0);
  EXPECT_EQ(message.wrench.torque.z, 0);
}

TEST(Conversions, TopologyListsVisibleTrianglesAndCountsPerBody) {
  const VisibleTopology skin = twoBodies();
  const auto whole = toTopology(skin, followed(skin), 1, "tissue", ros::Time(1));
  EXPECT_EQ(whole.triangles, skin.triangles);
  EXPECT_EQ(whole.vertices, kUsedVertices);
  const auto torn = toTopology(twoBodies({2, 1, 3}), followed(twoBodies({2, 1, 3})), 2, "tissue", ros::Time(1));
  EXPECT_EQ(torn.version, 2u);
  EXPECT_EQ(torn.triangles, (std::vector<uint32_t>{2, 1, 3, 4, 5, 6}));
  EXPECT_EQ(torn.bodies, (std::vector<std::string>{"square", "flap"}));
  EXPECT_EQ(torn.body_triangles, (std::vector<uint32_t>{1, 1}));
}

TEST(Conversions, TopologyHasTheColorsOfTheScene) {
  VisibleTopology skin = twoBodies();
  skin.bodies[0].color = {1, 0.5, 0};
  skin.bodies[1].color = {0, 0, 2};
  const auto topology = toTopology(skin, followed(skin), 1, "tissue", ros::Time(1));
  EXPECT_EQ(topology.body_colors, (std::vector<uint32_t>{0xff0080ff, 0xffff0000}));
  ASSERT_EQ(topology.wound_colors.size(), 2U);
  EXPECT_EQ(topology.wound_colors[0], 0xff0040ccU);
}

TEST(Conversions, PatchesOfABodyAreSentTogether) {
  VisibleTopology skin = twoBodies();
  skin.triangles.insert(skin.triangles.end(), {7, 8, 9});
  skin.patches.push_back({1, SurfaceKind::kWound, 3, 1});
  const auto topology = toTopology(skin, followed(skin), 1, "tissue", ros::Time(1));
  EXPECT_EQ(topology.body_triangles, (std::vector<uint32_t>{2, 2}));
  EXPECT_EQ(topology.wound_triangles, (std::vector<uint32_t>{0, 1}));
  const auto markers = toMarkers(frameOf(skin), "tissue", ros::Time(1));
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].points.size(), 6u);
  EXPECT_EQ(markers[1].points.size(), 3u);
  EXPECT_EQ(markers[2].action, visualization_msgs::Marker::DELETE);
  ASSERT_EQ(markers[3].points.size(), 3u);  // the cut wall
  EXPECT_EQ(markers[3].ns, "flap wounds");
  EXPECT_LT(markers[3].color.g, markers[1].color.g);
}

TEST(Conversions, SplitTrianglesAreSentInPieces) {
  const std::vector<uint32_t> pieces = {5, 9, 8, 10, 6, 4, 10, 4, 7};
  const SurfaceFrame frame = frameOf(twoBodies({2, 1, 3}, pieces));
  const auto topology = toTopology(*frame.topology, followed(*frame.topology), 2, "tissue", ros::Time(1));
  EXPECT_EQ(topology.triangles, (std::vector<uint32_t>{2, 1, 3, 5, 9, 8, 10, 6, 4, 10, 4, 7}));
  EXPECT_EQ(topology.body_triangles, (std::vector<uint32_t>{1, 3}));
  const auto markers = toMarkers(frame, "tissue", ros::Time(1));
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].points.size(), 3u);
  ASSERT_EQ(markers[1].points.size(), 9u);
  EXPECT_EQ(markers[1].points[1].x, frame.positions_m[3 * 9]);
}

TEST(Conversions, VerticesThatACutAddsAreSentAfterTheOthersAndOnlyWhileTheyAreNeeded) {
  const VisibleTopology cut = twoBodies({2, 1, 3}, {5, 12, 8, 12, 6, 4});
  SurfaceFrame frame = frameOf(cut);
  for (uint32_t v = 0; v < frame.vertices(); ++v) frame.colors.push_back(100 + v);
  SentVertices sent = followed(cut);
  const auto topology = toTopology(cut, sent, 2, "tissue", ros::Time(1));
  EXPECT_EQ(topology.vertices, kUsedVertices + 2);
  EXPECT_EQ(topology.triangles, (std::vector<uint32_t>{2, 1, 3, 5, 8, 7, 8, 6, 4}));
  const auto vertices = toVertices(frame, frame.colors, sent, 2, "tissue", ros::Time(1));
  ASSERT_EQ(vertices.positions_m.size(), 3 * (kUsedVertices + 2));
  EXPECT_EQ(vertices.positions_m[3 * 8], frame.positions_m[3 * 12]);
  ASSERT_EQ(vertices.colors.size(), kUsedVertices + 2);
  EXPECT_EQ(vertices.colors[8], 112U);
  sent.follow(twoBodies());
  EXPECT_EQ(sent.vertices().size(), kUsedVertices);
}

TEST(Conversions, VerticesCarryTickAndTopologyVersion) {
  const SurfaceFrame frame = frameOf(twoBodies());
  const auto message = toVertices(frame, frame.colors, followed(*frame.topology), 4, "tissue", ros::Time(2));
  EXPECT_EQ(message.tick, 12u);
  EXPECT_EQ(message.topology_version, 4u);
  EXPECT_EQ(message.positions_m, std::vector<float>(frame.positions_m.begin(), frame.positions_m.begin() + 21));
  EXPECT_EQ(message.normals, std::vector<uint32_t>(kUsedVertices, 7u));
  EXPECT_TRUE(message.colors.empty());
}

TEST(Conversions, MarkersHoldTheCornersOfWholeTrianglesOfOneBodyEach) {
  const SurfaceFrame frame = frameOf(twoBodies({0, 1, 2}));
  const auto markers = toMarkers(frame, "tissue", ros::Time(2));
  ASSERT_EQ(markers.size(), 4u);
  ASSERT_EQ(markers[0].points.size(), 3u);
  EXPECT_EQ(markers[0].points[1].x, frame.positions_m[3]);
  EXPECT_EQ(markers[0].color.r, 1);
  EXPECT_TRUE(markers[0].colors.empty());  // rviz would switch lighting off
  ASSERT_EQ(markers[1].points.size(), 3u);
  EXPECT_EQ(markers[1].points[0].z, frame.positions_m[14]);
  EXPECT_NE(markers[0].ns + std::to_string(markers[0].id), markers[1].ns + std::to_string(markers[1].id));
}

TEST(Conversions, MarkerOfATornBodyIsDeletedRatherThanEmpty) {
  const SurfaceFrame frame = frameOf(twoBodies({0, 1, 2, 2, 1, 3}, {}));
  const auto markers = toMarkers(frame, "tissue", ros::Time(2));
  EXPECT_EQ(markers[0].action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(markers[1].action, visualization_msgs::Marker::DELETE);
}

TEST(Conversions, MarkerNeverHoldsACoordinateThatIsNotFinite) {
  SurfaceFrame frame = frameOf(twoBodies());
  frame.positions_m[0] = std::numeric_limits<float>::quiet_NaN();
  const auto markers = toMarkers(frame, "tissue", ros::Time(2));
  ASSERT_EQ(markers[0].points.size(), 3u);
  EXPECT_EQ(markers[0].points[0].x, frame.positions_m[6]);
}

TEST(Conversions, ImageAndCameraInfoAgreeInStampFrameAndSize) {
  CameraConfig camera;
  camera.name = "left";
  camera.width_px = 4;
  camera.height_px = 2;
  ImageFrame frame;
  frame.width = 4;
  frame.height = 2;
  frame.rgb.assign(24, 9);
  const auto image = toImage(std::move(frame), opticalFrame(camera, ""), ros::Time(8));
  const auto info = toCameraInfo(camera, opticalFrame(camera, ""), ros::Time(8));
  EXPECT_EQ(image.header.frame_id, "left_optical_frame");
  EXPECT_EQ(image.header.frame_id, info.header.frame_id);
  EXPECT_EQ(image.header.stamp, info.header.stamp);
  EXPECT_EQ(image.step * image.height, image.data.size());
  EXPECT_EQ(image.encoding, "rgb8");
  EXPECT_EQ(info.width, image.width);
  EXPECT_EQ(info.K[2], 1.5);  // the centre of four pixels with centres 0, 1, 2, 3
  EXPECT_EQ(info.K[5], 0.5);
  EXPECT_EQ(info.P[2], info.K[2]);
  EXPECT_EQ(info.P[6], info.K[5]);
  EXPECT_EQ(info.P[0], info.K[0]);
  EXPECT_GT(info.K[0], 0);
}

TEST(Conversions, CameraInfoHoldsTheLensOfThePictures) {
  constexpr double kSame_px = 1e-6;
  CameraConfig camera;
  camera.vertical_fov_deg = 70;
  camera.distortion = {-0.2, 0.05, 0.003, -0.002, 0.001};
  const auto info = toCameraInfo(camera, "f", ros::Time(8));
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.D, (std::vector<double>{-0.2, 0.05, 0.003, -0.002, 0.001}));
  // Rectifies a pixel like image_geometry: OpenCV's undistortPoints, by iteration.
  const auto rectified = [&](double column, double row) {
    const double x0 = (column - info.K[2]) / info.K[0], y0 = (row - info.K[5]) / info.K[4];
    double x = x0, y = y0;
    for (int i = 0; i < 100; ++i) {
      const double r2 = x * x + y * y, radial = 1 + r2 * (info.D[0] + r2 * (info.D[1] + r2 * info.D[4]));
      const double aside_x = 2 * info.D[2] * x * y + info.D[3] * (r2 + 2 * x * x);
      const double aside_y = info.D[2] * (r2 + 2 * y * y) + 2 * info.D[3] * x * y;
      x = (x0 - aside_x) / radial;
      y = (y0 - aside_y) / radial;
    }
    return Eigen::Vector2d(info.P[0] * x + info.P[2], info.P[5] * y + info.P[6]);
  };
  for (double share = -1; share <= 1; share += 0.25) {  // along a line in space
    const Vector3d point(0.3 * share, 0.2 + 0.1 * share, 0.6 + 0.1 * share);
    const auto shown = pixelOf(camera, point);
    ASSERT_TRUE(shown);
    const Eigen::Vector2d straight(info.P[0] * point.x() / point.z() + info.P[2],
                                   info.P[5] * point.y() / point.z() + info.P[6]);
    EXPECT_LT((rectified(shown->x() - 0.5, shown->y() - 0.5) - straight).norm(), kSame_px);
    EXPECT_GT((*shown - straight).norm(), 1) << "the lens bends";
  }
}

TEST(Conversions, ARightEyeProjectsFromTheLeftOnesFrame) {
  CameraConfig camera;
  camera.stereo_baseline_m = 0.005;
  const auto left = toCameraInfo(camera, "f", ros::Time(8)),
             right = toCameraInfo(camera, "f", ros::Time(8), PictureKind::kRight);
  EXPECT_EQ(left.P[3], 0);
  EXPECT_DOUBLE_EQ(right.P[3], -right.P[0] * camera.stereo_baseline_m);
}

TEST(Conversions, DepthsAndLabelsHaveEncodingsOfTheirOwn) {
  ImageFrame depths, labels;
  depths.width = labels.width = 2;
  depths.height = labels.height = 1;
  depths.kind = PictureKind::kDepth;
  depths.depths_m = {0.5F, 0.25F};
  labels.kind = PictureKind::kLabels;
  labels.labels = {1, 101};
  const auto depth = toImage(std::move(depths), "f", ros::Time(8)),
             label = toImage(std::move(labels), "f", ros::Time(8));
  EXPECT_EQ(depth.encoding, "32FC1");
  EXPECT_EQ(depth.step, 8u);
  float second = 0;
  std::memcpy(&second, &depth.data[4], sizeof second);
  EXPECT_EQ(second, 0.25F);
  EXPECT_EQ(label.encoding, "mono8");
  EXPECT_EQ(label.data, (std::vector<uint8_t>{1, 101}));
}

TEST(Conversions, ACameraOnAnOpticalFrameHasNoOtherOne) {
  CameraConfig camera;
  camera.name = "scope";
  camera.frame = "scope_link";
  EXPECT_EQ(opticalFrame(camera, "or/"), "or/scope_optical_frame");
  for (const std::string frame : {"tip_optical", "tip_optical_frame"}) {
    camera.frame = frame;
    EXPECT_EQ(opticalFrame(camera, "or/"), frame);
  }
}

}  // namespace
}  // namespace viscera::nodes
