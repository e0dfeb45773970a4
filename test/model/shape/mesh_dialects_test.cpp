// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "model/mesh_files.h"
#include "model/mesh_samples.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/model/shape/solid.h"

// Meshes as other programs write them.
namespace viscera::test {
namespace {

constexpr double kDialectRounding = 1e-6;  // of a volume: single precision

class MeshDialects : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& name, const std::string& bytes, ImportReport* report = nullptr) {
    return importMesh(folder_.write(name, bytes), 1, report);
  }
  double volume(const std::string& name, const std::string& bytes) { return signedVolume(read(name, bytes)); }
  std::string refusal(const std::string& name, const std::string& bytes) {
    return messageOf<MeshError>([&] { read(name, bytes); });
  }
  TemporaryFolder folder_;
  const TriangleMesh box_ = boxMesh({0, 0, 0}, {1, 1, 1});
};

TEST_F(MeshDialects, BinaryStlWhateverItsHeader) {
  const std::string good = binaryStl(box_);
  const auto counted = [&](uint32_t count) { return std::string(good).replace(80, 4, bytesOf(count)); };
  const std::string solid = std::string(good).replace(0, 5, "solid");
  for (const std::string& bytes : {good, solid, counted(0), counted(UINT32_MAX), counted(7), good + "\r\n"})
    EXPECT_NEAR(volume("box.stl", bytes), 1, kDialectRounding);
  ImportReport report;
  read("long.stl", good + "\r\n", &report);
  EXPECT_TRUE(says(report.appearance_notes.at(0), {"long.stl", "2 bytes after its last triangle"}));
  read("few.stl", counted(7), &report);
  EXPECT_TRUE(says(report.appearance_notes.at(0), {"few.stl", "announces 7 triangles", "12"}));
  EXPECT_TRUE(says(refusal("many.stl", counted(13)), {"many.stl", "truncated", "13 triangles", "12"}));
  EXPECT_TRUE(says(refusal("cut.stl", good.substr(0, good.size() - 20)), {"truncated", "12 triangles", "11"}));
}

TEST_F(MeshDialects, StlOfTextInAnyCaseAndOfSeveralSolids) {
  const std::string good = asciiStl(box_);
  std::string capitals = good;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string& text : {good, capitals, "\n  " + good, good + "\n\n"})
    EXPECT_NEAR(volume("box.stl", text), 1, kDialectRounding);
  std::string two = good + asciiStl(boxMesh({2, 0, 0}, {3, 1, 1}));
  two.replace(two.find("solid part"), 10, "solid left lobe");
  EXPECT_EQ(read("two.stl", two).part_names, (std::vector<std::string>{"left lobe", "part"}));
  EXPECT_TRUE(says(refusal("cut.stl", good.substr(0, good.size() / 2)), {"cut.stl", "truncated", "in line"}));
  EXPECT_TRUE(says(refusal("letter.stl", "solid a\nfacet\nDear sir\n"), {"line 3", "'dear'"}));
}

TEST_F(MeshDialects, StripsOfPly) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "9 0 2 1 3 -1 0 3 2 1\n";  // 021, 123; 032, and 231 reversed
  const TriangleMesh mesh = read("strips.ply", text);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  const std::string good =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
      "6 0 2 1 3 0 2\n";  // 021, 123, 130, 032
  EXPECT_NEAR(volume("strip.ply", good), 1.0 / 6, kDialectRounding);
}

/// Returns a glTF file with its buffer in a separate file.
std::string gltfOf(const std::string& primitive, const std::string& accessors, const std::string& views, size_t bytes) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" +
         primitive + "]}],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
         "],\"buffers\":[{\"uri\":\"b.bin\",\"byteLength\":" + std::to_string(bytes) + "}]}";
}

TEST_F(MeshDialects, GltfWithoutIndicesInStripsAndInterleaved) {
  std::string corners;
  for (const auto& t : box_.triangles)
    for (const uint32_t v : t) corners += bytesOf(box_.positions_m[v]);
  folder_.write("b.bin", corners);
  const std::string view = "{\"buffer\":0,\"byteLength\":" + std::to_string(corners.size()) + "}";
  EXPECT_NEAR(volume("plain.gltf",
                     gltfOf(R"({"attributes":{"POSITION":0}})",
                            R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":36})", view, corners.size())),
              1, kDialectRounding);
  std::string strip;  // of a tetrahedron: 021, 123, 130, 032
  for (const Vector3f& p : {Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0, 0, 1)})
    strip += bytesOf(p) + bytesOf(Vector3f(0, 0, 1));  // with a normal after each
  for (const uint16_t v : {0, 2, 1, 3, 0, 2}) strip += bytesOf(v);
  folder_.write("b.bin", strip);
  EXPECT_NEAR(
      volume("strip.gltf",
             gltfOf(R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"mode":5})",
                    R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
{"bufferView":0,"byteOffset":12,"componentType":5126,"type":"VEC3","count":4},
{"bufferView":1,"componentType":5123,"type":"SCALAR","count":6})",
                    R"({"buffer":0,"byteLength":96,"byteStride":24},{"buffer":0,"byteOffset":96,"byteLength":12})",
                    strip.size())),
      1.0 / 6, kDialectRounding);
}

TEST_F(MeshDialects, ObjWithGroupsEmptyNormalsAndContinuedLines) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n";
  const std::string faces = "f 1/1/ 3/2/ 2/3/\nf 1/1/ 2/2/ 4/3/\nf 1/1/ 4/2/ 3/3/\nf 2/1/ 3/2/ 4/3/\n";
  EXPECT_NEAR(volume("empty.obj", vertices + faces), 1.0 / 6, kDialectRounding);
  EXPECT_NEAR(volume("groups.obj", vertices + "g liver left lobe\ns 1\n" + faces), 1.0 / 6, kDialectRounding);
  const std::string continued = "f 1 3 \\\n2\nf 1 2 4\nf 1 \\\n  4 3\nf 2 3 4\n";
  EXPECT_NEAR(volume("lines.obj", vertices + continued), 1.0 / 6, kDialectRounding);
  EXPECT_NEAR(volume("negative.obj", vertices + "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n"), 1.0 / 6,
              kDialectRounding);
}

TEST_F(MeshDialects, CrossingPartsAreTheirUnionAndInsideOutOnesAreFilled) {
  constexpr double kExact = 1e-3, kCell = 0.05;
  const TriangleMesh other = boxMesh({0.5f, 0.25f, 0.25f}, {1.5f, 0.75f, 0.75f});
  const double united = 1 + 0.5 * 0.25;
  for (const bool same_part : {true, false}) {
    EXPECT_NEAR(voxeliseByMoments(joined(box_, other, same_part), kCell).volumeM3(), united, kExact * united);
    EXPECT_NEAR(voxeliseByMoments(joined(box_, turnedInsideOut(other), false), kCell).volumeM3(), united,
                kExact * united);
  }
}

}  // namespace
}  // namespace viscera::test
