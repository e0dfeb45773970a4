// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/mesh_import.h"

#include <limits>

#include "mesh_files.h"
#include "mesh_samples.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

const Vector3f kLow(0.01f, -0.02f, 0.03f), kHigh(0.06f, 0.05f, 0.13f);
constexpr double kBoxVolume = 0.05 * 0.07 * 0.1;  // m3
constexpr double kMeshImportRounding = 1e-6;      // relative: seven digits in the files

TriangleMesh importBytes(const std::string& name, const std::string& bytes, ImportReport* report = nullptr) {
  const std::string path = temporaryPath(name);
  writeFile(path, bytes);
  return importMesh(path, 1, report);
}

/// Returns the message of the MeshError of an import; fails the test if there is none.
std::string importErrorOf(const std::string& path) {
  try {
    importMesh(path, 1);
  } catch (const MeshError& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

void expectRefused(const std::string& name, const std::string& bytes, const std::string& reason) {
  const std::string path = temporaryPath(name);
  writeFile(path, bytes);
  const std::string message = importErrorOf(path);
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(MeshImport, EveryFormatGivesTheSameClosedBox) {
  const TriangleMesh box = boxMesh(kLow, kHigh);
  const std::map<std::string, std::string> files = {
      {"box.obj", objText(box)}, {"ascii.stl", asciiStl(box)},   {"binary.stl", binaryStl(box)},
      {"box.ply", plyText(box)}, {"binary.ply", binaryPly(box)}, {"box.glb", glb(box, {{"box", "\"mesh\":0"}})}};
  for (const auto& [name, bytes] : files) {
    const TriangleMesh read = importBytes(name, bytes);
    EXPECT_NEAR(signedVolume(read), kBoxVolume, kMeshImportRounding * kBoxVolume) << name;
    EXPECT_EQ(read.positions_m.size(), 8u) << name << ": equal positions are welded";
    EXPECT_EQ(read.triangles.size(), 12u) << name;
    EXPECT_EQ(openEdges(read), 0u) << name;
    EXPECT_EQ(read.parts.size(), 12u) << name;
  }
}

TEST(MeshImport, UnitScaleMultipliesLengths) {
  const std::string path = temporaryPath("box.obj");
  writeFile(path, objText(boxMesh(kLow, kHigh)));
  EXPECT_NEAR(signedVolume(importMesh(path, 0.001)), 1e-9 * kBoxVolume, 1e-9 * kMeshImportRounding * kBoxVolume);
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(importMesh(path, scale), MeshError);
  }
}

TEST(MeshImport, PartsKeepTheirNamesInObj) {
  TriangleMesh two = joined(boxMesh(kLow, kHigh), sphereMesh({1, 0, 0}, 0.1f, 8), false);
  two.part_names = {"septum", "aorta"};
  const TriangleMesh read = importBytes("two.obj", objText(two));
  EXPECT_EQ(read.part_names, two.part_names);
  EXPECT_EQ(read.parts.front(), 0);
  EXPECT_EQ(read.parts.back(), 1);
}

TEST(MeshImport, NodesOfGlbPlaceTheirMeshAndNameItsCopies) {
  const std::vector<GlbNode> nodes = {{"here", "\"mesh\":0"},
                                      {"there", "\"mesh\":0,\"translation\":[2,0,0],\"scale\":[2,1,1]"},
                                      {"there", "\"mesh\":0,\"translation\":[0,5,0]"}};
  const TriangleMesh read = importBytes("nodes.glb", glb(boxMesh(kLow, kHigh), nodes));
  const std::vector<std::string> names = {"here", "there", "there_2"};
  EXPECT_EQ(read.part_names, names);
  EXPECT_NEAR(signedVolume(read), (1 + 2 + 1) * kBoxVolume, 4 * kMeshImportRounding * kBoxVolume);
  EXPECT_FLOAT_EQ(read.positions_m.at(8).x(), 2 + 2 * kLow.x());
}

TEST(MeshImport, AMirroredNodeStillFacesOutward) {
  const TriangleMesh read =
      importBytes("mirror.glb", glb(boxMesh(kLow, kHigh), {{"mirrored", "\"mesh\":0,\"scale\":[-1,1,1]"}}));
  EXPECT_NEAR(signedVolume(read), kBoxVolume, kMeshImportRounding * kBoxVolume);
}

TEST(MeshImport, PointsLinesAndPartsWithoutTrianglesAreDroppedAndCounted) {
  ImportReport report;
  const std::vector<GlbNode> nodes = {
      {"dots", "\"mesh\":1"}, {"box", "\"mesh\":0"}, {"dash", "\"mesh\":2"}, {"empty", "\"extras\":{}"}};
  const TriangleMesh read = importBytes("stray.glb", glb(boxMesh(kLow, kHigh), nodes), &report);
  EXPECT_EQ(read.part_names, std::vector<std::string>{"box"});
  EXPECT_EQ(read.positions_m.size(), 8u);
  EXPECT_EQ(report.parts, 1);
  EXPECT_EQ(report.stray_points, 2);
  EXPECT_EQ(report.stray_lines, 1);
  EXPECT_EQ(report.parts_dropped, 2);
  EXPECT_EQ(report.text(),
            "1 part imported; dropped: 2 points, 1 lines, 0 degenerate triangles, 2 parts without triangles");
}

TEST(MeshImport, DegenerateTrianglesAreDroppedAndCounted) {
  ImportReport report;
  const std::string text = objText(boxMesh(kLow, kHigh)) + "f 1 1 2\nf 3 3 3\nv 0 0 0\nv 1 1 1\nv 2 2 2\nf 9 10 11\n";
  const TriangleMesh read = importBytes("flat.obj", text, &report);
  EXPECT_EQ(read.triangles.size(), 12u);
  EXPECT_EQ(read.positions_m.size(), 8u) << "vertices that only dropped triangles used are gone";
  EXPECT_EQ(report.degenerate_triangles, 3);
}

TEST(MeshImport, QuadsAreTriangulated) {
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const TriangleMesh read = importBytes("cube.obj", cube);
  EXPECT_EQ(read.triangles.size(), 12u);
  EXPECT_NEAR(signedVolume(read), 1, kMeshImportRounding);
}

TEST(MeshImport, PlyMayHoldOtherTypesOrderAndPolygons) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment a cube\nelement vertex 8\nproperty double z\nproperty uchar red\n"
      "property double x\nproperty double y\nelement face 6\nproperty float quality\n"
      "property list uchar uint vertex_index\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
      "0 9 0 0\n0 9 1 0\n0 9 1 1\n0 9 0 1\n1 9 0 0\n1 9 1 0\n1 9 1 1\n1 9 0 1\n"
      "0.5 4 3 2 1 0\n0.5 4 4 5 6 7\n0.5 4 0 1 5 4\n0.5 4 1 2 6 5\n0.5 4 2 3 7 6\n0.5 4 3 0 4 7\n0 1";
  const TriangleMesh read = importBytes("cube.ply", text);
  EXPECT_EQ(read.triangles.size(), 12u);
  EXPECT_NEAR(signedVolume(read), 1, kMeshImportRounding);
  expectRefused("word.ply", text.substr(0, text.size() - 1) + "one", "in edge 0: 'one' is not a number");
  expectRefused("header.ply", "ply\nformat ascii 1.0\nelement vertex\nend_header\n", "invalid element");
  expectRefused("type.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n1\n",
                "invalid property");
}

TEST(MeshImport, BigEndianPlyIsRead) {
  TriangleMesh box = boxMesh(kLow, kHigh);
  std::string bytes = binaryPly(box);
  bytes.replace(bytes.find("little"), 6, "big");
  const auto turn = [&bytes](size_t& at, size_t count) {
    std::reverse(bytes.begin() + static_cast<long>(at), bytes.begin() + static_cast<long>(at + count));
    at += count;
  };
  size_t at = bytes.find("end_header\n") + 11;
  for (int i = 0; i < 8 * 3; ++i) turn(at, 4);
  for (int f = 0; f < 12; ++f) {
    ++at;  // the length of the list is one byte
    for (int c = 0; c < 3; ++c) turn(at, 4);
  }
  EXPECT_NEAR(signedVolume(importBytes("big.ply", bytes)), kBoxVolume, kMeshImportRounding * kBoxVolume);
}

TEST(MeshImport, WhatIsNoFileIsRefused) {
  const std::string missing = temporaryPath("missing.stl");
  std::filesystem::remove(missing);
  EXPECT_NE(importErrorOf(missing).find("no such file"), std::string::npos);
  EXPECT_NE(importErrorOf(std::filesystem::path(missing).parent_path().string()).find("is a directory"),
            std::string::npos);
  for (const char* name : {"empty.obj", "empty.stl", "empty.ply", "empty.glb"}) expectRefused(name, "", "is empty");
}

TEST(MeshImport, GarbageIsRefused) {
  std::string garbage;
  for (uint32_t i = 0, state = 1; i < 5000; ++i, state = state * 1664525u + 1013904223u) {
    garbage += static_cast<char>(state >> 24);
  }
  for (const char* name : {"garbage.obj", "garbage.stl", "garbage.ply", "garbage.glb", "garbage.gltf", "garbage.xyz"}) {
    expectRefused(name, garbage, "");
  }
  expectRefused("text.obj", "This is a letter, not a mesh.\nKind regards\n", "");
}

TEST(MeshImport, TruncatedFilesAreRefused) {
  const TriangleMesh sphere = sphereMesh({0, 0, 0}, 1, 8);
  const std::map<std::string, std::string> files = {{"cut.glb", glb(sphere, {{"s", "\"mesh\":0"}})},
                                                    {"cut.stl", binaryStl(sphere)},
                                                    {"ascii.ply", plyText(sphere)},
                                                    {"binary.ply", binaryPly(sphere)}};
  constexpr size_t kCuts = 40;
  for (const auto& [name, bytes] : files) {
    for (size_t cut = 0; cut < kCuts; ++cut) expectRefused(name, bytes.substr(0, 8 + cut * bytes.size() / kCuts), "");
  }
}

TEST(MeshImport, AFileWithoutTrianglesIsRefused) {
  expectRefused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1\np 2\n", "");
  expectRefused("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\n", "no triangle");
  expectRefused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle");
  expectRefused("dots.glb", glb(boxMesh(kLow, kHigh), {{"dots", "\"mesh\":1"}}), "no triangle");
}

TEST(MeshImport, NonFiniteCoordinatesAreRefused) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    TriangleMesh mesh = boxMesh(kLow, kHigh);
    mesh.positions_m[3].y() = bad;
    expectRefused("bad.stl", binaryStl(mesh), "non-finite");
    expectRefused("bad.ply", plyText(mesh), "non-finite");
    expectRefused("bad.glb", glb(mesh, {{"box", "\"mesh\":0"}}), "non-finite");
  }
  TriangleMesh huge = boxMesh(kLow, kHigh);
  huge.positions_m[5].x() = 3e38f;
  expectRefused("huge.glb", glb(huge, {{"box", "\"mesh\":0,\"scale\":[10,1,1]"}}), "non-finite");
}

TEST(MeshImport, AFaceThatRefersToNothingIsRefused) {
  expectRefused("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\n", "");
}

TEST(MeshImport, TheRealHeartComesWithItsParts) {
  const std::string path = realData("VH_M_Heart.glb");
  if (path.empty()) GTEST_SKIP() << "VH_M_Heart.glb not found; set VISCERA_TEST_DATA";
  ImportReport report;
  const TriangleMesh heart = importMesh(path, 1, &report);
  EXPECT_EQ(report.parts, 14);
  EXPECT_EQ(heart.triangles.size() + static_cast<size_t>(report.degenerate_triangles), 164119u);
  EXPECT_EQ(heart.part_names.back(), "VH_M_heart_left_ventricle");
}

}  // namespace
}  // namespace viscera::test
