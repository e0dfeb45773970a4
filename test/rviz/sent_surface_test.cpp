// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/sent_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace viscera::rviz_plugin {
namespace {

/// Two bodies: a square of two triangles, of which one is a wall, and a triangle.
SurfaceTopology whole(uint32_t version) {
  SurfaceTopology message;
  message.header.stamp = ros::Time(version);
  message.version = version;
  message.vertices = 7;
  message.bodies = {"square", "triangle"};
  message.body_triangles = {2, 1};
  message.wound_triangles = {1, 0};
  message.triangles = {0, 1, 2, 0, 2, 3, 4, 5, 6};
  return message;
}

SurfaceVerticesPtr vertices(uint32_t version, uint32_t count = 7) {
  const SurfaceVerticesPtr message(new SurfaceVertices);
  message->topology_version = version;
  message->positions_m = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 0, 2, 6, 0, 2, 5, 1, 2};
  message->positions_m.resize(3 * static_cast<size_t>(count));
  message->normals.assign(count, 511U << 20U);
  return message;
}

SurfaceTopologyChange change(uint32_t version) {
  SurfaceTopologyChange message;
  message.version = version;
  message.vertices = 7;
  message.body_triangles = {1, 1};
  message.wound_triangles = {0, 0};
  message.kept = {1};
  message.removed = {1};
  message.added = {0};
  return message;
}

TEST(SentSurface, PartsHaveTheColorsOfTheSceneOverChangesToo) {
  SentSurface surface;
  SurfaceTopology colored = whole(1);
  colored.body_colors = {0xff102030, 0xff405060};
  colored.wound_colors = {0xff010203, 0xff040506};
  EXPECT_EQ(surface.take(colored), "");
  EXPECT_EQ(surface.take(vertices(1)), "");
  ASSERT_EQ(surface.topology()->parts.size(), 4U);
  EXPECT_EQ(surface.topology()->parts[0].color, 0xff102030U);
  EXPECT_EQ(surface.topology()->parts[1].color, 0xff010203U);
  EXPECT_EQ(surface.topology()->parts[2].color, 0xff405060U);
  EXPECT_EQ(surface.take(change(2)), "");
  EXPECT_EQ(surface.take(vertices(2)), "");
  EXPECT_EQ(surface.topology()->version, 2U);
  EXPECT_EQ(surface.topology()->parts[2].color, 0xff405060U);

  colored = whole(3);
  colored.body_colors = {0xff102030};
  EXPECT_NE(surface.take(colored), "");
  EXPECT_EQ(surface.take(whole(3)), "");  // senders need not know any
  EXPECT_EQ(surface.take(vertices(3)), "");
  EXPECT_FALSE(surface.topology()->parts[0].color);
}

TEST(SentSurface, PartsAreSkinAndWallsOfEachBody) {
  SentSurface surface;
  EXPECT_EQ(surface.take(whole(1)), "");
  EXPECT_FALSE(surface.topology());
  EXPECT_EQ(surface.take(vertices(1)), "");
  ASSERT_TRUE(surface.topology());
  ASSERT_EQ(surface.topology()->parts.size(), 4U);
  const SentPart &walls = surface.topology()->parts[1], &triangle = surface.topology()->parts[2];
  EXPECT_TRUE(walls.walls);
  EXPECT_EQ(walls.first, 1U);
  EXPECT_EQ(walls.count, 1U);
  EXPECT_EQ(triangle.body, 1U);
  EXPECT_EQ(triangle.first, 2U);
}

TEST(SentSurface, MessagesMayComeInAnyOrder) {
  SentSurface surface;
  surface.take(vertices(3));
  surface.take(whole(2));
  EXPECT_FALSE(surface.vertices());
  surface.take(change(3));
  ASSERT_TRUE(surface.vertices());
  EXPECT_EQ(surface.topology()->triangles, (std::vector<uint32_t>{0, 1, 2, 4, 5, 6}));
  surface.take(whole(2));  // overtaken
  surface.take(change(4));
  surface.take(vertices(3));  // slower than the next change
  EXPECT_EQ(surface.topology()->version, 3U);
}

TEST(SentSurface, RestartedSimulatorCountsFromZero) {
  SentSurface surface;
  surface.take(whole(8));
  surface.take(vertices(8));
  SurfaceTopology again = whole(1);
  again.header.stamp = ros::Time(100);
  again.vertices = 8;
  surface.take(again);
  surface.take(vertices(1, 8));
  ASSERT_TRUE(surface.topology());
  EXPECT_EQ(surface.topology()->version, 1U);
}

TEST(SentSurface, WrongMessagesAreNamedAndChangeNothing) {
  SentSurface surface;
  surface.take(whole(1));
  surface.take(vertices(1));
  const auto refuses = [&](const auto& message, const std::string& word) {
    const std::string wrong = surface.take(message);
    EXPECT_NE(wrong.find(word), std::string::npos) << wrong;
    EXPECT_EQ(surface.topology()->version, 1U);
  };
  SurfaceTopology bad = whole(2);
  bad.triangles[4] = 7;
  refuses(bad, "vertex 7, but there are only 7");
  bad = whole(2);
  bad.wound_triangles = {3, 0};
  refuses(bad, "wound_triangles[0] = 3");
  bad = whole(2);
  bad.bodies.pop_back();
  refuses(bad, "1, 2 and 2");
  bad = whole(2);
  bad.body_triangles = {2, 2};
  refuses(bad, "sum up to 4, but there are 3");
  bad = whole(2);
  bad.triangles.pop_back();
  refuses(bad, "8 entries");
  SurfaceTopologyChange edit = change(2);
  edit.kept[0] = std::numeric_limits<uint32_t>::max();
  refuses(edit, "place 0");
  edit = change(2);
  edit.added.clear();
  refuses(edit, "kept, removed and added");
  SurfaceVerticesPtr moved = vertices(1);
  moved->positions_m[5] = std::nanf("");
  refuses(SurfaceVerticesConstPtr(moved), "not finite");
  refuses(SurfaceVerticesConstPtr(vertices(1, 6)), "18 coordinates");
  moved = vertices(1);
  moved->colors.assign(6, 0);
  refuses(SurfaceVerticesConstPtr(moved), "6 colors for 7 vertices");
  EXPECT_EQ(surface.vertices()->normals.size(), 7U);
}

/// Whatever comes: what is shown names vertices that are there.
TEST(SentSurface, SurvivesAnything) {
  std::mt19937 random(1);
  const auto below = [&](uint32_t limit) { return static_cast<uint32_t>(random() % limit); };
  const auto spoil = [&](std::vector<uint32_t>& list) {
    if (below(4) == 0) list.resize(below(12), below(9));
    if (!list.empty() && below(3) == 0)
      list[below(static_cast<uint32_t>(list.size()))] = below(2) ? below(8) : random();
  };
  SentSurface surface;
  size_t shown = 0;
  for (int i = 0; i < 20000; ++i) {
    SurfaceTopology topology = whole(below(4));
    if (below(2)) {
      for (auto* list : {&topology.triangles, &topology.body_triangles, &topology.wound_triangles}) spoil(*list);
    }
    SurfaceTopologyChange edit = change(below(6));
    for (auto* list : {&edit.kept, &edit.removed, &edit.added, &edit.triangles, &edit.body_triangles}) spoil(*list);
    switch (below(3)) {
      case 0:
        surface.take(topology);
        break;
      case 1:
        surface.take(edit);
        break;
      default:
        surface.take(vertices(below(6), 6 + below(3)));
    }
    if (!surface.topology()) continue;
    ++shown;
    ASSERT_EQ(surface.vertices()->positions_m.size(), 3 * static_cast<size_t>(surface.topology()->vertices));
    for (uint32_t v : surface.topology()->triangles) ASSERT_LT(v, surface.topology()->vertices);
    for (const SentPart& part : surface.topology()->parts)
      ASSERT_LE(3 * (part.first + part.count), surface.topology()->triangles.size());
  }
  EXPECT_GT(shown, 1000U);
}

TEST(SentSurface, NormalsAreUnpacked) {
  const std::array<float, 3> normal = normalOf(511U | 513U << 10U | 512U << 20U);
  EXPECT_FLOAT_EQ(normal[0], 1);
  EXPECT_FLOAT_EQ(normal[1], -1);
  EXPECT_FLOAT_EQ(normal[2], -1);
}

TEST(SentSurface, ARayFindsTheNearestTriangle) {
  SentSurface surface;
  surface.take(whole(1));
  surface.take(vertices(1));
  const auto hit = [&](const std::array<double, 3>& origin, const std::array<double, 3>& direction) {
    return firstHit(*surface.topology(), surface.vertices()->positions_m, origin, direction);
  };
  ASSERT_TRUE(hit({0.5, 0.2, 3}, {0, 0, -1}));
  EXPECT_DOUBLE_EQ(hit({0.5, 0.2, 3}, {0, 0, -1})->distance_m, 3);
  EXPECT_DOUBLE_EQ(hit({0.5, 0.2, 3}, {0, 0, -1})->normal[2], 1);
  EXPECT_DOUBLE_EQ(hit({5.2, 0.2, 3}, {0, 0, -1})->distance_m, 1);
  EXPECT_FALSE(hit({0.5, 0.2, 3}, {0, 0, 1}));
  EXPECT_FALSE(hit({3, 0.2, 3}, {0, 0, -1}));
}

}  // namespace
}  // namespace viscera::rviz_plugin
