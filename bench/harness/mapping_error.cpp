// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/mapping_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/harness/rate.h"

namespace viscera::bench {

namespace {

constexpr double kDifference = 1e-4;  // [spacings] step of the finite differences for the gradient of the deformation

/// Returns the normal of a material plane after the deformation.
Vector3d carriedNormal(const Deformation& deformation, const Vector3d& at_m, const Vector3d& normal, double step_m) {
  const Vector3d other = normal.unitOrthogonal(), third = normal.cross(other);
  const auto along = [&](const Vector3d& direction) {
    return Vector3d(deformation(at_m + step_m * direction) - deformation(at_m - step_m * direction));
  };
  return along(other).cross(along(third)).normalized();
}

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

MappingError mappingError(const Model& model, const Deformation& deformation, MovedNormals normals_of_nodes) {
  HostSurface surface(model, normals_of_nodes);
  VisibleMesh shown;
  surface.show(movedState(model, surface.shownBricks(), deformation), shown);
  const TriangleMesh& mesh = model.bodies[0].skin.mesh;
  const std::vector<Vector3f> normals = vertexNormals(mesh);
  const double spacing_m = model.bodies[0].lattice.spacing_m;
  std::vector<double> positions, angles;
  for (size_t v = 0; v < mesh.positions_m.size(); ++v) {
    const Vector3d rest = mesh.positions_m[v].cast<double>(), true_position = deformation(rest);
    positions.push_back((shown.position_m(v).cast<double>() - true_position).norm() / spacing_m);
    const Vector3d normal =
        carriedNormal(deformation, rest, normals[v].cast<double>().normalized(), kDifference * spacing_m);
    const Vector3d mapped = unpackNormal(shown.normals[v]).cast<double>();
    angles.push_back(std::atan2(mapped.cross(normal).norm(), mapped.dot(normal)) * 180 / M_PI);
  }
  return {meanOf(positions), percentile(positions, 0.95), *std::max_element(positions.begin(), positions.end()),
          meanOf(angles), percentile(angles, 0.95)};
}

std::vector<Column> errorColumns() {
  return {
      {"mean", "h", 3}, {"95 %", "h", 3}, {"max", "h", 3}, {"normals, mean", "deg", 3}, {"normals, 95 %", "deg", 3}};
}

void appendError(const MappingError& error, std::vector<Cell>& row) {
  row.insert(row.end(), {error.mean, error.p95, error.max, error.normal_mean, error.normal_p95});
}

}  // namespace viscera::bench
