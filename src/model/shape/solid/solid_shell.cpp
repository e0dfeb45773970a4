// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_shell.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "model/shape/solid/joined_parts.h"
#include "model/shape/solid/triangle_sides.h"

namespace viscera {
namespace {

using Triangle = std::array<uint32_t, 3>;

struct Link {
  uint32_t triangle;
  bool opposed;  ///< the two triangles run in the same direction along their edge: one of them is inside out
};

std::vector<std::array<Link, 3>> linkTriangles(const std::vector<Triangle>& triangles, std::vector<uint8_t>& links) {
  std::vector<std::array<Link, 3>> neighbors(triangles.size());
  links.assign(triangles.size(), 0);
  const std::vector<Side> sides = sortedSides(triangles);
  forEachEdge(sides, [&](size_t first, size_t last) {
    if (last - first != 2) return;
    const Side &a = sides[first], &b = sides[first + 1];
    const bool opposed = a.forward == b.forward;
    neighbors[a.triangle][links[a.triangle]++] = {b.triangle, opposed};
    neighbors[b.triangle][links[b.triangle]++] = {a.triangle, opposed};
  });
  return neighbors;
}

/// Turns triangles so that neighbours agree; each connected piece keeps the orientation of its majority. Returns which
/// were turned.
std::vector<bool> orientAlike(std::vector<Triangle>& triangles) {
  std::vector<uint8_t> links;
  const auto neighbors = linkTriangles(triangles, links);
  std::vector<int8_t> turn(triangles.size(), -1);  // -1 not visited, else whether it disagrees with the seed
  std::vector<bool> turned(triangles.size(), false);
  for (uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (turn[seed] >= 0) continue;
    std::vector<uint32_t> piece = {seed};
    turn[seed] = 0;
    size_t disagreeing = 0;
    for (size_t next = 0; next < piece.size(); ++next) {
      const uint32_t t = piece[next];
      disagreeing += turn[t];
      for (int e = 0; e < links[t]; ++e) {
        const Link& link = neighbors[t][e];
        if (turn[link.triangle] >= 0) continue;
        turn[link.triangle] = link.opposed ? 1 - turn[t] : turn[t];
        piece.push_back(link.triangle);
      }
    }
    const int minority = 2 * disagreeing > piece.size() ? 0 : 1;
    for (const uint32_t t : piece) {
      turned[t] = turn[t] == minority;
      if (turned[t]) std::swap(triangles[t][1], triangles[t][2]);
    }
  }
  return turned;
}

/// Returns the open loops of a surface, directed so that a fan over each closes it.
std::vector<std::vector<uint32_t>> openLoops(const std::vector<Triangle>& triangles) {
  // The unmatched directions at the edges always add up to closed loops.
  std::map<uint32_t, std::vector<uint32_t>> next;
  const std::vector<Side> sides = sortedSides(triangles);
  forEachEdge(sides, [&](size_t first, size_t last) {
    int net = 0;
    for (size_t s = first; s < last; ++s) net += sides[s].forward ? 1 : -1;
    for (; net > 0; --net) next[sides[first].high].push_back(sides[first].low);
    for (; net < 0; ++net) next[sides[first].low].push_back(sides[first].high);
  });
  std::vector<std::vector<uint32_t>> loops;
  for (auto& [start, targets] : next) {
    while (!targets.empty()) {
      std::vector<uint32_t> path = {start};
      while (!path.empty()) {
        auto& onward = next[path.back()];
        if (onward.empty()) break;
        const uint32_t vertex = onward.back();
        onward.pop_back();
        const auto met = std::find(path.begin(), path.end(), vertex);
        if (met == path.end()) {
          path.push_back(vertex);
          continue;
        }
        loops.emplace_back(met, path.end());
        path.erase(met + 1, path.end());
      }
    }
  }
  return loops;
}

Vector3d doubledArea(const Shell& shell, const Triangle& t) {
  const Vector3d& a = shell.positions_m[t[0]];
  return (shell.positions_m[t[1]] - a).cross(shell.positions_m[t[2]] - a);
}

void dropUnusedVertices(TriangleMesh& mesh) {
  constexpr uint32_t kUnused = UINT32_MAX;
  std::vector<uint32_t> moved(mesh.positions_m.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t vertex : t) moved[vertex] = 0;
  }
  uint32_t kept = 0;
  for (size_t v = 0; v < moved.size(); ++v) {
    if (moved[v] == kUnused) continue;
    mesh.positions_m[kept] = mesh.positions_m[v];
    moved[v] = kept++;
  }
  mesh.positions_m.resize(kept);
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& vertex : t) vertex = moved[vertex];
  }
}

void cap(Shell& shell, const std::vector<uint32_t>& loop) {
  Vector3d middle = Vector3d::Zero();
  for (const uint32_t v : loop) middle += shell.positions_m[v] / static_cast<double>(loop.size());
  const auto apex = static_cast<uint32_t>(shell.positions_m.size());
  shell.positions_m.push_back(middle);
  double area = 0, perimeter = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Triangle triangle = {loop[i], loop[(i + 1) % loop.size()], apex};
    shell.triangles.push_back(triangle);
    area += 0.5 * doubledArea(shell, triangle).norm();
    perimeter += (shell.positions_m[triangle[1]] - shell.positions_m[triangle[0]]).norm();
  }
  shell.cap_area_m2 += area;
  // A slit left by a removed sliver is no hole.
  constexpr double kSlit = 1e-6;
  const bool is_hole = area > kSlit * perimeter * perimeter;
  shell.closes_hole.insert(shell.closes_hole.end(), loop.size(), is_hole);
  shell.holes_closed += is_hole;
}

}  // namespace

Vector3d Shell::min() const {
  Vector3d low = positions_m.at(0);
  for (const Vector3d& p : positions_m) low = low.cwiseMin(p);
  return low;
}

Vector3d Shell::max() const {
  Vector3d high = positions_m.at(0);
  for (const Vector3d& p : positions_m) high = high.cwiseMax(p);
  return high;
}

std::vector<std::vector<uint32_t>> trianglesByPart(const TriangleMesh& mesh) {
  std::vector<std::vector<uint32_t>> out(mesh.part_names.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) out[mesh.parts[t]].push_back(t);
  return out;
}

Shell closePart(const TriangleMesh& mesh, const std::vector<uint32_t>& of_part, const std::vector<uint32_t>& same) {
  Shell shell;
  std::unordered_map<uint32_t, uint32_t> local;
  for (const uint32_t t : of_part) {
    Triangle triangle;
    for (int c = 0; c < 3; ++c) {
      const uint32_t corner = mesh.triangles[t][c], vertex = same.empty() ? corner : same[corner];
      const auto next = static_cast<uint32_t>(shell.positions_m.size());
      const auto [found, is_new] = local.try_emplace(vertex, next);
      if (is_new) {
        shell.positions_m.push_back(mesh.positions_m[vertex].cast<double>());
        shell.vertices.push_back(vertex);
      }
      triangle[c] = found->second;
    }
    shell.triangles.push_back(triangle);
    shell.own_area_m2 += 0.5 * doubledArea(shell, triangle).norm();
  }
  shell.turned = orientAlike(shell.triangles);
  for (const auto& loop : openLoops(shell.triangles)) cap(shell, loop);
  const Vector3d base = shell.positions_m.empty() ? Vector3d::Zero() : shell.positions_m[0];
  for (const Triangle& t : shell.triangles) {
    shell.volume_m3 += (shell.positions_m[t[0]] - base).dot(doubledArea(shell, t)) / 6;
  }
  return shell;
}

Shell boxShell(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose) {
  Shell shell;
  for (int c = 0; c < 8; ++c) {
    const Vector3d corner(c & 1 ? max_m.x() : min_m.x(), c & 2 ? max_m.y() : min_m.y(), c & 4 ? max_m.z() : min_m.z());
    shell.positions_m.push_back(pose * corner);
  }
  shell.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  shell.turned.assign(shell.triangles.size(), false);
  for (const Triangle& t : shell.triangles) shell.own_area_m2 += 0.5 * doubledArea(shell, t).norm();
  shell.volume_m3 = (max_m - min_m).prod();
  return shell;
}

TriangleMesh facingOutward(const TriangleMesh& mesh) {
  TriangleMesh facing = mesh;
  bool is_joined = false;
  for (const ClosedSurface& surface : closeSurfaces(mesh)) {
    const Shell& shell = surface.shell;
    for (size_t own = 0; own < surface.triangles.size(); ++own) {  // in the order of the mesh, already turned
      Triangle& triangle = facing.triangles[surface.triangles[own]];
      for (int c = 0; c < 3; ++c) triangle[c] = shell.vertices[shell.triangles[own][c]];
      if (shell.volume_m3 < 0) std::swap(triangle[1], triangle[2]);
    }
    is_joined = is_joined || surface.is_joined;
  }
  if (is_joined) dropUnusedVertices(facing);
  return facing;
}

TriangleMesh withCaps(const TriangleMesh& mesh) {
  TriangleMesh out = mesh;
  for (const ClosedSurface& surface : closeSurfaces(mesh)) {
    const Shell& shell = surface.shell;
    if (shell.isOpenSheet()) continue;
    std::unordered_map<uint32_t, uint32_t> apexes;
    const auto numberOf = [&](uint32_t vertex) {
      if (vertex < shell.vertices.size()) return shell.vertices[vertex];
      const auto [found, is_new] = apexes.try_emplace(vertex, static_cast<uint32_t>(out.positions_m.size()));
      if (is_new) out.positions_m.push_back(shell.positions_m[vertex].cast<float>());
      return found->second;
    };
    for (size_t c = 0; c < shell.closes_hole.size(); ++c) {
      if (!shell.closes_hole[c]) continue;
      const Triangle& cap = shell.triangles[surface.triangles.size() + c];
      out.triangles.push_back({numberOf(cap[0]), numberOf(cap[1]), numberOf(cap[2])});
      out.parts.push_back(surface.part);
      if (!out.charts.empty()) out.charts.push_back(kNoChart);
    }
  }
  return out;
}

}  // namespace viscera
