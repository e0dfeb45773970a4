// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "bench/harness/mapping_error.h"
#include "bench/suites/egve/egve_parts.h"
#include "viscera/model/shape/solid.h"

namespace viscera::bench {

namespace {

constexpr double kWidth_m = 0.02, kLength_m = 0.06;  // size of a round bar along x
constexpr double kTurn = M_PI / 2;                   // rotation of one end against the other, bent or twisted

/// Returns a bar with round ends and shallow grooves around it.
TriangleMesh roundBar(int around, int up) {
  return closedMesh(around, up, [](const Vector3d& d) {
    const double flat = std::pow(std::abs(d.z()), 1.5) * (d.z() < 0 ? -1 : 1);  // more rings near the centre
    const double groove =
        1 - 0.05 * (1 + std::cos(9 * M_PI * flat)) / 2 - 0.03 * (1 + std::cos(6 * std::atan2(d.y(), d.x()))) / 2;
    const double reach = std::sqrt(std::max(0.0, 1 - std::pow(std::abs(flat), 6)));
    const Vector3d out = std::hypot(d.x(), d.y()) > 1e-9 ? Vector3d(d.x(), d.y(), 0).normalized() : Vector3d(0, 0, 0);
    return Vector3d(0.5 * kLength_m * flat, 0.5 * kWidth_m * groove * reach * out.y(),
                    -0.5 * kWidth_m * groove * reach * out.x());
  });
}

/// Pure bending: cross-sections stay plane, the centre line keeps its length.
Vector3d bent(const Vector3d& x) {
  const double radius_m = kLength_m / kTurn, angle = x.x() / radius_m, from_centre_m = radius_m - x.z();
  return {from_centre_m * std::sin(angle), x.y(), radius_m - from_centre_m * std::cos(angle)};
}
Vector3d twisted(const Vector3d& x) {
  const double angle = kTurn * x.x() / kLength_m, c = std::cos(angle), s = std::sin(angle);
  return {x.x(), c * x.y() - s * x.z(), s * x.y() + c * x.z()};
}
/// Boussinesq's displacements under a force on an elastic half space (nu = 1/4) that acts a quarter of the width above
/// the bar. They are scaled so that the bar's top sinks by an eighth of its width.
Vector3d indented(const Vector3d& x) {
  constexpr double kNu = 0.25, kAbove_m = kWidth_m / 4, kDepth_m = kWidth_m / 8;
  const auto shape = [&](const Vector3d& p) {
    const double z = 0.5 * kWidth_m + kAbove_m - p.z(), r = std::hypot(p.x(), p.y()), big = std::hypot(r, z);
    const double down = 2 * (1 - kNu) / big + z * z / (big * big * big);
    const double out = r / (big * big * big) * z - (1 - 2 * kNu) * r / (big * (big + z));
    const Vector3d direction = r > 1e-12 ? Vector3d(p.x() / r, p.y() / r, 0) : Vector3d(0, 0, 0);
    return Vector3d(out * direction - down * Vector3d::UnitZ());
  };
  const double at_top = -shape({0, 0, 0.5 * kWidth_m}).z();
  return x + kDepth_m / at_top * shape(x);
}

struct Case {
  const char* name;
  Vector3d (*deformation)(const Vector3d&);
};
constexpr Case kCases[] = {{"bending", bent}, {"twist", twisted}, {"indentation", indented}};

struct Filled {
  const char* cells;
  Solid solid;
};

void measureBody(Report& report, const Filled& filled, int across, const TriangleMesh& mesh, Table& table) {
  std::vector<Model> models;
  for (const Mapping mapping : allMappings()) models.push_back(mappedModel(filled.solid, mesh, mapping));
  for (const Case& bar : kCases) {
    double constant = 0, interpolated = 0;
    for (size_t m = 0; m < models.size(); ++m) {
      const Mapping mapping = allMappings()[m];
      const MappingError error = mappingError(models[m], bar.deformation);
      if (mapping == Mapping::kConstant) constant = error.mean;
      if (mapping == Mapping::kInterpolated) interpolated = error.mean;
      std::vector<Cell> row = {filled.cells, bar.name, across, nameOf(mapping), 100 * shareAsAsked(models[m])};
      appendError(error, row);
      table.add(row);
      if (mapping != Mapping::kInterpolated) continue;
      row = {filled.cells, bar.name, across, "interpolated, eq 5", 100 * shareAsAsked(models[m])};
      appendError(mappingError(models[m], bar.deformation, MovedNormals::kSummed), row);
      table.add(row);
    }
    if (bar.deformation == bent)
      report.checkAtMost("mean error in bending, interpolated over constant, " + std::string(filled.cells) + ", " +
                             std::to_string(across) + " cells across",
                         interpolated / constant, 1);
  }
}

}  // namespace

void measureMappingErrors(Report& report) {
  std::vector<Column> columns = {
      {"cells"}, {"deformation"}, {"cells across", "", 3}, {"mapping"}, {"vertices that have it", "%", 3}};
  for (const Column& column : errorColumns()) columns.push_back(column);
  Table table(
      "error of the mapping with exact nodes: a round bar with grooves, bent by 90 deg, twisted by 90 deg, indented",
      columns);
  const TriangleMesh mesh = report.isShort() ? roundBar(48, 64) : roundBar(96, 192);
  for (const int across : report.isShort() ? std::vector<int>{2, 4} : std::vector<int>{2, 4, 8, 16}) {
    report.stage("errors of mappings, " + std::to_string(across) + " cells across");
    const double spacing_m = kWidth_m / across;
    measureBody(report, {"in part", voxeliseByMoments(mesh, spacing_m)}, across, mesh, table);
    measureBody(report, {"full", voxelise(mesh, spacing_m)}, across, mesh, table);
  }
  report.add(table, "errors");
}

}  // namespace viscera::bench
