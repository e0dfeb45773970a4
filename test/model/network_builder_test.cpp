// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_builder.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "mesh_samples.h"
#include "support/lattices.h"
#include "support/networks.h"
#include "viscera/model/body/elasticity.h"

namespace viscera::test {
namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kThickness_m = 2e-3;
constexpr double kSinglePrecision =
    2e-6;  ///< relative: vertices of a TriangleMesh are floats, areas differ by a few ulp
constexpr double kNetworkBuilderRounding = 1e-12;  ///< relative: sums of doubles

MaterialConfig rubber() {
  MaterialConfig material;
  material.young_modulus_pa = 1e6;
  material.density_kg_per_m3 = 1200;
  return material;
}

double massOf(const SpringNetwork& network) {
  return std::accumulate(network.masses_kg.begin(), network.masses_kg.end(), 0.0);
}

std::vector<uint32_t> valences(const SpringNetwork& network) {
  std::vector<uint32_t> out(network.positions_m.size());
  for (const NetworkSpring& spring : network.springs) {
    ++out[spring.a];
    ++out[spring.b];
  }
  return out;
}

const NetworkSpring& springOf(const SpringNetwork& network, uint32_t a, uint32_t b) {
  for (const NetworkSpring& spring : network.springs) {
    if (spring.a == a && spring.b == b) return spring;
  }
  throw std::out_of_range("no such spring");
}

/// Returns the energy of the springs with every node moved from its rest position to `at` [J].
template <class At>
double energyOf(const SpringNetwork& network, At at) {
  double energy_j = 0;
  for (const NetworkSpring& spring : network.springs) {
    const double length_m = (at(network.positions_m[spring.b]) - at(network.positions_m[spring.a])).norm();
    energy_j += 0.5 * spring.stiffness_n_per_m * std::pow(length_m - spring.rest_length_m, 2);
  }
  return energy_j;
}

double areaOf(const SpringNetwork& network) {
  double area_m2 = 0;
  for (const auto& t : network.triangles) {
    const Vector3d& a = network.positions_m[t[0]];
    area_m2 += 0.5 * (network.positions_m[t[1]] - a).cross(network.positions_m[t[2]] - a).norm();
  }
  return area_m2;
}

SpringNetwork sheet(int rows, int columns, double bending_ratio = 0) {
  return membraneNetwork(sheetMesh(rows, columns, kSpacing_m), rubber(), kThickness_m, bending_ratio);
}

/// Returns two triangles that share the edge 1 2.
TriangleMesh twoTriangles() {
  TriangleMesh mesh;
  mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  mesh.parts = {0, 0};
  mesh.part_names = {"pair"};
  return mesh;
}

TEST(PlainMeshes, InnerNodesOfASheetHaveSixNeighborsAtOneSpacing) {
  const SpringNetwork network = sheet(8, 9);
  EXPECT_EQ(network.springs.size(), 8u * 8 + 7u * 9 + 7u * 8);  // along the rows; between rows: one kind each
  EXPECT_EQ(network.triangles.size(), 2u * 7 * 8);
  const std::vector<uint32_t> valence = valences(network);
  for (uint32_t row = 1; row < 7; ++row) {
    for (uint32_t column = 1; column < 8; ++column) EXPECT_EQ(valence[row * 9 + column], 6u) << row << ' ' << column;
  }
  EXPECT_EQ(*std::min_element(valence.begin(), valence.end()), 2u);
  for (const NetworkSpring& spring : network.springs) {
    EXPECT_NEAR(spring.rest_length_m, kSpacing_m, kSinglePrecision * kSpacing_m);
  }
}

TEST(PlainMeshes, ASheetFacesUpAroundTheOrigin) {
  const TriangleMesh mesh = sheetMesh(5, 4, kSpacing_m);
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : mesh.positions_m) box.extend(p);
  EXPECT_LT(box.center().norm(), kSinglePrecision * kSpacing_m);
  EXPECT_EQ(box.sizes().z(), 0);
  for (const Vector3f& normal : vertexNormals(mesh)) EXPECT_GT(normal.z(), 0.999f);
}

/// Returns the largest sum of k over mass of a node [1/s2], which determines the stable substep.
double stiffestNode(const SpringNetwork& network) {
  std::vector<double> sums(network.positions_m.size());
  for (const NetworkSpring& spring : network.springs) {
    sums[spring.a] += spring.stiffness_n_per_m;
    sums[spring.b] += spring.stiffness_n_per_m;
  }
  double stiffest = 0;
  for (size_t i = 0; i < sums.size(); ++i) stiffest = std::max(stiffest, sums[i] / network.masses_kg[i]);
  return stiffest;
}

TEST(PlainMeshes, StraightSidesKeepTheAreaAndCostAFifthOfTheSubstep) {
  const TriangleMesh mesh = sheetMesh(9, 8, kSpacing_m, SheetSides::kStraight);
  for (size_t row = 0; row < 9; ++row) {
    EXPECT_NEAR(mesh.positions_m[row * 8].x(), -3.5 * kSpacing_m, kSinglePrecision * kSpacing_m);
    EXPECT_NEAR(mesh.positions_m[row * 8 + 7].x(), 3.5 * kSpacing_m, kSinglePrecision * kSpacing_m);
  }
  const SpringNetwork straight = membraneNetwork(mesh, rubber(), kThickness_m), toothed = sheet(9, 8);
  EXPECT_NEAR(areaOf(straight), areaOf(toothed), kSinglePrecision * areaOf(toothed));
  const double substep = std::sqrt(stiffestNode(toothed) / stiffestNode(straight));
  EXPECT_NEAR(substep, 0.8, 0.005);
}

TEST(PlainMeshes, ASheetOfASizeComesAsNearAsWholeTrianglesDo) {
  for (const double spacing_m : {0.01, 0.0137, 0.05}) {
    const SheetGrid grid = sheetGrid(0.3, 0.2, spacing_m);
    EXPECT_NEAR((grid.columns - 1) * spacing_m, 0.3, 0.5 * spacing_m + 1e-9);
    EXPECT_NEAR((grid.rows - 1) * std::sqrt(0.75) * spacing_m, 0.2, 0.5 * spacing_m);
  }
}

TEST(PlainMeshes, ABallIsClosedRoundAndHasTwelveNodesOfFiveNeighbors) {
  const TriangleMesh mesh = ballMesh(0.05, kSpacing_m);
  EXPECT_EQ(openEdges(mesh), 0u);
  for (const Vector3f& p : mesh.positions_m) EXPECT_NEAR(p.norm(), 0.05, kSinglePrecision * 0.05);
  const double pi = std::acos(-1.0);
  EXPECT_GT(signedVolume(mesh), 0.97 * 4 / 3 * pi * 0.05 * 0.05 * 0.05);
  const SpringNetwork network = membraneNetwork(mesh, rubber(), kThickness_m);
  std::map<uint32_t, int> nodes;
  for (const uint32_t valence : valences(network)) ++nodes[valence];
  EXPECT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[5], 12);
  EXPECT_NEAR(network.meanLength(), kSpacing_m, 0.1 * kSpacing_m);
}

TEST(MembraneNetwork, WeighsWhatItsAreaWeighs) {
  for (const TriangleMesh& mesh : {sheetMesh(7, 6, kSpacing_m), ballMesh(0.05, kSpacing_m)}) {
    const SpringNetwork network = membraneNetwork(mesh, rubber(), kThickness_m);
    const double expected_kg = 1200 * kThickness_m * areaOf(network);
    EXPECT_NEAR(massOf(network), expected_kg, kNetworkBuilderRounding * expected_kg);
  }
}

/// Plane stress of a sheet with nu = 1/3: the energy per area of a strain is t E / (2 (1 - nu^2)) (exx^2 + eyy^2 +
/// 2 nu exx eyy) + t E / (4 (1 + nu)) gxy^2.
TEST(MembraneNetwork, AnEquilateralSheetHasYoungsModulusInEveryDirection) {
  // Without the border, where edges have one triangle and thus half the stiffness: all of it is in the energy.
  const SpringNetwork network = sheet(12, 14);
  const double area_m2 = areaOf(network), et = rubber().young_modulus_pa * kThickness_m, nu = 1.0 / 3;
  constexpr double kStrain = 1e-6;  // energies are of second order: the relative error is of the order of the strain
  constexpr double kSecondOrder =
      1e-4;  // for single-precision positions: lengths are rounded to 1e-8 of the strain's 1e-2
  for (const Vector3d& strain :
       {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(1, 1, 0), Vector3d(0, 0, 1), Vector3d(1, -nu, 0)}) {
    const Vector3d e = kStrain * 100 * strain;  // xx, yy, gamma xy
    const auto at = [&](const Vector3d& p) {
      return Vector3d(p.x() * (1 + e.x()) + 0.5 * e.z() * p.y(), p.y() * (1 + e.y()) + 0.5 * e.z() * p.x(), p.z());
    };
    const double expected_j =
        area_m2 * (et / (2 * (1 - nu * nu)) * (e.x() * e.x() + e.y() * e.y() + 2 * nu * e.x() * e.y()) +
                   et / (4 * (1 + nu)) * e.z() * e.z());
    EXPECT_NEAR(energyOf(network, at), expected_j, 3 * kSecondOrder * expected_j) << strain.transpose();
  }
}

TEST(MembraneNetwork, EveryEdgeIsOneSpringAsStiffAsTheTrianglesAtIt) {
  const SpringNetwork network = membraneNetwork(twoTriangles(), rubber(), kThickness_m);
  ASSERT_EQ(network.springs.size(), 5u);
  const double et = 1e6 * kThickness_m;
  EXPECT_DOUBLE_EQ(springOf(network, 1, 2).stiffness_n_per_m, et * (0.5 + 0.5) / 2);  // l^2 = 2
  EXPECT_DOUBLE_EQ(springOf(network, 0, 1).stiffness_n_per_m, et * 0.5 / 1);
  EXPECT_DOUBLE_EQ(springOf(network, 1, 2).rest_length_m, std::sqrt(2.0));
  EXPECT_TRUE(std::is_sorted(network.springs.begin(), network.springs.end(), [](const auto& s, const auto& t) {
    return std::make_pair(s.a, s.b) < std::make_pair(t.a, t.b);
  }));
}

TEST(MembraneNetwork, BendingSpringsJoinTheCornersOppositeToAnInnerEdge) {
  const SpringNetwork network = membraneNetwork(twoTriangles(), rubber(), kThickness_m, 0.25);
  ASSERT_EQ(network.springs.size(), 6u);
  const NetworkSpring& bending = springOf(network, 0, 3);
  EXPECT_DOUBLE_EQ(bending.stiffness_n_per_m, 0.25 * springOf(network, 1, 2).stiffness_n_per_m);
  EXPECT_DOUBLE_EQ(bending.rest_length_m, std::sqrt(2.0));
  const SpringNetwork whole = sheet(6, 6, 0.1), plain = sheet(6, 6);
  const size_t inner_edges = plain.springs.size() - openEdges(sheetMesh(6, 6, kSpacing_m));
  EXPECT_EQ(whole.springs.size(), plain.springs.size() + inner_edges);
  EXPECT_EQ(whole.meanLength(), plain.meanLength()) << "edges alone count";
}

TEST(MembraneNetwork, OnlyBendingSpringsResistAFold) {
  const auto folded = [](const Vector3d& p) { return p.y() > 0 ? Vector3d(p.x(), 0, p.y()) : p; };
  // A sheet with a row of nodes on the crease: no edge crosses it.
  const SpringNetwork plain = sheet(7, 6), stiff = sheet(7, 6, 0.1);
  const double stretch_j = energyOf(plain, [](const Vector3d& p) { return Vector3d(1.01 * p); });
  EXPECT_LT(energyOf(plain, folded), 1e-9 * stretch_j);
  EXPECT_GT(energyOf(stiff, folded), stretch_j);
}

/// Two right triangles with legs of 1 m: the corners opposite to their edge are sqrt(2) cos(angle / 2) apart.
TEST(MembraneNetwork, AFoldTakesTheEnergyOfItsBendingSpringToTheDigit) {
  constexpr double kRatio = 0.25;
  const TriangleMesh mesh = twoTriangles();
  const SpringNetwork network = membraneNetwork(mesh, rubber(), kThickness_m, kRatio);
  const double k = kRatio * springOf(network, 1, 2).stiffness_n_per_m;
  const Vector3d hinge = mesh.positions_m[1].cast<double>(),
                 edge = (mesh.positions_m[2].cast<double>() - hinge).normalized();
  for (const double angle : {0.1, M_PI / 2, 3.0}) {
    const Eigen::AngleAxisd turn(angle, edge);
    const Vector3d corner = mesh.positions_m[3].cast<double>();
    const double j =
        energyOf(network, [&](const Vector3d& p) { return p == corner ? Vector3d(hinge + turn * (p - hinge)) : p; });
    const double shorter_m = std::sqrt(2.0) * (1 - std::cos(angle / 2));
    EXPECT_NEAR(j / (0.5 * k * shorter_m * shorter_m), 1, 1e-9) << angle;
  }
}

TEST(MembraneNetwork, AnEdgeOfThreeTrianglesIsOneSpringWithABendingSpringPerPair) {
  TriangleMesh mesh = twoTriangles();
  mesh.positions_m.push_back({0.5f, 0.5f, 1});
  mesh.triangles.push_back({1, 2, 4});
  mesh.parts.push_back(0);
  const SpringNetwork network = membraneNetwork(mesh, rubber(), kThickness_m, 0.5);
  EXPECT_EQ(network.springs.size(), 7u + 3u);
  const double area_m2 = 0.5 + 0.5 + 0.5 * std::sqrt(2.0);
  EXPECT_DOUBLE_EQ(springOf(network, 1, 2).stiffness_n_per_m, 1e6 * kThickness_m * area_m2 / 2);
}

TEST(MembraneNetwork, TrianglesWithoutAreaAreLeftOutAndCounted) {
  TriangleMesh mesh = twoTriangles();
  mesh.positions_m.push_back({2, 0, 0});
  for (const std::array<uint32_t, 3>& flat : {std::array<uint32_t, 3>{0, 1, 4}, {0, 0, 2}})
    mesh.triangles.push_back(flat);
  mesh.parts.assign(4, 0);
  size_t degenerate = 0;
  const SpringNetwork network = membraneNetwork(mesh, rubber(), kThickness_m, 0, &degenerate);
  EXPECT_EQ(degenerate, 2u);
  EXPECT_EQ(network.triangles.size(), 2u);
  EXPECT_EQ(network.springs.size(), 5u);
  EXPECT_EQ(network.masses_kg[4], 0);
}

void expectAsImplicit(const Body& body) {
  const Lattice& lattice = body.lattice;
  const SpringNetwork network = latticeNetwork(body);
  ASSERT_TRUE(network.of_lattice);
  ASSERT_EQ(network.springs.size(), lattice.springs());
  const MaterialConfig& m = body.material;
  const Elasticity e = elasticity(m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, lattice.spacing_m);
  const auto quarter = static_cast<float>(e.spring_n_per_m / 4), half = static_cast<float>(e.spring_n_per_m / 2),
             eighth = static_cast<float>(e.cell_mass_kg / 8);
  const NetworkLinks links = linksOf(network);
  for (const uint32_t slot : lattice.active_slots) {
    EXPECT_EQ(static_cast<float>(network.masses_kg[slot]),
              static_cast<float>(massEighths(lattice.nodes[slot])) * eighth);
    for (uint32_t l = links.starts[slot]; l < links.starts[slot + 1]; ++l) {
      const layout::Link& link = links.links[l];
      const uint32_t s = link.lattice_spring;
      ASSERT_LT(s, layout::kSpringsPerNode);
      ASSERT_EQ(link.far, static_cast<uint32_t>(lattice.neighborSlot(slot, s)));
      const auto count = static_cast<float>(springCount(lattice.nodes[slot], s));
      EXPECT_EQ(link.stiffness, count * (isAxial(s) ? quarter : half));
      EXPECT_EQ(link.prestrain_m2, 0);
    }
  }
}

TEST(LatticeNetwork, SpringsAndMassesAreThoseOfTheCountsToTheBit) {
  for (const Weights weights : {Weights::kCell, Weights::kPaper}) expectAsImplicit(boxBody({5, 6, 3}, 0.0037, weights));
  expectAsImplicit(blobBody(300, 0.0041, 5));
}

TEST(LatticeNetwork, PartsKeepTheirOwnStrengthsToTheBit) {
  Body body = boxBody({4, 4, 4}, 0.005);
  body.lattice.part_names = {"box", "lid"};
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.cell_labels[slot] && body.lattice.nodeAt(slot).z() == 3) body.lattice.cell_labels[slot] = 2;
  }
  body.parts = {{"lid", 7e4, 0.25, 2000}};
  const Strengths table = strengths(body);
  const SpringNetwork network = latticeNetwork(body);
  for (const uint32_t slot : body.lattice.active_slots) {
    EXPECT_EQ(static_cast<float>(network.masses_kg[slot]), table.mass_kg[slot]);
  }
  for (const NetworkSpring& spring : network.springs) {
    const bool from_a = spring.lattice_spring % 2 == 0;
    const size_t i = (from_a ? spring.a : spring.b) * kSpringPairs + spring.lattice_spring / 2;
    EXPECT_EQ(static_cast<float>(spring.stiffness_n_per_m), table.spring_n_per_m[i]);
  }
}

TEST(LatticeNetwork, SheetsOfOneCellGetSpringsAgainstBendingAlongTheirPlane) {
  const Body sheet_body = boxBody({6, 5, 1}, kSpacing_m);
  const SpringNetwork network = latticeNetwork(sheet_body, 0.5);
  const size_t added = network.springs.size() - sheet_body.lattice.springs();
  // Nodes 7 x 6 x 2: straight on 5 x 6 and 7 x 4, along two diagonals 5 x 4 each, on both sides.
  EXPECT_EQ(added, 2u * (5 * 6 + 7 * 4 + 2 * 5 * 4));
  for (const NetworkSpring& spring : network.springs) {
    if (spring.lattice_spring != layout::kNoLatticeSpring) continue;
    const Vector3d d = network.positions_m[spring.b] - network.positions_m[spring.a];
    EXPECT_EQ(d.z(), 0);
    EXPECT_DOUBLE_EQ(spring.rest_length_m, d.norm());
    const double straight = d.cwiseAbs().minCoeff() == 0 && (d.x() == 0 || d.y() == 0) ? 2 : 2 * std::sqrt(2.0);
    EXPECT_NEAR(d.norm(), straight * kSpacing_m, 1e-12);
  }
}

TEST(LatticeNetwork, ThickPartsGetNoSpringsAgainstBending) {
  const Body block = boxBody({6, 5, 2}, kSpacing_m);
  EXPECT_EQ(latticeNetwork(block, 1).springs.size(), block.lattice.springs());
}

TEST(LatticeNetwork, ASpringAgainstBendingIsItsShareOfTheWeakerOfTheTwoItSpans) {
  constexpr double kRatio = 0.3;
  const SpringNetwork network = latticeNetwork(boxBody({6, 5, 1}, kSpacing_m), kRatio);
  const auto stiffnessBetween = [&](const Vector3d& from, const Vector3d& to) {
    for (const NetworkSpring& spring : network.springs) {
      const Vector3d &a = network.positions_m[spring.a], &b = network.positions_m[spring.b];
      const bool is_it = (a - from).norm() + (b - to).norm() < 1e-9 || (b - from).norm() + (a - to).norm() < 1e-9;
      if (is_it) return spring.stiffness_n_per_m;
    }
    return 0.0;
  };
  for (const NetworkSpring& spring : network.springs) {
    if (spring.lattice_spring != layout::kNoLatticeSpring) continue;
    const Vector3d &a = network.positions_m[spring.a], &b = network.positions_m[spring.b], middle = 0.5 * (a + b);
    const double weaker = std::min(stiffnessBetween(a, middle), stiffnessBetween(middle, b));
    ASSERT_GT(weaker, 0);
    EXPECT_DOUBLE_EQ(spring.stiffness_n_per_m, kRatio * weaker);
  }
}

TEST(LatticeNetwork, BendingSpringsRaiseWhatFoldingASheetTakes) {
  const Body body = boxBody({6, 6, 1}, kSpacing_m);
  // Onto a cylinder around y, of ten times the thickness; the middle of the sheet keeps its length.
  const auto curved = [](const Vector3d& p) {
    constexpr double kRadius_m = 10 * kSpacing_m;
    const double r = kRadius_m + p.z() - 0.5 * kSpacing_m;
    return Vector3d(r * std::sin(p.x() / kRadius_m), p.y(), r * std::cos(p.x() / kRadius_m));
  };
  const SpringNetwork stiff = latticeNetwork(body, 1), plain = latticeNetwork(body);
  EXPECT_GT(energyOf(stiff, curved), 2 * energyOf(plain, curved));
}

TEST(Renumbering, KeepsEveryNodeSpringAndTriangle) {
  const SpringNetwork network = sheet(9, 11, 0.1);
  std::vector<uint32_t> slot_of;
  const SpringNetwork moved = renumbered(network, &slot_of);
  EXPECT_EQ(moved.positions_m.size(), 128u);
  ASSERT_EQ(moved.springs.size(), network.springs.size());
  std::multiset<std::tuple<uint32_t, uint32_t, double, double>> before, after;
  for (const NetworkSpring& s : network.springs) {
    const auto ends = std::minmax(slot_of[s.a], slot_of[s.b]);
    before.insert({ends.first, ends.second, s.stiffness_n_per_m, s.rest_length_m});
  }
  for (const NetworkSpring& s : moved.springs) {
    ASSERT_LT(s.a, s.b);
    after.insert({s.a, s.b, s.stiffness_n_per_m, s.rest_length_m});
  }
  EXPECT_EQ(before, after);
  for (uint32_t i = 0; i < 99; ++i) {
    EXPECT_EQ(moved.positions_m[slot_of[i]], network.positions_m[i]);
    EXPECT_EQ(moved.masses_kg[slot_of[i]], network.masses_kg[i]);
  }
  EXPECT_NEAR(areaOf(moved), areaOf(network), kNetworkBuilderRounding * areaOf(network));
}

TEST(Renumbering, LeavesOutWhatIsNoNode) {
  TriangleMesh mesh = twoTriangles();
  mesh.positions_m.insert(mesh.positions_m.begin(), Vector3f(9, 9, 9));
  for (auto& t : mesh.triangles) {
    for (uint32_t& v : t) ++v;
  }
  Body body;
  const std::vector<uint32_t> slot_of = adoptNetwork(membraneNetwork(mesh, rubber(), kThickness_m), body);
  EXPECT_EQ(slot_of[0], UINT32_MAX);
  EXPECT_EQ(body.lattice.active_slots, (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(body.network->positions_m.size(), size_t{layout::kBrickSlots});
}

/// Slots of the ends of a spring are close: within a few bricks, whatever the size of the cloth.
TEST(Renumbering, BringsNeighborsTogether) {
  const SpringNetwork moved = renumbered(sheet(64, 64));
  size_t beside = 0;
  for (const NetworkSpring& s : moved.springs) beside += s.a / layout::kBrickSlots == s.b / layout::kBrickSlots;
  EXPECT_GT(static_cast<double>(beside) / static_cast<double>(moved.springs.size()), 0.75);
}

TEST(SlotsOfNetwork, BitsHoldTheNumberOfLinks) {
  const Body body = clothBody(9, 11, kSpacing_m);
  const Lattice& lattice = body.lattice;
  EXPECT_EQ(lattice.active_slots.size(), 99u);
  EXPECT_EQ(lattice.nodes.size(), 128u);
  EXPECT_NEAR(lattice.spacing_m, kSpacing_m, kSinglePrecision * kSpacing_m);
  const std::vector<uint32_t> valence = valences(*body.network);
  for (uint32_t slot = 0; slot < 128; ++slot) {
    EXPECT_EQ(lattice.nodes[slot].lo & layout::kValenceMask, valence[slot]);
    EXPECT_EQ(massEighths(lattice.nodes[slot]) > 0, slot < 99);
    EXPECT_EQ(lattice.neighborSlot(slot, 0), -1);
  }
}

TEST(GraphBody, HasHubsLeavesIslandsDoublesAndSpringsWithoutLength) {
  const Body body = graphBody(1234, 4000, 3);
  const SpringNetwork& network = *body.network;
  EXPECT_EQ(network.springs.size(), 4000u);
  const std::vector<uint32_t> valence = valences(network);
  EXPECT_GE(*std::max_element(valence.begin(), valence.end()), 200u);
  EXPECT_GT(std::count(valence.begin(), valence.end(), 1u), 50);
  size_t doubles = 0, empty = 0;
  for (size_t i = 1; i < network.springs.size(); ++i) {
    doubles += network.springs[i].a == network.springs[i - 1].a && network.springs[i].b == network.springs[i - 1].b;
    empty += network.springs[i].rest_length_m == 0;
  }
  EXPECT_GE(doubles, 4u);
  EXPECT_GE(empty, 3u);
}

TEST(GraphBody, ComesInEverySize) {
  for (const size_t nodes : kSizes) {
    const Body body = graphBody(nodes, 3 * nodes, 7);
    EXPECT_EQ(body.lattice.active_slots.size(), nodes);
    EXPECT_EQ(body.network->springs.size(), nodes == 1 ? 0u : 3 * nodes);
  }
}

TEST(LinksOf, AreAntisymmetricAndInTheOrderOfTheSprings) {
  const Body body = graphBody(300, 900, 11);
  const NetworkLinks links = linksOf(*body.network);
  for (size_t i = 0; i < links.ends.size(); ++i) {
    const layout::SpringEnds& ends = links.ends[i];
    const layout::Link &a = links.links[ends.link_a], &b = links.links[ends.link_b];
    EXPECT_EQ(a.far, ends.b);
    EXPECT_EQ(b.far, ends.a);
    EXPECT_EQ(a.stiffness, b.stiffness);
    EXPECT_EQ(a.offset_length.x, -b.offset_length.x);
    EXPECT_EQ(a.offset_length.w, b.offset_length.w);
    EXPECT_EQ(a.prestrain_m2, 0) << "at rest";
    EXPECT_GE(ends.link_a, links.starts[ends.a]);
    EXPECT_LT(ends.link_a, links.starts[ends.a + 1]);
  }
}

TEST(LinksOf, PrestrainIsTheSquareThatTheEndsAreLongerThanTheSpring) {
  SpringNetwork network;
  network.positions_m = {{0, 0, 0}, {0.03, 0, 0.04}};
  network.masses_kg = {1, 1};
  network.springs = {{0, 1, 10, 0.04}};
  EXPECT_FLOAT_EQ(linksOf(network).links[0].prestrain_m2, 0.0009f);
}

}  // namespace
}  // namespace viscera::test
