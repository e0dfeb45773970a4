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

namespace viscera::rviz_plugin {

/// Triangles of one body that are drawn alike.
struct SentPart {
  size_t body = 0;              ///< of SentTopology::bodies
  bool walls = false;           ///< of wounds
  size_t first = 0, count = 0;  ///< triangles
  /// sRGB, red in the low byte; nothing: the sender has not told it
  std::optional<uint32_t> color = {};
};

/// A topology whose every number was checked.
struct SentTopology {
  uint32_t version = 0, vertices = 0;
  ros::Time stamp;
  std::vector<std::string> bodies;
  std::vector<uint32_t> body_colors, wound_colors;  ///< of each; both may be empty
  std::vector<SentPart> parts;                      ///< skin and walls of each body
  std::vector<uint32_t> triangles;                  ///< 3 vertices each, all below `vertices`
};

/// The newest surface of a simulator, joined from its topics in whatever order their messages come. Messages that are
/// wrong change nothing: what take...() returns says why, and is empty of good ones.
class SentSurface {
 public:
  std::string take(const SurfaceTopology& message);
  std::string take(const SurfaceTopologyChange& message);
  std::string take(const SurfaceVerticesConstPtr& message);
  void clear() { *this = SentSurface(); }

  /// What is to be shown: vertices, and the topology they belong to; null before there are both.
  const SurfaceVerticesConstPtr& vertices() const { return vertices_; }
  const std::shared_ptr<const SentTopology>& topology() const { return shown_; }
  bool hasTopology() const { return !known_.empty(); }

 private:
  void keep(std::shared_ptr<const SentTopology> topology);
  std::string join();

  std::deque<std::shared_ptr<const SentTopology>> known_;  ///< the newest last
  SurfaceVerticesConstPtr waiting_;                        ///< for their topology
  SurfaceVerticesConstPtr vertices_;
  std::shared_ptr<const SentTopology> shown_;
};

/// Signed 10-bit fractions, x in the low bits.
std::array<float, 3> normalOf(uint32_t packed);

/// A point of a ray on the surface.
struct SurfaceHit {
  double distance_m = 0;
  std::array<double, 3> normal{};  ///< of the triangle, of length 1
};
/// The nearest triangle before `origin`, from whichever side.
/// @param direction  of length 1   @param positions_m  3 per vertex of the topology
std::optional<SurfaceHit> firstHit(const SentTopology& topology, const std::vector<float>& positions_m,
                                   const std::array<double, 3>& origin, const std::array<double, 3>& direction);

}  // namespace viscera::rviz_plugin
