// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>

#include "model/mesh_files.h"
#include "model/mesh_samples.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera::test {
namespace {

constexpr double kGltfRounding = 1e-6;  // of a volume: single precision

class GltfExtensions : public ::testing::Test {
 protected:
  std::string refusal(const std::string& json) {
    const std::string path = folder_.write("shape.gltf", json);
    return messageOf<MeshError>([&] { importMesh(path, 1); });
  }
  TemporaryFolder folder_;
};

/// Returns a buffer embedded in the JSON.
std::string dataUri(const std::string& bytes) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[three >> shift & 63];
  }
  for (size_t k = 0; k < (3 - bytes.size() % 3) % 3; ++k) text[text.size() - 1 - k] = '=';
  return R"({"byteLength":)" + std::to_string(bytes.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
         text + "\"}";
}

/// Returns a box of 1 m with corners and triangles in a file.
std::string boxGltf(const std::string& uri, const std::string& extensions = "") {
  return R"({"asset":{"version":"2.0"},)" + extensions +
         R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[
{"bufferView":0,"componentType":5126,"type":"VEC3","count":8},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":36}],
"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":144}],
"buffers":[{"byteLength":240,"uri":")" +
         uri + "\"}]}";
}

std::string boxBytes() {
  const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
  std::string bytes;
  for (const Vector3f& p : box.positions_m) bytes += bytesOf(p);
  for (const auto& t : box.triangles)
    for (const uint32_t v : t) bytes += bytesOf(v);
  return bytes;
}

TEST_F(GltfExtensions, RequiredOnesAreReadOrNamed) {
  folder_.write("box.bin", boxBytes());
  const auto with = [&](const std::string& name) {
    return boxGltf("box.bin", R"("extensionsUsed":[")" + name + R"("],"extensionsRequired":[")" + name + R"("],)");
  };
  for (const std::string name : {"EXT_meshopt_compression", "EXT_mesh_gpu_instancing", "FOO_bar"})
    EXPECT_TRUE(says(refusal(with(name)), {"shape.gltf", "requires the extension " + name, "write it without"}));
  for (const std::string name : {"KHR_materials_unlit", "KHR_texture_transform", "EXT_texture_webp"})
    EXPECT_NEAR(signedVolume(importMesh(folder_.write("look.gltf", with(name)), 1)), 1, kGltfRounding) << name;
}

/// Returns a box as gltfpack writes it: 16-bit integers, eight bytes apart, in the scale of its node.
std::string quantisedBox(const std::string& buffer, bool is_signed) {
  const std::string type = is_signed ? "5122" : "5123", normalized = is_signed ? "true" : "false";
  const std::string scale = is_signed ? "0.1,0.1,0.1" : "0.001,0.001,0.001";
  return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_mesh_quantization"],
"extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"scale":[)" +
         scale + R"(]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":)" +
         type + R"(,"normalized":)" + normalized + R"(,"type":"VEC3","count":8,
"min":[0,0,0],"max":[1,1,1]},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":36}],
"bufferViews":[{"buffer":0,"byteLength":64,"byteStride":8},{"buffer":0,"byteOffset":64,"byteLength":144}],
"buffers":[{"byteLength":208)" +
         buffer + "}]}";
}

std::string quantisedBytes(int16_t one) {
  const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
  std::string bytes;
  for (const Vector3f& p : box.positions_m) {
    for (int c = 0; c < 3; ++c) bytes += bytesOf(static_cast<int16_t>(p[c] * one));
    bytes += bytesOf(int16_t{77});
  }
  for (const auto& t : box.triangles)
    for (const uint32_t v : t) bytes += bytesOf(v);
  return bytes;
}

TEST_F(GltfExtensions, QuantisedPositionsAreRead) {
  folder_.write("q.bin", quantisedBytes(32767));
  const std::string uri = R"(,"uri":"q.bin")";
  EXPECT_NEAR(signedVolume(importMesh(folder_.write("signed.gltf", quantisedBox(uri, true)), 1)), 1e-3, 1e-9);
  folder_.write("q.bin", quantisedBytes(100));
  EXPECT_NEAR(signedVolume(importMesh(folder_.write("unsigned.gltf", quantisedBox(uri, false)), 1)), 1e-3, 1e-9);
  std::string json = quantisedBox("", true);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string binary = quantisedBytes(32767);
  const auto word = [](size_t n) { return bytesOf(static_cast<uint32_t>(n)); };
  const std::string glb = "glTF" + word(2) + word(28 + json.size() + binary.size()) + word(json.size()) + "JSON" +
                          json + word(binary.size()) + std::string("BIN\0", 4) + binary;
  EXPECT_NEAR(signedVolume(importMesh(folder_.write("box.glb", glb), 1)), 1e-3, 1e-9);
  folder_.write("q.bin", quantisedBytes(100).substr(0, 60));
  EXPECT_TRUE(says(refusal(quantisedBox(uri, true)), {"shape.gltf", "accessor 0 reaches beyond its buffer"}));
}

/// Returns a box with indices of this size, one of them out of range, and a valid box without indices.
std::string boxWithIndex(size_t bytes, uint32_t index) {
  const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
  std::string corners, indices, plain;
  for (const Vector3f& p : box.positions_m) corners += bytesOf(p);
  for (const auto& t : box.triangles) {
    for (const uint32_t v : t) {
      indices += bytesOf(indices.size() == 17 * bytes ? index : v).substr(0, bytes);
      plain += bytesOf(Vector3f(box.positions_m[v] + Vector3f(2, 0, 0)));
    }
  }
  const std::string type = bytes == 1 ? "5121" : bytes == 2 ? "5123" : "5125";
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":1}],
"meshes":[{"primitives":[{"attributes":{"POSITION":2}}]},
{"name":"liver","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[
{"bufferView":0,"componentType":5126,"type":"VEC3","count":8},{"bufferView":1,"componentType":)" +
         type + R"(,"type":"SCALAR","count":36},{"bufferView":2,"componentType":5126,"type":"VEC3","count":36}],
"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":1,"byteLength":)" +
         std::to_string(36 * bytes) + R"(},{"buffer":2,"byteLength":432}],"buffers":[)" + dataUri(corners) + "," +
         dataUri(indices) + "," + dataUri(plain) + "]}";
}

TEST_F(GltfExtensions, IndicesBeyondTheVerticesAreNamed) {
  for (const auto& [bytes, index] : std::map<size_t, uint32_t>{{1, 200}, {2, 9999}, {4, 999999}}) {
    EXPECT_TRUE(
        says(refusal(boxWithIndex(bytes, index)),
             {"shape.gltf", "mesh 1 ('liver'), primitive 0: index 17 is " + std::to_string(index), "8 vertices"}));
    const std::string good =
        folder_.write("good.gltf", boxWithIndex(bytes, boxMesh({0, 0, 0}, {1, 1, 1}).triangles[5][2]));
    EXPECT_NEAR(signedVolume(importMesh(good, 1)), 2, kGltfRounding) << bytes;
  }
}

TEST_F(GltfExtensions, NamesOfFilesMayBeEscaped) {
  folder_.write("my bin.bin", boxBytes());
  folder_.write("50%25.bin", boxBytes());  // a name that looks escaped
  for (const std::string uri : {"my%20bin.bin", "my bin.bin", "50%25.bin"})
    EXPECT_NEAR(signedVolume(importMesh(folder_.write("box.gltf", boxGltf(uri)), 1)), 1, kGltfRounding) << uri;
  EXPECT_TRUE(says(refusal(boxGltf("no%20bin.bin")), {"no%20bin.bin"}));
}

TEST_F(GltfExtensions, DracoThatCannotBeUnpackedIsNamed) {
  const std::string bytes = "DRACO and what is none of it";
  folder_.write("packed.bin", bytes);
  const std::string length = std::to_string(bytes.size());
  const std::string path =
      folder_.write("packed.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],
"extensionsRequired":["KHR_draco_mesh_compression"],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":
{"bufferView":0,"attributes":{"POSITION":0}}}}]}],
"accessors":[{"componentType":5126,"type":"VEC3","count":4},{"componentType":5125,"type":"SCALAR","count":12}],
"bufferViews":[{"buffer":0,"byteLength":)" +
                                       length + R"(}],"buffers":[{"uri":"packed.bin","byteLength":)" + length + "}]}");
  EXPECT_TRUE(says(messageOf<MeshError>([&] { importMesh(path, 1); }),
                   {"packed.gltf", "requires the extension KHR_draco_mesh_compression", "write it without"}));
}

}  // namespace
}  // namespace viscera::test
