// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "math/union_find.h"
#include "model/mesh_samples.h"
#include "model/shape/organ/gallbladder_variant.h"
#include "model/shape/organ/phantom.h"
#include "model/solid_probe.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

constexpr double kNatural = 0.08;  // m, length of the gallbladder
constexpr int kSeeds = 100;
constexpr double kSheath_m = 0.0004;  ///< fillet that counts as the strand
/// Cells [m] that find every strand by their centres: the thinnest free one has a radius of 1.3 mm, half the diagonal
/// of a cell. In fat and walls strands own their cells.
constexpr double kCells = 0.0015;
/// Spacing of samples [m] that measure ducts and vessels.
constexpr double kStep = 0.0014;

enum Label { kCysticArtery = 1, kHepaticArtery, kCysticDuct, kHepaticDuct, kBileDuct, kInfundibulum, kGallbladder };

Phantom natural(int seed) {
  return gallbladderPhantom(kNatural, 1, seed);
}

/// Labels (0: none, else 1 + part) of a field around the triangle of ducts and liver.
Solid sampledTriangle(const Phantom& phantom) {
  Solid out = boxSolid({-0.008, -0.028, -0.056}, {0.048, 0.042, 0.060}, kStep);
  for (int z = 0; z < out.cells.z(); ++z)
    for (int y = 0; y < out.cells.y(); ++y)
      for (int x = 0; x < out.cells.x(); ++x) {
        const LabelledDistance at = phantom.field(out.origin_m + kStep * Vector3d(x + 0.5, y + 0.5, z + 0.5));
        out.labels[out.index(x, y, z)] = at.distance_m < 0 ? at.part + 1 : 0;
      }
  return out;
}

/// Returns whether one connected piece of some parts contains both of two parts.
bool joins(const Solid& samples, const std::set<int>& some, int from, int to) {
  Solid only = samples;
  for (uint16_t& label : only.labels)
    if (some.count(label) == 0) label = 0;
  const Pieces pieces = findPieces(only, true);
  std::set<int> with_from, with_to;
  for (int z = 0; z < only.cells.z(); ++z)
    for (int y = 0; y < only.cells.y(); ++y)
      for (int x = 0; x < only.cells.x(); ++x) {
        if (only.label(x, y, z) == from) with_from.insert(pieces.at({x, y, z}));
        if (only.label(x, y, z) == to) with_to.insert(pieces.at({x, y, z}));
      }
  for (const int piece : with_from)
    if (with_to.count(piece) > 0) return true;
  return false;
}

struct Extent {
  Eigen::AlignedBox3d box;
  double volume_m3 = 0;
};

Extent extentOf(const Solid& solid, int label) {
  Extent out;
  const double h = solid.spacing_m;
  for (int z = 0; z < solid.cells.z(); ++z)
    for (int y = 0; y < solid.cells.y(); ++y)
      for (int x = 0; x < solid.cells.x(); ++x) {
        if (solid.label(x, y, z) != label) continue;
        out.box.extend(solid.origin_m + h * Vector3d(x + 0.5, y + 0.5, z + 0.5));
        out.volume_m3 += h * h * h;
      }
  return out;
}

/// Returns the parts that a ray meets, from the front backwards, without repetitions.
std::vector<std::string> partsBehind(const Phantom& phantom, double x_m, double z_m) {
  std::vector<std::string> out;
  for (double y = -0.03; y < 0.02; y += 1e-4) {
    const LabelledDistance at = phantom.field({x_m, y, z_m});
    if (at.distance_m < 0 && (out.empty() || out.back() != phantom.part_names[at.part]))
      out.push_back(phantom.part_names[at.part]);
  }
  return out;
}

/// Returns the length of a part along a ray from the front [m].
double depthOf(const Phantom& phantom, int label, double x_m, double z_m) {
  constexpr double kRay = 5e-5;
  double out = 0;
  for (double y = -0.03; y < 0.02; y += kRay) {
    const LabelledDistance at = phantom.field({x_m, y, z_m});
    if (at.distance_m < 0 && at.part + 1 == label) out += kRay;
  }
  return out;
}

/// Returns the length of tissue along a ray to the first empty point [m].
double wallAlong(const Phantom& phantom, const Vector3d& from_m, const Vector3d& direction) {
  constexpr double kRay = 1e-5;
  double wall_m = 0;
  for (double s = 0; s < 0.03; s += kRay) {
    if (phantom.field(from_m + s * direction).distance_m < 0) {
      wall_m += kRay;
    } else if (wall_m > 0) {
      break;
    }
  }
  return wall_m;
}

/// Every part is there, the tissue is one piece, and ducts and arteries join what they should and nothing else.
void expectWhole(int seed) {
  SCOPED_TRACE(seed);
  const Phantom phantom = natural(seed);
  const GallbladderVariant variant = gallbladderVariant(seed);
  const Solid cells =
      voxelise(phantom.field_for_cells(kCells), phantom.part_names, phantom.min_m, phantom.max_m, kCells);
  EXPECT_EQ(countPieces(cells), 1u);
  EXPECT_EQ(std::set<uint16_t>(cells.labels.begin(), cells.labels.end()).size(), phantom.part_names.size() + 1);
  const std::set<int> ducts = {kGallbladder, kInfundibulum, kHepaticDuct, kBileDuct};
  std::set<int> with_duct = ducts;
  with_duct.insert(kCysticDuct);
  EXPECT_TRUE(joins(cells, with_duct, kGallbladder, kBileDuct));
  EXPECT_TRUE(joins(cells, with_duct, kHepaticDuct, kBileDuct));
  EXPECT_FALSE(joins(cells, ducts, kGallbladder, kBileDuct)) << "past the cystic duct";
  EXPECT_TRUE(joins(cells, {kHepaticArtery, kCysticArtery}, kHepaticArtery, kCysticArtery));
  EXPECT_TRUE(joins(cells, {kGallbladder, kInfundibulum, kCysticArtery}, kGallbladder, kCysticArtery));
  EXPECT_FALSE(joins(cells, {kGallbladder, kInfundibulum, kHepaticArtery}, kGallbladder, kHepaticArtery));
  const double length = extentOf(cells, kCysticDuct).box.diagonal().norm();
  EXPECT_GT(length, variant.short_duct ? 0.008 : 0.018);
  EXPECT_LT(length, variant.short_duct ? 0.019 : 0.040);
}

/// The anatomies by name, and drawn ones.
TEST(GallbladderPhantom, IsWhole) {
  for (int seed = 0; seed < 8; ++seed) expectWhole(seed);
}

TEST(GallbladderPhantom, IsWholeForAHundredSeeds) {
  for (int seed = 8; seed < kSeeds; ++seed) expectWhole(seed);
}

TEST(GallbladderPhantom, VariantsAreDrawnWithTheirShares) {
  std::map<std::string, int> features;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const GallbladderVariant variant = gallbladderVariant(seed);
    features["short"] += variant.short_duct ? 1 : 0;
    features["front"] += variant.artery_in_front ? 1 : 0;
    features["two"] += variant.two_arteries ? 1 : 0;
    features["inflamed"] += variant.inflamed ? 1 : 0;
  }
  for (const char* feature : {"short", "front", "two", "inflamed"}) {
    EXPECT_GT(features[feature], 5) << feature;
    EXPECT_LT(features[feature], 40) << feature;
  }
}

TEST(GallbladderPhantom, HasItsSizesAndFollowsItsLengthAndWallScale) {
  const Phantom usual = natural(0);
  const Solid solid = voxelise(usual.field, usual.part_names, usual.min_m, usual.max_m, 0.0015);
  Eigen::AlignedBox3d box = extentOf(solid, kGallbladder).box;
  box.extend(extentOf(solid, kInfundibulum).box);
  EXPECT_NEAR(box.sizes().z() + solid.spacing_m, kNatural, 0.0015);
  EXPECT_NEAR(extentOf(solid, kGallbladder).box.sizes().y(), 0.031, 0.004);
  EXPECT_NEAR(extentOf(sampledTriangle(usual), kCysticDuct).box.diagonal().norm(), 0.025, 0.004);
  double duct_m = 0;
  for (double z_m = -0.036; z_m < -0.027; z_m += 0.0002)
    duct_m = std::max(duct_m, depthOf(usual, kCysticDuct, 0.021, z_m));
  EXPECT_NEAR(duct_m, 0.0035 + kSheath_m, kSheath_m + 1e-4) << "with up to two sheaths";

  const Vector3d middle(-0.009, -0.009, 0.012);  // in the lumen
  EXPECT_NEAR(wallAlong(usual, middle, -Vector3d::UnitX()), 0.0025, 0.0002);
  EXPECT_NEAR(wallAlong(gallbladderPhantom(kNatural, 0.5, 0), middle, -Vector3d::UnitX()), 0.00125, 0.0002);
  EXPECT_NEAR(wallAlong(natural(4), middle, -Vector3d::UnitX()), 0.004, 0.0003);
  EXPECT_NEAR(usual.walls.front().thickness_m, 0.0015, 1e-12);

  const Phantom large = gallbladderPhantom(2 * kNatural, 1, 7), small = natural(7);
  EXPECT_NEAR(large.field({0.02, -0.02, -0.05}).distance_m, 2 * small.field({0.01, -0.01, -0.025}).distance_m, 1e-12);
  EXPECT_EQ(large.max_m, 2 * small.max_m);
}

TEST(GallbladderPhantom, VariantsDifferWhereTheirNamesSay) {
  const auto first = [](int seed, double x_m, double z_m) { return partsBehind(natural(seed), x_m, z_m).at(0); };
  EXPECT_EQ(first(0, 0.020, -0.0315), "cystic_duct");
  EXPECT_EQ(first(4, 0.020, -0.0315), "peritoneum") << "fat covers the duct";
  EXPECT_EQ(first(0, 0.029, -0.020), "common_hepatic_duct");
  EXPECT_EQ(first(2, 0.029, -0.020), "hepatic_artery");
  EXPECT_GT(extentOf(sampledTriangle(natural(3)), kCysticArtery).volume_m3,
            1.3 * extentOf(sampledTriangle(natural(0)), kCysticArtery).volume_m3);
  EXPECT_LT(extentOf(sampledTriangle(natural(1)), kCysticDuct).box.diagonal().norm(),
            0.7 * extentOf(sampledTriangle(natural(0)), kCysticDuct).box.diagonal().norm());
  EXPECT_NE(natural(5).field({0, 0, 0}).distance_m, natural(6).field({0, 0, 0}).distance_m);
  EXPECT_EQ(natural(5).field({0, 0, 0}).distance_m, natural(5).field({0, 0, 0}).distance_m);
}

TEST(GallbladderPhantom, ItsSkinIsClosedWithTwoSurfacesInside) {
  for (const int seed : {0, 4, 11}) {
    SCOPED_TRACE(seed);
    const Phantom phantom = natural(seed);
    const TriangleMesh skin = extractSkin(phantom.field, phantom.part_names, phantom.min_m, phantom.max_m, 0.00125);
    EXPECT_EQ(openEdges(skin), 0u);
    UnionFind joined(skin.positions_m.size());
    for (const auto& t : skin.triangles) {
      joined.unite(t[0], t[1]);
      joined.unite(t[1], t[2]);
    }
    const std::vector<uint32_t> surface_of = std::move(joined).all();
    EXPECT_EQ(std::set<uint32_t>(surface_of.begin(), surface_of.end()).size(), 3u);  // lumens of gallbladder and duct
  }
}

TEST(GallbladderPhantom, StrandsThinnerThanACellAreOnePieceOfCells) {
  const Phantom phantom = natural(0);
  for (const double spacing_m : {0.002, 0.0025, 0.004}) {
    const Solid solid = voxeliseByMoments(phantom.field_for_cells(spacing_m), phantom.part_names, phantom.min_m,
                                          phantom.max_m, spacing_m);
    for (const int label : {kCysticDuct, kHepaticArtery, kCysticArtery}) {
      Solid only = solid;
      for (uint16_t& other : only.labels) other = other == label ? 1 : 0;
      EXPECT_EQ(countPieces(only), 1u) << phantom.part_names[label - 1] << " at " << spacing_m;
    }
  }
}

TEST(GallbladderPhantom, ItsSectionsFillItWithoutOverlap) {
  const std::vector<std::string> liver = {"liver", "liver_capsule"}, fat = {"peritoneum", "fat"};
  for (const int seed : {0, 2, 4}) {
    SCOPED_TRACE(seed);
    const Phantom whole = natural(seed);
    std::vector<std::string> rest;
    for (const std::string& part : whole.part_names)
      if (std::count(liver.begin(), liver.end(), part) + std::count(fat.begin(), fat.end(), part) == 0)
        rest.push_back(part);
    std::vector<Phantom> sections;
    for (const auto& parts : {liver, fat, rest}) sections.push_back(gallbladderPhantom(kNatural, 1, seed, parts));
    std::array<size_t, 3> within{};
    constexpr double kCoarse = 2 * kStep;
    for (double x = -0.02; x < 0.045; x += kCoarse)
      for (double y = -0.03; y < 0.012; y += kCoarse)
        for (double z = -0.06; z < 0.02; z += kCoarse) {
          const Vector3d at(x, y, z);
          size_t count = 0;
          for (size_t s = 0; s < sections.size(); ++s) {
            const LabelledDistance in = sections[s].field(at);
            if (in.distance_m >= 0) continue;
            ++count;
            ++within[s];
            const std::vector<std::string>& own = s == 0 ? liver : s == 1 ? fat : rest;
            EXPECT_EQ(std::count(own.begin(), own.end(), whole.part_names[in.part]), 1);
          }
          EXPECT_EQ(count, whole.field(at).distance_m < 0 ? 1u : 0u) << at.transpose();
        }
    for (const size_t count : within) EXPECT_GT(count, 100u);
  }
}

TEST(GallbladderPhantom, RefusesPartsOfASection) {
  EXPECT_THROW(gallbladderPhantom(kNatural, 1, 0, {"liver"}), SceneError);
  EXPECT_THROW(gallbladderPhantom(kNatural, 1, 0, {"spleen"}), SceneError);
}

TEST(GallbladderPhantom, StaysWithinItsBox) {
  for (const int seed : {0, 2, 4, 23}) {
    const Phantom phantom = natural(seed);
    const Vector3d margin(0.01, 0.01, 0.01);
    const Solid solid =
        voxelise(phantom.field, phantom.part_names, phantom.min_m - margin, phantom.max_m + margin, 0.002);
    Eigen::AlignedBox3d box;
    for (size_t label = 1; label <= phantom.part_names.size(); ++label)
      box.extend(extentOf(solid, static_cast<int>(label)).box);
    EXPECT_TRUE((box.min().array() >= phantom.min_m.array()).all()) << seed;
    EXPECT_TRUE((box.max().array() <= phantom.max_m.array()).all()) << seed;
  }
}

TEST(GallbladderPhantom, RefusesParametersOutOfRange) {
  for (const double bad : {0.009, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(gallbladderPhantom(bad, 1, 0), SceneError);
    EXPECT_THROW(gallbladderPhantom(kNatural, bad == 1.1 ? 2.1 : bad, 0), SceneError);
  }
  EXPECT_THROW(gallbladderPhantom(kNatural, 1, -1), SceneError);
  EXPECT_THROW(gallbladderPhantom(kNatural, 1, kMostPhantomSeed + 1), SceneError);
}

}  // namespace
}  // namespace viscera::test
