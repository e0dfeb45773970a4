// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// `viscera bench walls`: its organs are those of the CalculiX reference, and its short form reaches its limits.
#include <gtest/gtest.h>

#include <sstream>

#include "bench/suites/walls/walls_references.h"
#include "bench/suites/walls/walls_shapes.h"
#include "bench/suites/walls/walls_suite.h"
#include "support/temporary_folder.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera::bench {
namespace {

/// Largest share by which flat triangles reduce the volume of a curved wall.
constexpr double kFlat = 4e-3;

/// Returns the meshed volume of half the organ, as bench/references/walls.py prints it [cm3].
double meshed_cm3(const std::string& organ) {
  if (organ == "bowl") return 11.524;
  if (organ == "bladder") return 15.109;
  if (organ == "tube") return 9.399;
  if (organ == "ellipsoid") return 12.241;
  if (organ == "torus") return 9.327;
  if (organ == "stomach") return 28.557;
  return 36;
}

TEST(WallsSuite, OrgansAreThoseThatWereMeshed) {
  ASSERT_EQ(organs().size(), kOrgans);
  for (const Organ& organ : organs()) {
    const OrganFile file(organ);
    const TriangleMesh mesh = importMesh(file.path(), 1);
    EXPECT_NEAR(1e6 * signedVolume(mesh) / 2 / meshed_cm3(organ.name), 1, kFlat) << organ.name;
    for (const double nu : {0.3, 0.45, 0.49}) EXPECT_GT(wallsReference(organ.name, nu).mean_m, 0);
  }
  EXPECT_THROW(wallsReference("spleen", 0.3), std::invalid_argument);
}

TEST(WallsSuite, ATubeReachesTheLimits) {
  const test::TemporaryFolder folder;
  SuiteOptions options;
  options.out = folder.path();
  options.short_form = true;
  options.only = "tube";
  std::ostringstream text;
  Report report("walls", options, text);
  wallsSuite(report);
  report.finish();
  EXPECT_FALSE(report.checks().empty());
  EXPECT_EQ(report.missed(), 0) << text.str();
}

}  // namespace
}  // namespace viscera::bench
