// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <ctime>

#include "mesh_files.h"
#include "mesh_samples.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera::test {
namespace {

/// Files that exceed a number are refused at once; a library that expands them takes longer, or all memory.
constexpr double kImportLimitsAtOnceS = 5;  // s of a processor: reading some MB of JSON takes 0.1 s

constexpr const char* kShape =
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

std::string gltf(const std::string& nodes, const std::string& rest = kShape) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]," + rest;
}

/// Returns nodes 0 .. count - 1, each with the next one as a child `times` times; the last one has the mesh.
std::string chain(int count, int times = 1) {
  std::string nodes;
  for (int i = 1; i < count; ++i) {
    const std::string child = std::to_string(i);
    std::string children = child;
    for (int more = 1; more < times; ++more) children += "," + child;
    nodes += "{\"children\":[" + children + "]},";
  }
  return nodes + "{\"mesh\":0}";
}

class ImportLimitsTest : public ::testing::Test {
 protected:
  void expectRefused(const std::string& name, const std::string& bytes, std::vector<std::string> parts) {
    const std::string path = folder_.write(name, bytes);
    parts.push_back(path);
    const std::clock_t start = std::clock();
    EXPECT_TRUE(says(messageOf<MeshError>([&] { importMesh(path, 1, nullptr, limits_); }), parts));
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kImportLimitsAtOnceS);
  }
  size_t triangles(const std::string& name, const std::string& bytes) {
    return importMesh(folder_.write(name, bytes), 1, nullptr, limits_).triangles.size();
  }

  TemporaryFolder folder_;
  ImportLimits limits_;
};

TEST_F(ImportLimitsTest, GoodFileIsWithinThem) {
  EXPECT_EQ(triangles("good.gltf", gltf(chain(2))), 1u);
}

TEST_F(ImportLimitsTest, NodesNestedDeepAreRefusedBeforeALibraryRecurses) {
  expectRefused("deep.gltf", gltf(chain(100000)), {"100000", "at most 256", "bodies[].import_limits.max_depth"});
}

TEST_F(ImportLimitsTest, SharedChildrenCountOncePerPath) {
  expectRefused("shared.gltf", gltf(chain(31, 2)), {"2147483647", "at most 100000", "import_limits.max_instances"});
  EXPECT_EQ(triangles("few.gltf", gltf(chain(11, 2))), 1024u) << "a thousand of them are";
}

TEST_F(ImportLimitsTest, KeysRaiseThem) {
  const std::string deep = gltf(chain(1000)), shared = gltf(chain(18, 2));
  expectRefused("deep.gltf", deep, {"1000", "max_depth"});
  expectRefused("shared.gltf", shared, {"262143", "max_instances"});
  limits_.max_depth = 4000;  // the library must survive the whole range of the key
  limits_.max_instances = 300000;
  EXPECT_EQ(triangles("deepest.gltf", gltf(chain(4000))), 1u);
  expectRefused("shared.gltf", shared, {"parts"});  // by another limit
}

TEST_F(ImportLimitsTest, CirclesAndStrangersAreCorrupt) {
  expectRefused("circle.gltf", gltf(R"({"children":[1]},{"children":[2]},{"children":[1],"mesh":0})"),
                {"circle", "node 1"});
  expectRefused("self.gltf", gltf(R"({"children":[0],"mesh":0})"), {"cycle", "node 0"});
  expectRefused("stranger.gltf", gltf(R"({"children":[7],"mesh":0})"), {"node 0", "child 7"});
}

TEST_F(ImportLimitsTest, TrianglesAreCountedFromTheAccessors) {
  const std::string huge = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"componentType":5126,"type":"VEC3","count":3000000000}]})";
  expectRefused("huge.gltf", gltf("{\"mesh\":0}", huge),
                {"1000000000", "at most 20000000", "import_limits.max_triangles"});
  limits_.max_triangles = 1000;
  expectRefused("copies.gltf", gltf(chain(12, 2)), {"2048", "at most 1000", "import_limits.max_triangles"});
  limits_.max_triangles = 11;
  const TriangleMesh box = boxMesh(Vector3f(0, 0, 0), Vector3f(1, 1, 1));
  for (const auto& [name, bytes] : std::map<std::string, std::string>{
           {"box.obj", objText(box)}, {"box.stl", binaryStl(box)}, {"box.ply", plyText(box)}}) {
    expectRefused(name, bytes, {"12", "at most 11", "import_limits.max_triangles"});
  }
}

TEST_F(ImportLimitsTest, BytesOfTheFileAndOfItsBuffers) {
  limits_.max_file_mb = 0.001;
  const std::string line = "# a comment of 32 letters .......\n";
  std::string text;
  for (int i = 0; i < 100; ++i) text += line;
  expectRefused("large.obj", text, {"0.0034", "at most 0.001", "import_limits.max_file_mb"});
  limits_ = {};
  const std::string buffers = R"("meshes":[],"buffers":[{"byteLength":4000000000,"uri":"none.bin"}]})";
  expectRefused("buffers.gltf", gltf("{}", buffers), {"4000", "at most 2000", "import_limits.max_file_mb"});
}

TEST_F(ImportLimitsTest, JsonNestedDeepOrBroken) {
  const std::string arrays = "\"extras\":" + std::string(1000000, '[') + std::string(1000000, ']') + ",";
  expectRefused("nested.gltf", gltf(chain(1), arrays + kShape), {"nested more than 1000 levels deep"});
  expectRefused("broken.gltf", R"({"asset":{"version":"2.0"},)", {"invalid at byte"});
  expectRefused("one.gltf", R"({"asset":{"version":"1.0"}})", {"version '1.0'"});
}

TEST_F(ImportLimitsTest, ChunksOfGlbMustBeThere) {
  const TriangleMesh box = boxMesh(Vector3f(0, 0, 0), Vector3f(1, 1, 1));
  const std::string good = glb(box, {{"box", "\"mesh\":0"}});
  EXPECT_EQ(triangles("good.glb", good), 12u);
  std::string huge = good;
  huge.replace(12, 4, bytesOf(uint32_t{0xffffff00}));
  expectRefused("json.glb", huge, {"truncated", "4294967"});
  expectRefused("binary.glb", good.substr(0, good.size() - 8), {"truncated"});
}

TEST_F(ImportLimitsTest, PipesAreNotWaitedFor) {
  ASSERT_EQ(mkfifo(folder_.file("pipe.bin").c_str(), 0600), 0);
  const std::string buffers =
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,
"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"pipe.bin"}]})";
  expectRefused("pipe.gltf", gltf("{\"mesh\":0}", buffers), {"cannot be read"});
}

TEST_F(ImportLimitsTest, OtherFormatsAreReadWhereTheSceneSaysSo) {
  const std::string off = "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  expectRefused("mesh.off", off, {"'.off'", "import_limits.other_formats"});
  limits_.other_formats = true;
  EXPECT_EQ(triangles("mesh.off", off), 1u);
  const std::string lost = "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n";  // assimp reads its last vertex as 2
  expectRefused("lost.off", lost, {"a face refers to a vertex that does not exist"});
}

}  // namespace
}  // namespace viscera::test
