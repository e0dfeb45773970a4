// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Volumes of Gmsh files as bodies of a lattice, with their physical groups as parts.
#include <gtest/gtest.h>

#include <algorithm>

#include "model/body_samples.h"
#include "model/shape/msh_writer.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera::test::msh_solid {
namespace {

constexpr double kRounded = 0.01;  // of a volume, for the lattice's cells at its surface
constexpr double kExact = 1e-6;    // of a volume, for the border: coordinates are floats
constexpr int kX = 4, kY = 2, kZ = 2;
constexpr double kCell = 10;                                           // mm
constexpr double kHalf_m3 = 2 * 2 * 2 * kCell * kCell * kCell * 1e-9;  // volume of one half of the block

int nodeAt(int x, int y, int z) {
  return 1 + x + (kX + 1) * (y + (kY + 1) * z);
}

/// Division of a cell: elements of corners 0 to 7, in Gmsh's order of a hexahedron; 8 is its centre.
using Division = std::vector<std::pair<int, std::vector<int>>>;
const std::map<std::string, Division> kDivisions = {{"tetrahedra",
                                                     {{4, {0, 1, 2, 6}},
                                                      {4, {0, 2, 3, 6}},
                                                      {4, {0, 3, 7, 6}},
                                                      {4, {0, 7, 4, 6}},
                                                      {4, {0, 4, 5, 6}},
                                                      {4, {0, 5, 1, 6}}}},
                                                    {"hexahedra", {{5, {0, 1, 2, 3, 4, 5, 6, 7}}}},
                                                    {"prisms", {{6, {0, 1, 2, 4, 5, 6}}, {6, {0, 2, 3, 4, 6, 7}}}},
                                                    {"pyramids",
                                                     {{7, {0, 1, 2, 3, 8}},
                                                      {7, {4, 7, 6, 5, 8}},
                                                      {7, {0, 4, 5, 1, 8}},
                                                      {7, {1, 5, 6, 2, 8}},
                                                      {7, {2, 6, 7, 3, 8}},
                                                      {7, {3, 7, 4, 0, 8}}}}};

/// Returns a block of two halves in mm: "left" of group 3, and group 7 without a name; with an unused triangle and
/// node.
MshMesh block(const Division& left, const Division& right) {
  MshMesh mesh;
  mesh.names = {{3, "left half"}};
  for (int z = 0; z <= kZ; ++z)
    for (int y = 0; y <= kY; ++y)
      for (int x = 0; x <= kX; ++x) mesh.nodes.push_back(kCell * Vector3d(x, y, z));
  mesh.elements.push_back({2, 9, {1, 2, 6}});
  for (int z = 0; z < kZ; ++z)
    for (int y = 0; y < kY; ++y)
      for (int x = 0; x < kX; ++x) {
        std::vector<int> corners = {
            nodeAt(x, y, z),     nodeAt(x + 1, y, z),     nodeAt(x + 1, y + 1, z),     nodeAt(x, y + 1, z),
            nodeAt(x, y, z + 1), nodeAt(x + 1, y, z + 1), nodeAt(x + 1, y + 1, z + 1), nodeAt(x, y + 1, z + 1)};
        mesh.nodes.push_back(kCell * (Vector3d(x, y, z) + Vector3d::Constant(0.5)));
        corners.push_back(static_cast<int>(mesh.nodes.size()));
        for (const auto& [type, of] : x < kX / 2 ? left : right) {
          MshElement element{type, x < kX / 2 ? 3 : 7, {}};
          for (const int corner : of) element.nodes.push_back(corners[static_cast<size_t>(corner)]);
          mesh.elements.push_back(element);
        }
      }
  return mesh;
}
MshMesh block(const std::string& of) {
  return block(kDivisions.at(of), kDivisions.at(of));
}

double massOf(const Body& body) {
  double kg = 0;
  for (const float m : strengths(body).mass_kg) kg += static_cast<double>(m);
  return kg;
}

class MshSolid : public ::testing::Test {
 protected:
  Body bodyOf(const std::string& msh, const std::string& keys) const {
    folder_.write("solid.msh", msh);
    return buildModel(loadScene(folder_.write("scene.yaml",
                                              "bodies: [{name: organ, source: mesh, mesh_file: solid.msh, "
                                              "unit_scale_m: 0.001, spacing_m: 0.003" +
                                                  keys + "}]")))
        .bodies.at(0);
  }
  TriangleMesh meshOf(const std::string& msh) const {
    return importMesh(folder_.write("solid.msh", msh), 0.001, &report_);
  }
  std::string refusal(const std::string& msh) const {
    return messageOf<MeshError>([&] { (void)meshOf(msh); });
  }
  void expectBlock(const std::string& msh) const {
    const Body body = bodyOf(msh, "");
    EXPECT_EQ(openEdges(body.skin.mesh), 0u);
    EXPECT_NEAR(signedVolume(body.skin.mesh), 2 * kHalf_m3, kExact * kHalf_m3) << "without the border within";
    EXPECT_NEAR(massOf(body), 1060 * 2 * kHalf_m3, kRounded * 1060 * 2 * kHalf_m3);
    for (const std::string& part : body.lattice.part_names) {
      const Body one = bodyOf(msh, ", parts: [{part: '" + part + "', density_kg_per_m3: 2120}]");
      EXPECT_NEAR(massOf(one) - massOf(body), 1060 * kHalf_m3, kRounded * 1060 * kHalf_m3) << part;
    }
  }
  TemporaryFolder folder_;
  mutable ImportReport report_;
};

TEST_F(MshSolid, EveryVersionIsALatticeWithItsGroupsAsParts) {
  for (const auto& [version, binary] : std::vector<std::pair<double, bool>>{
           {1, false}, {2.2, false}, {2.2, true}, {4, false}, {4, true}, {4.1, false}, {4.1, true}}) {
    SCOPED_TRACE(::testing::Message() << "MSH " << version << (binary ? " binary" : " ASCII"));
    const std::string msh = mshText(block("tetrahedra"), version, binary);
    expectBlock(msh);
    const TriangleMesh mesh = meshOf(msh);
    EXPECT_EQ(mesh.part_names, (std::vector<std::string>{version == 1 ? "3" : "left half", "7"}));
    EXPECT_NEAR(signedVolume(mesh), 2 * kHalf_m3, kExact * kHalf_m3);
    ASSERT_EQ(report_.appearance_notes.size(), 1u);
    EXPECT_TRUE(says(report_.appearance_notes[0], {"solid.msh: MSH ", "96 tetrahedra; ignored: 1 triangles"}));
    EXPECT_EQ(report_.parts, 2);
  }
}

TEST_F(MshSolid, EveryFirstOrderElementIsRead) {
  for (const auto& [name, division] : kDivisions) {
    SCOPED_TRACE(name);
    expectBlock(mshText(block(name), 2.2, false));
  }
  expectBlock(mshText(block(kDivisions.at("hexahedra"), kDivisions.at("prisms")), 4.1, true));
}

TEST_F(MshSolid, ElementsInsideOutAreTurned) {
  for (const auto& [name, division] : kDivisions) {
    SCOPED_TRACE(name);
    MshMesh mesh = block(name);
    for (Vector3d& node : mesh.nodes) node.x() = -node.x();  // a mirror image
    EXPECT_NEAR(signedVolume(meshOf(mshText(mesh, 2.2, false))), 2 * kHalf_m3, kExact * kHalf_m3);
  }
}

/// Nodes of the elements of second order on the unit cube, in the order of Gmsh's manual (Node ordering).
struct SecondOrder {
  int type;
  double volume;
  std::vector<std::array<double, 3>> nodes;
};
const std::vector<SecondOrder> kSecondOrder = {
    {11,
     1.0 / 6,
     {{0, 0, 0},
      {1, 0, 0},
      {0, 1, 0},
      {0, 0, 1},
      {.5, 0, 0},
      {.5, .5, 0},
      {0, .5, 0},
      {0, 0, .5},
      {0, .5, .5},
      {.5, 0, .5}}},
    {17, 1, {{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},  {0, 0, 1},  {1, 0, 1},  {1, 1, 1},
             {0, 1, 1},  {.5, 0, 0}, {0, .5, 0}, {0, 0, .5}, {1, .5, 0}, {1, 0, .5}, {.5, 1, 0},
             {1, 1, .5}, {0, 1, .5}, {.5, 0, 1}, {0, .5, 1}, {1, .5, 1}, {.5, 1, 1}}},
    {18,
     .5,
     {{0, 0, 0},
      {1, 0, 0},
      {0, 1, 0},
      {0, 0, 1},
      {1, 0, 1},
      {0, 1, 1},
      {.5, 0, 0},
      {0, .5, 0},
      {0, 0, .5},
      {.5, .5, 0},
      {1, 0, .5},
      {0, 1, .5},
      {.5, 0, 1},
      {0, .5, 1},
      {.5, .5, 1}}},
    {19,
     1.0 / 3,
     {{0, 0, 0},
      {1, 0, 0},
      {1, 1, 0},
      {0, 1, 0},
      {.5, .5, 1},
      {.5, 0, 0},
      {0, .5, 0},
      {.25, .25, .5},
      {1, .5, 0},
      {.75, .25, .5},
      {.5, 1, 0},
      {.75, .75, .5},
      {.25, .75, .5}}}};

MshMesh alone(const SecondOrder& element, const std::vector<std::array<double, 3>>& centres) {
  MshMesh mesh;
  MshElement one{element.type, 3, {}};
  for (const auto* nodes : {&element.nodes, &centres})
    for (const auto& n : *nodes) {
      mesh.nodes.push_back(100 * Vector3d(n[0], n[1], n[2]));
      one.nodes.push_back(static_cast<int>(mesh.nodes.size()));
    }
  mesh.elements = {one};
  return mesh;
}

TEST_F(MshSolid, ElementsOfSecondOrderAreDividedAtTheirNodes) {
  for (const SecondOrder& element : kSecondOrder) {
    SCOPED_TRACE(element.type);
    MshMesh mesh = alone(element, {});
    const TriangleMesh border = meshOf(mshText(mesh, 4.1, true));
    EXPECT_EQ(openEdges(border), 0u);
    EXPECT_NEAR(signedVolume(border), 1e-3 * element.volume, 1e-3 * kExact);
    EXPECT_NEAR(massOf(bodyOf(mshText(mesh, 2.2, false), "")), 1.06 * element.volume, kRounded * 1.06 * element.volume);
  }
  SecondOrder full = kSecondOrder[1];  // its faces have nodes too, one of them raised
  full.type = 12;
  const TriangleMesh border = meshOf(mshText(
      alone(full, {{.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}, {1, .5, .5}, {.5, 1, .5}, {.5, .5, 1.3}, {.5, .5, .5}}), 4.1,
      false));
  EXPECT_NEAR(signedVolume(border), 1e-3 * 1.05, 1e-3 * kExact) << "a pyramid over the middles of its edges more";
}

TEST_F(MshSolid, VolumesWithoutAGroupAreOnePart) {
  MshMesh mesh = block("tetrahedra");
  for (MshElement& element : mesh.elements) element.group = 0;
  for (const double version : {1.0, 2.2, 4.0, 4.1})
    EXPECT_EQ(meshOf(mshText(mesh, version, false)).part_names, std::vector<std::string>{"part"});
}

TEST_F(MshSolid, ItIsASurfaceTooAndPlacedAsMeshesAre) {
  const std::string msh = mshText(block("hexahedra"), 4.1, true);
  const Body body = bodyOf(msh, ", structure: surface, centered: true");
  EXPECT_FALSE(body.network->triangles.empty());
  Eigen::AlignedBox3d box;
  for (const Vector3f& p : body.skin.mesh.positions_m) box.extend(p.cast<double>());
  EXPECT_LT(box.center().norm(), 1e-8);
  EXPECT_NEAR(box.sizes().x(), 0.04, 1e-8);
  const Body enclosed = bodyOf(msh, ", fill: enclosed");
  EXPECT_NEAR(massOf(enclosed), 1060 * 2 * kHalf_m3, kRounded * 1060 * 2 * kHalf_m3);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const char* const kNodes2 = "$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 9 9 9\n$EndNodes\n";
const std::string kFormat2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kGood2 =
    kFormat2 + kNodes2 + "$Elements\n3\n1 15 2 0 1 10\n2 2 2 0 1 10 20 30\n3 4 2 7 1 10 20 30 40\n$EndElements\n";
const std::string kGood4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 5 10 50\n0 1 0 1\n10\n0 0 0\n3 1 0 4\n20\n30\n40\n50\n1 0 0\n"
    "0 1 0\n0 0 1\n9 9 9\n$EndNodes\n$Elements\n2 2 1 3\n2 1 2 1\n2 10 20 30\n3 1 4 1\n3 10 20 30 40\n$EndElements\n";

TEST_F(MshSolid, WhatIsWrongIsNamedWithItsLine) {
  using Pieces = std::vector<std::string>;
  for (const std::string& good : {kGood2, kGood4}) {
    for (const auto& [msh, pieces] : std::vector<std::pair<std::string, Pieces>>{
             {replaced(good, "10 20 30 40\n", "10 20 30 41\n"), {"solid.msh': line ", "node 41 does not exist"}},
             {replaced(good, "10 20 30 40\n", "10 20 30 30\n"), {"flat"}},
             {replaced(good, "0 0 1\n", "1 1 0\n"), {"flat"}},
             {replaced(good, "0 0 1\n", "0 nan 1\n"), {"'nan' is not finite"}},
             {replaced(good, "0 0 1\n", "0 1e999 1\n"), {"'1e999' is not finite"}},
             {replaced(good, "0 0 1\n", "0 up 1\n"), {"'up' is not a number"}},
             {replaced(good, "0 0 1\n", "0 1\n"), {"'$EndNodes' is not a number"}},
             {replaced(good, "9 9 9\n", "9 9 9\n60 1 2 3\n"), {"'60' instead of $EndNodes"}},
             {replaced(good, "$EndElements", "9 4 2 7 1 10 20 30 40\n$EndElements"), {"instead of $EndElements"}},
             {replaced(good, "10 20 30 40\n$EndElements\n", ""), {"the file ends within"}},
             {good + "$Nodes\n0 0 0 0\n$EndNodes\n", {"odes"}},
             {good + "nonsense\n", {"'nonsense' where a section should start"}},
             {good + "$Open\n1\n", {"ends before $EndOpen"}}})
      EXPECT_TRUE(says(refusal(msh), pieces)) << msh;
  }
  for (const auto& [msh, pieces] : std::vector<std::pair<std::string, Pieces>>{
           {"v 0 0 0\n", {"line 1", "'v' where a section should start"}},
           {"$Nodes\n", {"line 1", "must start with $MeshFormat or $NOD"}},
           {"$MeshFormat\n3.0 0 8\n$EndMeshFormat\n", {"line 2", "version 3 is not supported", "4 and 4.1"}},
           {kFormat2, {"has no $Nodes"}},
           {kFormat2 + kNodes2 + "$Elements\n1\n1 2 2 0 1 10 20 30\n$EndElements\n",
            {"no tetrahedron, hexahedron, prism or pyramid", "it has only 1 triangles"}},
           {replaced(kGood2, "3 4 2 7 1", "3 29 2 7 1"), {"line 16", "type 29 are not supported", "second order"}},
           {replaced(kGood2, "50 9 9 9", "40 9 9 9"), {"line 10", "node 40 is defined twice"}},
           {replaced(kGood2, "$EndElements", "4 4 2 8 1 10 20 30 40\n$EndElements"), {"instead of $EndElements"}},
           {replaced(replaced(kGood2, "$Elements\n3", "$Elements\n4"), "$EndElements",
                     "4 4 2 8 1 10 20 30 40\n$EndElements"),
            {"elements overlap at the face of nodes 10, 20, 30", "one physical group"}},
           {replaced(kGood4, "2 5 10 50", "2 6 10 50"), {"6 nodes announced, 5 found"}},
           {replaced(kGood4, "2 2 1 3", "2 3 1 3"), {"3 elements announced, 2 found"}},
           {replaced(kGood4, "3 1 0 4", "3 1 0 -4"), {"-4 is negative"}},
           {replaced(kGood4, "3 1 0 4", "3 1 0 99999999999999999999"), {"is not a whole number"}}})
    EXPECT_TRUE(says(refusal(msh), pieces)) << msh;
  EXPECT_TRUE(says(messageOf<MeshError>([&] {
                     (void)bodyOf(mshText(block("tetrahedra"), 2.2, false), ", import_limits: {max_triangles: 10}");
                   }),
                   {"triangles", "import_limits.max_triangles"}));
}

TEST_F(MshSolid, NodesMayHaveParametersAndLinesEndAsInWindows) {
  const std::string text = replaced(replaced(kGood4, "3 1 0 4", "2 1 1 4"), "1 0 0\n0 1 0\n0 0 1\n9 9 9\n",
                                    "1 0 0 .5 .5\n0 1 0 .5 .5\n0 0 1 .5 .5\n9 9 9 .5 .5\n");
  std::string in_windows;
  for (const char c : text) in_windows += c == '\n' ? std::string("\r\n\r\n") : std::string(1, c);
  for (const std::string& msh : {text, in_windows}) EXPECT_EQ(meshOf(msh).triangles.size(), 4u);
}

/// A file that is cut at any point is refused, without a crash.
TEST_F(MshSolid, AFileCutAnywhereIsRefused) {
  for (const auto& [version, binary] :
       std::vector<std::pair<double, bool>>{{1, false}, {2.2, true}, {4, true}, {4.1, false}}) {
    const std::string good = mshText(block("hexahedra"), version, binary);
    for (size_t length = 0; length + 12 < good.size(); length += 61)
      EXPECT_NE(refusal(good.substr(0, length)), "nothing was thrown") << version << " " << length;
  }
}

}  // namespace
}  // namespace viscera::test::msh_solid
