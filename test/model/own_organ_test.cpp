// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// An organ of our own with an analytical volume: it tests the promises of docs/volumes.md on every machine, with or
// without the meshes that cannot be shipped.
#include <fstream>
#include <numeric>

#include "mesh_samples.h"
#include "solid_probe.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera::test {
namespace {

constexpr int kRings = 64;
constexpr double kWall_m = 0.04, kLeft_m = 0.018, kRight_m = 0.013, kVessel_m = 0.012;
const Vector3f kMiddle(0.0113f, -0.2071f, 0.3017f);  // no multiple of any spacing used here
const Vector3f kLeftAt = kMiddle + Vector3f(-0.016f, 0, 0.001f), kRightAt = kMiddle + Vector3f(0.02f, 0.002f, 0);
constexpr double kVesselAway_m = 0.042;
constexpr double kVolume = 0.01;  ///< relative: docs/volumes.md

/// Returns the volume of the lens that two balls share, with centres `d` apart [m3].
double lens(double r, double s, double d) {
  return kPi * std::pow(r + s - d, 2) * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
}

/// Returns a wall around two chambers, without its cap, and a vessel that overlaps it.
TriangleMesh organ() {
  TriangleMesh mesh = sphereMesh(kMiddle, static_cast<float>(kWall_m), kRings, 3);
  mesh = joined(mesh, turnedInsideOut(sphereMesh(kLeftAt, static_cast<float>(kLeft_m), kRings)), true);
  mesh = joined(mesh, turnedInsideOut(sphereMesh(kRightAt, static_cast<float>(kRight_m), kRings)), true);
  const Vector3f away(0, static_cast<float>(kVesselAway_m), 0);
  mesh = joined(mesh, sphereMesh(kMiddle + away, static_cast<float>(kVessel_m), kRings), false);
  mesh.part_names = {"wall", "vessel"};
  return mesh;
}

double organVolume() {
  return sphereVolume(kWall_m) - sphereVolume(kLeft_m) - sphereVolume(kRight_m) + sphereVolume(kVessel_m) -
         lens(kWall_m, kVessel_m, kVesselAway_m);
}

/// Writes the mesh to a file of named objects. @return its path
std::string organFile() {
  const std::string path = temporaryPath("organ.obj");
  const TriangleMesh mesh = organ();
  std::ofstream file(path);
  file.precision(9);
  for (const Vector3f& p : mesh.positions_m) file << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t == 0 || mesh.parts[t] != mesh.parts[t - 1]) file << "o " << mesh.part_names[mesh.parts[t]] << '\n';
    file << 'f';
    for (const uint32_t v : mesh.triangles[t]) file << ' ' << v + 1;
    file << '\n';
  }
  return path;
}

TEST(OwnOrgan, FillsItsVolumeWithinOnePercentAroundHollowChambers) {
  const TriangleMesh mesh = importMesh(organFile(), 1);
  EXPECT_EQ(mesh.part_names, (std::vector<std::string>{"wall", "vessel"}));
  for (const double h : {0.004, 0.002, 0.001}) {
    VoxelReport report;
    const Solid solid = voxelise(mesh, h, &report);
    EXPECT_NEAR(solid.volumeM3() / organVolume(), 1, kVolume) << h << " m: " << report.text();
    EXPECT_EQ(report.holes_closed, 1) << report.text();
    EXPECT_EQ(report.parts_dropped, 0) << report.text();
    for (const Vector3f& chamber : {kLeftAt, kRightAt}) {
      EXPECT_EQ(labelAt(solid, chamber.cast<double>()), 0) << h;
      EXPECT_FALSE(outsideReaches(solid, chamber.cast<double>())) << h;
    }
    EXPECT_EQ(labelAt(solid, kMiddle.cast<double>() + Vector3d(0, kVesselAway_m + 0.006, 0)), 2) << "vessel";
  }
}

TEST(OwnOrgan, BecomesABodyOfItsMassWithASkinOfEveryTriangleAndACapOnItsHole) {
  constexpr double kSpacing_m = 0.003, kDensity = 1000;
  BodyConfig config;
  config.name = "organ";
  config.source = TissueSource::kMesh;
  config.mesh_file = organFile();
  config.spacing_m = kSpacing_m;
  config.material.density_kg_per_m3 = kDensity;
  Scene scene;
  scene.bodies = {config};
  const Model model = buildModel(scene);
  const Body& body = model.bodies[0];
  EXPECT_EQ(body.lattice.part_names, (std::vector<std::string>{"wall", "vessel"}));
  const Strengths table = strengths(body);
  const double mass_kg = std::accumulate(table.mass_kg.begin(), table.mass_kg.end(), 0.0);
  EXPECT_NEAR(mass_kg / (kDensity * organVolume()), 1, 2 * kVolume);
  const TriangleMesh file = importMesh(config.mesh_file, 1);
  EXPECT_GT(openEdges(file), 0u);
  EXPECT_EQ(openEdges(body.skin.mesh), 0u);
  EXPECT_GE(body.skin.mesh.triangles.size(), file.triangles.size() + openEdges(file));  // a fan, split to the spacing
  EXPECT_NEAR(signedVolume(body.skin.mesh) /
                  (sphereVolume(kWall_m) - sphereVolume(kLeft_m) - sphereVolume(kRight_m) + sphereVolume(kVessel_m)),
              1, kVolume);  // parts overlap
}

}  // namespace
}  // namespace viscera::test
