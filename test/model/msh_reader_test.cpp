// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/msh_reader.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "mesh_files.h"
#include "mesh_samples.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

const char* const kFormat2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const char* const kFormat4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const char* const kNodes2 = "$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 9 9 9\n$EndNodes\n";
const char* const kElements2 = "$Elements\n3\n1 15 2 0 1 10\n2 2 2 0 1 10 20 30\n3 4 2 7 1 10 20 30 40\n$EndElements\n";
const char* const kNodes4 =
    "$Nodes\n2 5 10 50\n0 1 0 1\n10\n0 0 0\n3 1 0 4\n20\n30\n40\n50\n1 0 0\n0 1 0\n0 0 1\n9 9 9\n$EndNodes\n";
const char* const kElements4 = "$Elements\n2 2 1 3\n2 1 2 1\n2 10 20 30\n3 1 4 1\n3 10 20 30 40\n$EndElements\n";

std::string written(const std::string& text) {
  const std::string path = temporaryPath("solid.msh");
  writeFile(path, text);
  return path;
}

std::string refusal(const std::string& text) {
  try {
    readMsh(written(text), 1);
  } catch (const MeshError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without an error:\n" << text;
  return "";
}

void expectRefusals(const std::vector<std::pair<std::string, std::vector<std::string>>>& cases) {
  for (const auto& [text, pieces] : cases) {
    const std::string what = refusal(text);
    EXPECT_NE(what.find("solid.msh'"), std::string::npos) << what;
    for (const std::string& piece : pieces)
      EXPECT_NE(what.find(piece), std::string::npos) << what << "\nlacks " << piece;
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kGood2 = std::string(kFormat2) + kNodes2 + kElements2;
const std::string kGood4 = std::string(kFormat4) + kNodes4 + kElements4;

class MshVersions : public ::testing::TestWithParam<std::string> {};

TEST_P(MshVersions, OneTetrahedronIsReadInMetres) {
  MshReport report;
  const TetrahedraMesh mesh = readMsh(written(GetParam()), 0.5, &report);
  ASSERT_EQ(mesh.tetrahedra.size(), 1u);
  ASSERT_EQ(mesh.positions_m.size(), 4u) << "the node of no tetrahedron is left out";
  EXPECT_EQ(mesh.positions_m[mesh.tetrahedra[0][1]], Vector3d(0.5, 0, 0));
  EXPECT_DOUBLE_EQ(signedVolume(mesh, mesh.tetrahedra[0]), 0.125 / 6);
  EXPECT_EQ(report.tetrahedra, 1u);
  EXPECT_EQ(report.turned, 0u);
  EXPECT_EQ(report.unused_nodes, 1u);
}

TEST_P(MshVersions, SectionsThatSayNothingOfTetrahedraArePassedOver) {
  const std::string text =
      replaced(GetParam(), "$Nodes", "$PhysicalNames\n1\n3 7 \"a b\"\n$EndPhysicalNames\n\n$Nodes") +
      "$NodeData\n1\n2 3 4\n$EndNodeData\n";
  EXPECT_EQ(readMsh(written(text), 1).tetrahedra.size(), 1u);
}

TEST_P(MshVersions, WindowsLineEndsAndBlankLinesDoNotMatter) {
  std::string text;
  for (const char c : GetParam()) text += c == '\n' ? std::string("\r\n\r\n") : std::string(1, c);
  EXPECT_EQ(readMsh(written(text), 1).tetrahedra.size(), 1u);
}

TEST_P(MshVersions, ATetrahedronInsideOutIsTurnedAndCounted) {
  MshReport report;
  const TetrahedraMesh mesh = readMsh(written(replaced(GetParam(), "10 20 30 40\n", "20 10 30 40\n")), 1, &report);
  EXPECT_GT(signedVolume(mesh, mesh.tetrahedra[0]), 0);
  EXPECT_EQ(report.turned, 1u);
  EXPECT_NE(report.text().find("1 of them turned"), std::string::npos) << report.text();
}

TEST_P(MshVersions, WhatIsWrongIsNamedWithItsLine) {
  const std::string& good = GetParam();
  expectRefusals({
      {replaced(good, "10 20 30 40\n", "10 20 30 41\n"), {"line ", "node 41 is not known"}},
      {replaced(good, "10 20 30 40\n", "10 20 30 30\n"), {"flat"}},
      {replaced(good, "0 0 1\n", "1 1 0\n"), {"flat"}},
      {replaced(good, "0 0 1\n", "0 nan 1\n"), {"'nan' is not finite"}},
      {replaced(good, "0 0 1\n", "0 1e999 1\n"), {"'1e999' is not finite"}},
      {replaced(good, "0 0 1\n", "0 up 1\n"), {"'up' is not a number"}},
      {replaced(good, "0 0 1\n", "0 1\n"), {"numbers, has "}},
      {replaced(good, "9 9 9\n", "9 9 9\n60 1 2 3\n"), {"where $EndNodes should stand"}},
      {replaced(good, "$EndElements", "9 4 2 7 1 10 20 30 40\n$EndElements"), {"where $EndElements should stand"}},
      {replaced(good, "10 20 30 40\n$EndElements\n", ""), {"line "}},
      {good + "$Nodes\n0\n$EndNodes\n", {"a second $Nodes"}},
      {good + "nonsense\n", {"'nonsense' where a section should start"}},
      {good + "$Open\n1\n", {"ends within $Open"}},
      {replaced(good, " 0 8", " 1 8"), {"line 2", "binary files are not read"}},
  });
}
INSTANTIATE_TEST_SUITE_P(Both, MshVersions, ::testing::Values(kGood2, kGood4),
                         [](const auto& info) { return info.index == 0 ? "Msh22" : "Msh41"; });

TEST(MshReader, WhatIsNoGmshFileIsRefused) {
  expectRefusals({
      {"", {"line 0", "starts with $MeshFormat"}},
      {"v 0 0 0\n", {"line 1", "starts with $MeshFormat"}},
      {"$MeshFormat\n3.0 0 8\n$EndMeshFormat\n", {"line 2", "version 3.0 is not read", "2.2 or 4.1"}},
      {"$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", {"version 4.0 is not read"}},
      {kFormat2, {"has no $Nodes"}},
      {std::string(kFormat2) + kNodes2, {"has no tetrahedron"}},
      {std::string(kFormat2) + kNodes2 + "$Elements\n1\n1 2 2 0 1 10 20 30\n$EndElements\n", {"has no tetrahedron"}},
      {std::string(kFormat2) + kElements2 + kNodes2, {"line 8", "node 10 is not known"}},
  });
}

TEST(MshReader, ElementsOfOtherShapesInTheSolidAreRefused) {
  for (const char* type : {"5", "6", "11"}) {
    const std::string element = std::string("3 ") + type + " 2 7 1 10 20 30 40\n";
    expectRefusals({{replaced(kGood2, "3 4 2 7 1 10 20 30 40\n", element),
                     {"line 16", std::string("elements of type ") + type + " are not read"}}});
  }
}

TEST(MshReader, ANodeThatStandsTwiceIsRefused) {
  expectRefusals({{replaced(kGood2, "50 9 9 9", "40 9 9 9"), {"line 10", "node 40 stands twice"}},
                  {replaced(kGood4, "30\n40\n50\n", "30\n40\n40\n"), {"node 40 stands twice"}}});
}

TEST(MshReader, ANodeLessThanAnnouncedIsRefused) {
  for (const std::string& text : {replaced(kGood2, "50 9 9 9\n", ""), replaced(kGood4, "\n9 9 9\n", "\n")}) {
    expectRefusals({{text, {"$EndNodes where $Nodes should go on", "counts do not match"}}});
  }
}

TEST(MshReader, CountsOfMsh41AreHeldToTheirSums) {
  expectRefusals({{replaced(kGood4, "2 5 10 50", "2 6 10 50"), {"6 nodes announced, 5 there"}},
                  {replaced(kGood4, "2 2 1 3", "2 3 1 3"), {"3 elements announced, 2 there"}},
                  {replaced(kGood4, "3 1 0 4", "3 1 0 -4"), {"'-4' is not a whole number"}},
                  {replaced(kGood4, "3 1 0 4", "3 1 0 99999999999999999999"), {"is not a whole number"}}});
}

TEST(MshReader, NodesMayHaveParameters) {
  const std::string text = replaced(replaced(kGood4, "3 1 0 4", "3 1 1 4"), "1 0 0\n", "1 0 0 0.5 0.5\n");
  EXPECT_EQ(readMsh(written(text), 1).positions_m.size(), 4u);
  expectRefusals({{replaced(kGood4, "1 0 0\n", "1 0 0 0.5 0.5\n"), {"needs 3 numbers, has 5"}}});
}

TEST(MshReader, FilesThatCannotBeReadAreNamed) {
  EXPECT_THROW(readMsh("/nowhere/solid.msh", 1), MeshError);
  EXPECT_THROW(readMsh(std::filesystem::temp_directory_path().string(), 1), MeshError);
  EXPECT_THROW(readMsh(written(kGood2), 0), MeshError);
  EXPECT_THROW(readMsh(written(kGood2), std::nan("")), MeshError);
}

/// Cut anywhere, a file is refused and nothing worse.
TEST(MshReader, AFileCutAnywhereIsRefused) {
  for (const std::string& good : {kGood2, kGood4}) {
    const size_t end = good.rfind("$EndElements");
    for (size_t length = 0; length < end; length += 7) refusal(good.substr(0, length));
  }
}

}  // namespace
}  // namespace viscera::test
