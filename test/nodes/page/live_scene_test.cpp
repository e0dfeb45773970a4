// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#if __has_include(<boost/beast/websocket.hpp>)
#include "nodes/page/live_scene.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <limits>

namespace viscera::nodes {
namespace {

using visualization_msgs::Marker;

/// A surface of one triangle, of two after a cut.
class LiveSceneTest : public ::testing::Test {
 protected:
  void sendTopology(uint32_t version, std::vector<uint32_t> triangles) {
    SurfaceTopology message;
    message.version = version;
    message.vertices = 4;
    message.bodies = {"block"};
    message.triangles = std::move(triangles);
    message.body_triangles = {static_cast<uint32_t>(message.triangles.size() / 3)};
    message.wound_triangles = {0};
    ASSERT_EQ(surface_.take(message), "");
  }
  void sendVertices(uint32_t version, float height_m) {
    const auto message = boost::make_shared<SurfaceVertices>();
    message->topology_version = version;
    message->header.frame_id = "tissue";
    message->positions_m = {0, 0, 0, 0.1F, 0, 0, 0, 0.1F, height_m, 0.1F, 0.1F, 0};
    message->normals.assign(4, 0);
    ASSERT_EQ(surface_.take(SurfaceVerticesConstPtr(message)), "");
  }
  static Marker tool(double x_m) {
    Marker out;
    out.ns = "tools";
    out.type = Marker::TRIANGLE_LIST;
    out.header.frame_id = "left_tool";
    out.pose.orientation.w = 1;
    out.color.a = 1;
    out.points.resize(3);
    out.points[1].x = x_m;
    return out;
  }
  bool send(const Marker& marker) {
    visualization_msgs::MarkerArray message;
    message.markers.push_back(marker);
    return scene_.markers().take(message);
  }
  std::shared_ptr<const LiveFrame> next() {
    return scene_.next(surface_, [this](const std::string& frame) {
      return frame == "left_tool" ? std::optional(tool_) : std::nullopt;
    });
  }

  received::SentSurface surface_;
  LiveScene scene_{0.1};
  Pose tool_;
};

TEST_F(LiveSceneTest, AFrameComesOnlyWhenSomethingHasMoved) {
  EXPECT_EQ(next(), nullptr) << "no surface yet";
  sendTopology(1, {0, 1, 2});
  sendVertices(1, 0);
  EXPECT_NE(next(), nullptr);
  EXPECT_EQ(next(), nullptr);
  sendVertices(1, 0.001F);
  EXPECT_NE(next(), nullptr);
  EXPECT_TRUE(send(tool(0.1)));
  scene_.repeat();
  const auto before = next();
  tool_.position_m.x() = 0.01;
  const auto after = next();
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->parts, after->parts) << "the shape has moved and is not sent again";
  EXPECT_EQ(next(), nullptr);
  EXPECT_FALSE(send(tool(0.1)));
  EXPECT_TRUE(send(tool(0.2))) << "another shape";
}

TEST_F(LiveSceneTest, ACutAndALongWayBeginANewBase) {
  sendTopology(1, {0, 1, 2});
  sendVertices(1, 0);
  const auto first = next();
  sendVertices(1, 0.01F);
  EXPECT_EQ(next()->parts, first->parts);
  sendTopology(2, {0, 1, 2, 1, 3, 2});
  sendVertices(2, 0.01F);
  const auto cut = next();
  EXPECT_NE(cut->parts, first->parts);
  sendVertices(2, 100);
  EXPECT_NE(next()->parts, cut->parts) << "beyond the grid";
}

TEST_F(LiveSceneTest, MarkersThatAreNotFiniteAreLeftOut) {
  Marker marker = tool(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(send(marker));
  marker = tool(0.1);
  marker.pose.position.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(send(marker));
  marker.type = Marker::ARROW;
  marker.ns = "forces";
  marker.pose.position.x = 0;
  EXPECT_FALSE(send(marker)) << "an arrow needs two points";
  marker.points.resize(2);
  marker.id = std::numeric_limits<int32_t>::max();
  EXPECT_FALSE(send(marker)) << "no scene has so many styluses";
  marker.id = 1;
  EXPECT_TRUE(send(marker));
  EXPECT_EQ(scene_.markers().forces().size(), 2U);
}

TEST_F(LiveSceneTest, SegmentsThatFollowEachOtherAreOneLine) {
  Marker marker = tool(0);
  marker.ns = "marks";
  marker.type = Marker::LINE_LIST;
  marker.points.resize(6);
  marker.points[1].x = marker.points[2].x = 1;
  marker.points[3].x = 2;
  marker.points[4].y = marker.points[5].y = 1;
  EXPECT_TRUE(send(marker));
  const std::vector<LiveTube> tubes = scene_.markers().tubes();
  ASSERT_EQ(tubes.size(), 2U);
  EXPECT_EQ(tubes[0].positions_m.size(), 3U);
}

}  // namespace
}  // namespace viscera::nodes
#endif
