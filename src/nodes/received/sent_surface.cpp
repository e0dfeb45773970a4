// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/sent_surface.h"

#include <algorithm>
#include <cmath>

namespace viscera::received {
namespace {

constexpr size_t kMostBodies = 1000;    // a hundred have labels in images
constexpr size_t kTopologiesKept = 4;   // vertices are larger and arrive later; over a network, by several changes
constexpr float kFarthest_m = 1e6F;     // beyond it the squares of the renderer's bounds overflow
constexpr float kNormalScale = 511.0F;  // scale of signed 10-bit fractions

std::string text(size_t number) {
  return std::to_string(number);
}

/// Completes and checks a topology. @returns an error, or an empty text
std::string complete(SentTopology& topology, const std::vector<uint32_t>& body_triangles,
                     const std::vector<uint32_t>& wound_triangles) {
  const size_t bodies = topology.bodies.size();
  if (bodies > kMostBodies) return text(bodies) + " bodies, more than " + text(kMostBodies);
  if (body_triangles.size() != bodies || wound_triangles.size() != bodies)
    return "bodies, body_triangles and wound_triangles have " + text(bodies) + ", " + text(body_triangles.size()) +
           " and " + text(wound_triangles.size()) + " entries, but need the same number";
  for (const std::vector<uint32_t>* colors : {&topology.body_colors, &topology.wound_colors})
    if (!colors->empty() && colors->size() != bodies)
      return "body_colors and wound_colors have " + text(topology.body_colors.size()) + " and " +
             text(topology.wound_colors.size()) + " entries for " + text(bodies) + " bodies";
  if (topology.triangles.size() % 3 != 0)
    return text(topology.triangles.size()) + " entries in triangles, which is not a multiple of 3";
  size_t first = 0;
  topology.parts.clear();
  for (size_t b = 0; b < bodies; ++b) {
    if (wound_triangles[b] > body_triangles[b])
      return "wound_triangles[" + text(b) + "] = " + text(wound_triangles[b]) + " are more than body_triangles[" +
             text(b) + "] = " + text(body_triangles[b]);
    const size_t skin = body_triangles[b] - wound_triangles[b];
    const auto color = [b](const std::vector<uint32_t>& of) {
      return of.empty() ? std::nullopt : std::optional(of[b]);
    };
    topology.parts.push_back({b, false, first, skin, color(topology.body_colors)});
    topology.parts.push_back({b, true, first + skin, wound_triangles[b], color(topology.wound_colors)});
    first += body_triangles[b];
  }
  if (first != topology.triangles.size() / 3)
    return "body_triangles sum up to " + text(first) + ", but there are " + text(topology.triangles.size() / 3) +
           " triangles";
  const auto most = std::max_element(topology.triangles.begin(), topology.triangles.end());
  if (most != topology.triangles.end() && *most >= topology.vertices)
    return "triangles refer to vertex " + text(*most) + ", but there are only " + text(topology.vertices);
  return {};
}

/// Applies a change. @returns an error, or an empty text
std::string edit(const std::vector<uint32_t>& before, const SurfaceTopologyChange& change, std::vector<uint32_t>& out) {
  const size_t positions = change.kept.size();
  if (change.removed.size() != positions || change.added.size() != positions)
    return "kept, removed and added have " + text(positions) + ", " + text(change.removed.size()) + " and " +
           text(change.added.size()) + " entries, but need the same number";
  size_t at = 0, from = 0;  // triangle counts: sums of 32-bit numbers fit
  for (size_t e = 0; e < positions; ++e) {
    const size_t kept_end = at + change.kept[e], end = kept_end + change.removed[e], added = from + change.added[e];
    if (end > before.size() / 3 || added > change.triangles.size() / 3)
      return "place " + text(e) + " goes beyond the existing triangles";
    const auto b = before.begin();
    const auto c = change.triangles.begin();
    out.insert(out.end(), b + static_cast<ptrdiff_t>(3 * at), b + static_cast<ptrdiff_t>(3 * kept_end));
    out.insert(out.end(), c + static_cast<ptrdiff_t>(3 * from), c + static_cast<ptrdiff_t>(3 * added));
    at = end;
    from = added;
  }
  out.insert(out.end(), before.begin() + static_cast<ptrdiff_t>(3 * at), before.end());
  return {};
}

std::array<double, 3> minus(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

std::string SentSurface::take(const SurfaceTopology& message) {
  // Skips one that changes have overtaken. After a restart of the simulator, stamps go on and versions do not.
  if (!known_.empty() && message.version < known_.back()->version && message.header.stamp <= known_.back()->stamp)
    return {};
  auto topology = std::make_shared<SentTopology>();
  topology->version = message.version;
  topology->vertices = message.vertices;
  topology->stamp = message.header.stamp;
  topology->bodies = message.bodies;
  topology->body_colors = message.body_colors;
  topology->wound_colors = message.wound_colors;
  topology->triangles = message.triangles;
  if (std::string wrong = complete(*topology, message.body_triangles, message.wound_triangles); !wrong.empty())
    return "topology: " + wrong;
  if (!known_.empty()) {
    const SentTopology& last = *known_.back();
    const bool same = last.version == topology->version && last.vertices == topology->vertices &&
                      last.bodies == topology->bodies && last.body_colors == topology->body_colors &&
                      last.wound_colors == topology->wound_colors && last.triangles == topology->triangles;
    if (same) return {};
    if (topology->version <= last.version) known_.clear();
  }
  keep(std::move(topology));
  return join();
}

std::string SentSurface::take(const SurfaceTopologyChange& message) {
  if (known_.empty() || message.version != known_.back()->version + 1) return {};  // the next whole topology has it all
  const SentTopology& last = *known_.back();
  auto topology = std::make_shared<SentTopology>();
  topology->version = message.version;
  topology->vertices = message.vertices;
  topology->stamp = message.header.stamp;
  topology->bodies = last.bodies;
  topology->body_colors = last.body_colors;
  topology->wound_colors = last.wound_colors;
  std::string wrong = edit(last.triangles, message, topology->triangles);
  if (wrong.empty()) wrong = complete(*topology, message.body_triangles, message.wound_triangles);
  if (!wrong.empty()) return "change of the topology: " + wrong;
  keep(std::move(topology));
  return join();
}

std::string SentSurface::take(const SurfaceVerticesConstPtr& message) {
  for (const float x : message->positions_m)
    if (!(std::abs(x) <= kFarthest_m)) return "vertices: a position is not finite, or beyond 1e6 m";
  waiting_ = message;
  return join();
}

void SentSurface::keep(std::shared_ptr<const SentTopology> topology) {
  known_.push_back(std::move(topology));
  if (known_.size() > kTopologiesKept) known_.pop_front();
}

std::string SentSurface::join() {
  if (!waiting_) return {};
  for (const std::shared_ptr<const SentTopology>& topology : known_) {
    if (topology->version != waiting_->topology_version) continue;
    const SurfaceVerticesConstPtr found = std::move(waiting_);
    waiting_.reset();
    if (found->positions_m.size() != 3 * static_cast<size_t>(topology->vertices) ||
        found->normals.size() != topology->vertices)
      return "vertices: " + text(found->positions_m.size()) + " coordinates and " + text(found->normals.size()) +
             " normals for " + text(topology->vertices) + " vertices of topology " + text(topology->version);
    if (!found->colors.empty() && found->colors.size() != topology->vertices)
      return "vertices: " + text(found->colors.size()) + " colors for " + text(topology->vertices) + " vertices";
    vertices_ = found;
    shown_ = topology;
    return {};
  }
  return {};
}

std::array<float, 3> normalOf(uint32_t packed) {
  const auto part = [packed](unsigned shift) {  // sign-extends from the top bit
    const auto value = static_cast<int32_t>(packed << (22 - shift)) >> 22;
    return std::max(static_cast<float>(value) / kNormalScale, -1.0F);
  };
  return {part(0), part(10), part(20)};
}

std::optional<SurfaceHit> firstHit(const SentTopology& topology, const std::vector<float>& positions_m,
                                   const std::array<double, 3>& origin, const std::array<double, 3>& direction) {
  const auto point = [&](size_t corner) {
    const float* p = &positions_m[3 * static_cast<size_t>(topology.triangles[corner])];
    return std::array<double, 3>{p[0], p[1], p[2]};
  };
  std::optional<SurfaceHit> nearest;
  for (size_t t = 0; t < topology.triangles.size(); t += 3) {
    const std::array<double, 3> a = point(t), ab = minus(point(t + 1), a), ac = minus(point(t + 2), a);
    const std::array<double, 3> p = cross(direction, ac);
    const double volume = dot(ab, p);
    if (volume == 0) continue;  // edge-on or degenerate
    const std::array<double, 3> ao = minus(origin, a), q = cross(ao, ab);
    const double u = dot(ao, p) / volume, v = dot(direction, q) / volume, distance = dot(ac, q) / volume;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && distance > 0) || (nearest && distance >= nearest->distance_m)) continue;
    std::array<double, 3> normal = cross(ab, ac);
    const double length = std::sqrt(dot(normal, normal));
    for (double& x : normal) x /= length;
    nearest = SurfaceHit{distance, normal};
  }
  return nearest;
}

}  // namespace viscera::received
