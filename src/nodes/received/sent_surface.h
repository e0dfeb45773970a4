// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <viscera/SurfaceTopology.h>
#include <viscera/SurfaceTopologyChange.h>
#include <viscera/SurfaceVertices.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace viscera::received {

/// Triangles of one body that are drawn alike.
struct SentPart {
  size_t body = 0;              ///< index into SentTopology::bodies
  bool walls = false;           ///< whether they are cut walls
  size_t first = 0, count = 0;  ///< range of triangles
  /// sRGB, red in the low byte; empty: the sender has not sent a colour
  std::optional<uint32_t> color = {};
};

/// A validated topology.
struct SentTopology {
  uint32_t version = 0, vertices = 0;
  ros::Time stamp;
  std::vector<std::string> bodies;
  std::vector<uint32_t> body_colors, wound_colors;  ///< [bodies] colours; both may be empty
  std::vector<SentPart> parts;                      ///< surface and cut walls of each body
  std::vector<uint32_t> triangles;                  ///< 3 vertices each, all below `vertices`
};

/// The newest surface of a simulator, assembled from its topics in any order of messages. An invalid message changes
/// nothing: take() returns the error, and an empty text for a valid message.
class SentSurface {
 public:
  std::string take(const SurfaceTopology& message);
  std::string take(const SurfaceTopologyChange& message);
  std::string take(const SurfaceVerticesConstPtr& message);
  void clear() { *this = SentSurface(); }

  /// Returns the vertices to draw, and below their topology; null until there are both.
  const SurfaceVerticesConstPtr& vertices() const { return vertices_; }
  const std::shared_ptr<const SentTopology>& topology() const { return shown_; }
  bool hasTopology() const { return !known_.empty(); }

 private:
  void keep(std::shared_ptr<const SentTopology> topology);
  std::string join();

  std::deque<std::shared_ptr<const SentTopology>> known_;  ///< known topologies, the newest last
  SurfaceVerticesConstPtr waiting_;                        ///< vertices without their topology
  SurfaceVerticesConstPtr vertices_;
  std::shared_ptr<const SentTopology> shown_;
};

/// Returns a normal from signed 10-bit fractions, x in the low bits.
std::array<float, 3> normalOf(uint32_t packed);

/// Intersection of a ray with the surface.
struct SurfaceHit {
  double distance_m = 0;
  std::array<double, 3> normal{};  ///< unit normal of the triangle
};
/// Returns the nearest intersection in front of `origin`, from either side.
/// @param direction  unit vector   @param positions_m  3 per vertex of the topology
std::optional<SurfaceHit> firstHit(const SentTopology& topology, const std::vector<float>& positions_m,
                                   const std::array<double, 3>& origin, const std::array<double, 3>& direction);

}  // namespace viscera::received
