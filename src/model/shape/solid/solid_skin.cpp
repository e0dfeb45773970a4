// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Visible, so that a program shares all static data of these templates with OpenVDB's library. It always shares the
// flags in inline functions; if it did not share the names that they guard, the library would take its own for set.
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/VolumeToMesh.h>
#pragma GCC visibility pop

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "model/shape/solid/solid_grid.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/solid.h"

namespace viscera {
namespace {

/// Smallest magnitude of a cell's value after smoothing, so that no cell changes sides and thin walls remain.
constexpr float kKeepSide = 0.5f;
/// Largest distance that a solid's surface moves outward to compensate for its clipped edges, in cells.
constexpr double kMostSkinInflation = 0.4;
/// Smallest distance of a sample from the surface, in spacings: two vertices never coincide at a sample.
constexpr double kClearOfSample = 0.05;

/// Map from index coordinates of the grid to positions [m].
struct GridFrame {
  Vector3d origin_m;
  double spacing_m;

  Vector3d position(const Vector3d& index) const { return origin_m + spacing_m * index; }
};

float lengthSquared(const TriangleMesh& mesh, uint32_t a, uint32_t b) {
  return (mesh.positions_m[a] - mesh.positions_m[b]).squaredNorm();
}

/// Returns the zero isosurface of the grid; the grid grows outwards. Parts are left at 0.
TriangleMesh isosurface(const openvdb::FloatGrid& grid, const GridFrame& frame) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, 0.0, 0.0);
  TriangleMesh mesh;
  for (const auto& p : points) mesh.positions_m.push_back(frame.position({p.x(), p.y(), p.z()}).cast<float>());
  for (const auto& t : triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  for (const auto& q : quads) {
    const uint32_t a = q[0], b = q[1], c = q[2], d = q[3];
    if (lengthSquared(mesh, a, c) <= lengthSquared(mesh, b, d)) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    } else {
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({b, c, d});
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

template <typename PartAt>
void labelTriangles(TriangleMesh& mesh, PartAt part_at) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vector3d middle = Vector3d::Zero();
    for (const uint32_t v : mesh.triangles[t]) middle += mesh.positions_m[v].cast<double>() / 3;
    mesh.parts[t] = part_at(middle);
  }
}

/// Returns a grid with -1 in the cells of a solid, 1 in all others; active where smoothing may act.
openvdb::FloatGrid::Ptr signOfCells(const Solid& solid) {
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(1.0f);
  openvdb::FloatGrid::Accessor cells = grid->getAccessor();
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.label(x, y, z) != 0) cells.setValue({x, y, z}, -1.0f);
      }
    }
  }
  openvdb::tools::dilateActiveValues(grid->tree(), 2, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::EXPAND_TILES);
  return grid;
}

/// Smooths the stairs of a solid without moving the surface past the centre of any cell.
void smoothStairs(openvdb::FloatGrid& grid, const Solid& solid) {
  openvdb::tools::Filter<openvdb::FloatGrid>(grid).mean(1, 1);
  for (auto value = grid.beginValueOn(); value; ++value) {
    const openvdb::Coord c = value.getCoord();
    const bool inside = solid.label(c.x(), c.y(), c.z()) != 0;
    value.setValue(inside ? std::min(*value, -kKeepSide) : std::max(*value, kKeepSide));
  }
}

/// Moves the surface outwards evenly until it encloses the solid's volume again: clipped edges and corners lose volume.
void restoreVolume(TriangleMesh& mesh, const Solid& solid) {
  double area_m2 = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3f& a = mesh.positions_m[t[0]];
    area_m2 += 0.5 * (mesh.positions_m[t[1]] - a).cross(mesh.positions_m[t[2]] - a).norm();
  }
  const double most_m = kMostSkinInflation * solid.spacing_m;
  const double outward_m = std::clamp((solid.volumeM3() - signedVolume(mesh)) / area_m2, -most_m, most_m);
  const std::vector<Vector3f> normals = vertexNormals(mesh);
  for (size_t v = 0; v < normals.size(); ++v) mesh.positions_m[v] += static_cast<float>(outward_m) * normals[v];
}

/// Returns the part of the filled cell with its centre nearest to a point on the surface.
uint16_t nearestPart(const Solid& solid, const Vector3d& point_m) {
  const Vector3d index = (point_m - solid.origin_m) / solid.spacing_m - Vector3d::Constant(0.5);
  const Vector3i base = index.array().round().cast<int>();
  double nearest = std::numeric_limits<double>::infinity();
  uint16_t label = 1;
  for (int i = 0; i < 27; ++i) {
    const Vector3i cell = base + Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const uint16_t here = solid.label(cell.x(), cell.y(), cell.z());
    const double distance = (cell.cast<double>() - index).squaredNorm();
    if (here == 0 || distance >= nearest) continue;
    nearest = distance;
    label = here;
  }
  return label - 1;
}

}  // namespace

TriangleMesh extractSkin(const Solid& solid) {
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = signOfCells(solid);
  smoothStairs(*grid, solid);
  const GridFrame frame{solid.origin_m + Vector3d::Constant(0.5 * solid.spacing_m), solid.spacing_m};
  TriangleMesh mesh = isosurface(*grid, frame);
  if (mesh.triangles.empty()) throw LatticeError("a solid without filled cells has no surface");
  restoreVolume(mesh, solid);
  labelTriangles(mesh, [&](const Vector3d& point_m) { return nearestPart(solid, point_m); });
  mesh.part_names = solid.part_names;
  return mesh;
}

TriangleMesh extractSkin(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
                         const Vector3d& max_m, double spacing_m) {
  openvdb::initialize();
  requireSpacing(spacing_m);
  constexpr double kMargin = 2;  // samples around the box, so that the surface closes
  const Eigen::Array3d wanted = ((max_m - min_m).array() / spacing_m).ceil() + 2 * kMargin + 1;
  requireGridMemory(wanted, spacing_m);
  const Vector3i samples = wanted.cast<int>();
  const GridFrame frame{min_m - Vector3d::Constant(kMargin * spacing_m), spacing_m};
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(static_cast<float>(kMargin * spacing_m));
  openvdb::FloatGrid::Accessor values = grid->getAccessor();
  for (int z = 0; z < samples.z(); ++z) {
    for (int y = 0; y < samples.y(); ++y) {
      for (int x = 0; x < samples.x(); ++x) {
        const double distance_m = field(frame.position(Vector3d(x, y, z))).distance_m;
        const double clear_m = std::copysign(std::max(std::abs(distance_m), kClearOfSample * spacing_m), distance_m);
        values.setValue({x, y, z}, static_cast<float>(clear_m));
      }
    }
  }
  TriangleMesh mesh = isosurface(*grid, frame);
  if (mesh.triangles.empty()) throw LatticeError("no surface found at spacing_m " + numberText(spacing_m));
  labelTriangles(mesh, [&](const Vector3d& point_m) { return field(point_m).part; });
  mesh.part_names = part_names;
  return mesh;
}

}  // namespace viscera
