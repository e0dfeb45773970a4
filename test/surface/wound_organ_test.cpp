// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds of organs (docs/surface.md): the built-in heart, and a real one if its mesh is present.
#include <gtest/gtest.h>

#include <iostream>
#include <string>

#include "model/mesh_samples.h"
#include "surface/wound_checks.h"
#include "viscera/model/scene/scene.h"

namespace viscera::testing {
namespace {

constexpr double kWoundOrganVolume = 1e-6;  // share of the body's own volume; wounds close up to rounding of floats
constexpr double kWoundOrganGap = 0.02;     // of the spacing: between lips at rest
constexpr double kWoundOrganOff = 0.1;  // of the spacing: lips and walls of a flat cut from its plane, 99th percentile
constexpr double kPull = 0.6;           // of the spacing: displacement of either side

Body bodyOf(const BodyConfig& config) {
  Scene scene;
  scene.bodies = {config};
  Model model = buildModel(scene);
  return std::move(model.bodies[0]);
}

struct Incision {
  Vector3d middle_m, outward, normal;
};

/// Returns incisions at the outermost points of a surface in ten directions; blades enter upright, then more and more
/// slanting.
std::vector<Incision> incisionsOf(const Skin& skin) {
  const std::vector<Vector3f> normals = vertexNormals(skin.mesh);
  std::vector<Incision> out;
  for (const Vector3d& direction : anglesOfCuts()) {
    const Vector3f along = direction.cast<float>();
    size_t best = 0;
    for (size_t v = 0; v < normals.size(); ++v) {
      if (skin.mesh.positions_m[v].dot(along) > skin.mesh.positions_m[best].dot(along)) best = v;
    }
    Incision incision;
    incision.middle_m = skin.mesh.positions_m[best].cast<double>();
    incision.outward = normals[best].cast<double>();
    const Vector3d across = incision.outward.cross(Vector3d(direction.y(), -direction.z(), direction.x())).normalized();
    incision.normal = (across + 0.04 * static_cast<double>(out.size()) * incision.outward).normalized();
    out.push_back(incision);
  }
  return out;
}

/// Tests all requirements on wounds, for `count` incisions four spacings deep: through most walls of a heart.
void expectWoundsOf(const Body& body, size_t count) {
  Wounded organ(body);
  organ.update();
  const double h = organ.lattice.spacing_m, reach_m = 4 * h;
  const std::vector<Vector3d> whole = organ.positions(organ.still());
  const double volume_m3 = volume(organ, whole);
  const Edges whole_edges = edgesOf(organ);
  std::vector<double> all_off_m;
  for (size_t i = 0; i < count; ++i) {
    const Incision incision = incisionsOf(organ.skin)[i];
    SCOPED_TRACE(::testing::Message() << "incision " << i);
    organ.makeWhole();
    organ.cut(incision.middle_m, incision.normal,
              [&](const Vector3d& at) { return (at - incision.middle_m).norm() < reach_m; });
    organ.update();
    const auto backs = [&](const std::vector<Vector3d>& at) {
      return backsSeen(organ, at, incision.middle_m, incision.outward, reach_m);
    };
    const std::vector<Vector3d> rest = organ.positions(organ.still());
    const std::vector<Vector3d> open =
        organ.positions(organ.heldOpen(incision.middle_m, incision.normal, reach_m, kPull * h));
    const std::vector<double> gaps_m = lipGaps(organ, rest),
                              off_m = distancesFromPlane(organ, rest, incision.middle_m, incision.normal);
    const double closed = backs(rest), pulled = backs(open);
    ASSERT_GT(gaps_m.size(), 8u);  // there is a wound
    EXPECT_LT(gaps_m.back() / h, kWoundOrganGap);
    all_off_m.insert(all_off_m.end(), off_m.begin(), off_m.end());
    EXPECT_NEAR(volume(organ, rest) / volume_m3, 1, kWoundOrganVolume);
    EXPECT_EQ(edgesOf(organ).open, whole_edges.open);
    EXPECT_LE(closed, kBacksAtRest);
    EXPECT_LE(pulled, kBacks);
    std::cout << "incision " << i << ": off the blade " << percentile99(off_m) / h << " h (most " << off_m.back() / h
              << "), edges of more than two triangles " << whole_edges.shared << " before and " << edgesOf(organ).shared
              << " after, back faces " << closed << " shut and " << pulled << " pulled open\n";
  }
  std::sort(all_off_m.begin(), all_off_m.end());
  EXPECT_LT(percentile99(all_off_m) / h, kWoundOrganOff);
}

TEST(WoundOfOrgan, PhantomKeepsToTheChecks) {
  BodyConfig config;
  config.name = "heart";
  config.spacing_m = 0.005;
  config.skin_spacing_m = 0.003;
  expectWoundsOf(bodyOf(config), 3);
}

TEST(WoundOfOrgan, RealHeartKeepsToTheChecks) {
  BodyConfig config;
  config.name = "heart";
  config.source = TissueSource::kMesh;
  config.spacing_m = 0.005;
  config.mesh_file = test::realData("VH_M_Heart.glb");
  if (config.mesh_file.empty()) GTEST_SKIP() << "VH_M_Heart.glb not found; set VISCERA_TEST_DATA";
  expectWoundsOf(bodyOf(config), 3);
}

}  // namespace
}  // namespace viscera::testing
