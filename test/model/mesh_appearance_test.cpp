// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours, textures and texture coordinates in mesh files, and the handling of bad ones.
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "model/mesh_files.h"
#include "support/temporary_folder.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

using test::bytesOf;
using test::TemporaryFolder;

constexpr float kTexel = 1e-4F;  // of a coordinate: rounding of charts in float32, for images of up to 5000 texels

/// Returns a PNG of two adjacent texels, red and green; below them blue and white.
std::string pngBytes() {
  const std::vector<uint8_t> rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = 2;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr);
  std::string out(size, 0);
  png_image_write_to_memory(&image, out.data(), &size, 0, rgb.data(), 0, nullptr);
  return out.substr(0, size);
}

std::string jpegBytes() {
  const std::vector<uint8_t> gray(3 * 16 * 16, 128);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle compressor = tjInitCompress();
  tjCompress2(compressor, gray.data(), 16, 0, 16, TJPF_RGB, &bytes, &size, TJSAMP_444, 90, 0);
  std::string out(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(compressor);
  return out;
}

/// Returns a tetrahedron with texture coordinates; its first face has u = x and v = y.
std::string obj(const std::string& coordinates = "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n") {
  return "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + coordinates +
         "o part\nusemtl m\nf 1/1 3/3 2/2\nf 1/1 2/2 4/4\nf 2/2 3/3 4/4\nf 3/3 1/1 4/4\n";
}

TriangleMesh import(const TemporaryFolder& folder, ImportReport& report, bool with_appearance = true) {
  return importMesh(folder.file("a.obj"), 1, &report, {}, with_appearance);
}

std::string joined(const ImportReport& report) {
  std::string out;
  for (const std::string& note : report.appearance_notes) out += note + "\n";
  return out;
}

/// Imports obj() with a material and the images that it names; expects no notes.
TriangleMesh imported(const std::string& material, const std::vector<std::pair<std::string, std::string>>& pictures) {
  const TemporaryFolder folder;
  folder.write("a.obj", obj());
  folder.write("a.mtl", "newmtl m\n" + material);
  for (const auto& [name, bytes] : pictures) folder.write(name, bytes);
  ImportReport report;
  TriangleMesh out = import(folder, report);
  EXPECT_EQ(joined(report), "");
  return out;
}

TEST(MeshAppearance, CoordinatesAreFunctionsOfTheRestPosition) {
  const TriangleMesh mesh = imported("Kd 0.5 0.5 0.5\nmap_Kd picture.png\n", {{"picture.png", pngBytes()}});
  ASSERT_TRUE(mesh.detail);
  ASSERT_EQ(mesh.charts.size(), mesh.triangles.size());
  const TextureChart& chart = mesh.detail->charts[mesh.charts[0]];
  for (const Vector3f& p : {Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0.25F, 0.5F, 0)}) {
    EXPECT_NEAR(chart.u.head<3>().dot(p) + chart.u[3], p.x(), kTexel);
    EXPECT_NEAR(chart.v.head<3>().dot(p) + chart.v[3], p.y(), kTexel);
  }
  ASSERT_EQ(mesh.detail->images.size(), 1u);
  const std::vector<uint8_t> first(mesh.detail->images[0].rgba.begin(), mesh.detail->images[0].rgba.begin() + 4);
  EXPECT_EQ(first, (std::vector<uint8_t>{0, 0, 255, 255}));  // v = 0 is the image's last row
}

TEST(MeshAppearance, RefinedTrianglesKeepTheirCoordinates) {
  const TriangleMesh mesh = imported("map_Kd picture.png\n", {{"picture.png", pngBytes()}}), fine = refine(mesh, 0.3);
  ASSERT_GT(fine.triangles.size(), 4 * mesh.triangles.size());
  ASSERT_EQ(fine.charts.size(), fine.triangles.size());
  EXPECT_EQ(fine.detail, mesh.detail);
  for (size_t t = 0; t < fine.triangles.size(); ++t) {
    if (fine.charts[t] != mesh.charts[0]) continue;
    for (const uint32_t v : fine.triangles[t]) EXPECT_EQ(fine.positions_m[v].z(), 0);  // all in the first face
  }
}

TEST(MeshAppearance, ColorsOfMaterialsWithoutPictures) {
  const TemporaryFolder folder;
  folder.write("a.obj", obj());
  folder.write("a.mtl", "newmtl m\nKd 1 0.5 0\n");
  ImportReport report;
  const TriangleMesh mesh = import(folder, report);
  ASSERT_TRUE(mesh.detail);
  EXPECT_TRUE(mesh.charts.empty());
  ASSERT_EQ(mesh.detail->part_materials, std::vector<uint32_t>{0});
  EXPECT_TRUE(mesh.detail->materials[0].has_color);
  EXPECT_NEAR(mesh.detail->materials[0].color[1], 0.214, 0.001);  // 0.5 in sRGB
  EXPECT_FALSE(import(folder, report, false).detail);
}

TEST(MeshAppearance, FileWithoutMaterialsHasNoAppearance) {
  const TemporaryFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  ImportReport report;
  EXPECT_FALSE(import(folder, report).detail);
}

TEST(MeshAppearance, NormalMapsAreRead) {
  for (const char* key : {"norm", "map_Kn"}) {
    SCOPED_TRACE(key);
    const TriangleMesh mesh = imported(std::string("map_Kd picture.png\n") + key + " normals.png\n",
                                       {{"picture.png", pngBytes()}, {"normals.png", pngBytes()}});
    ASSERT_EQ(mesh.detail->images.size(), 2u);
    EXPECT_EQ(mesh.detail->materials[mesh.detail->charts[0].material].normal_texture.image, 1);
  }
}

TEST(MeshAppearance, JpegIsRead) {
  const TriangleMesh mesh = imported("map_Kd picture.jpg\n", {{"picture.jpg", jpegBytes()}});
  ASSERT_EQ(mesh.detail->images.size(), 1u);
  EXPECT_EQ(mesh.detail->images[0].width_px, 16);
  EXPECT_NEAR(mesh.detail->images[0].rgba[0], 128, 2);
}

/// Each bad image gives one note with file and key, and the mesh keeps its base colour.
TEST(MeshAppearance, BadPicturesAreNotedByNameAndLeftOut) {
  const std::string whole = pngBytes(), jpeg = jpegBytes();
  const struct {
    const char* name;
    std::string bytes, note;
  } cases[] = {{"missing.png", "", "no such file"},
               {"cut.png", whole.substr(0, whole.size() / 2), "not a readable PNG"},
               {"cut.jpg", jpeg.substr(0, jpeg.size() / 2), "not a readable JPEG"},
               {"other.webp", "RIFF1234WEBP", "neither PNG nor JPEG; it begins with 'RIFF1234'"},
               {"empty.png", "empty", "neither PNG nor JPEG"}};
  for (const auto& of : cases) {
    SCOPED_TRACE(of.name);
    const TemporaryFolder folder;
    folder.write("a.obj", obj());
    folder.write("a.mtl", std::string("newmtl skin\nKd 1 0 0\nmap_Kd ") + of.name + "\nnewmtl m\nKd 0 1 0\nmap_Kd " +
                              of.name + "\n");
    if (!of.bytes.empty()) folder.write(of.name, of.bytes);
    ImportReport report;
    const TriangleMesh mesh = import(folder, report);
    const std::string notes = joined(report);
    EXPECT_EQ(report.appearance_notes.size(), 1u) << notes;
    for (const std::string& part :
         {std::string("a.obj"), std::string("baseColorTexture of material 'm'"), std::string(of.name), of.note})
      EXPECT_NE(notes.find(part), std::string::npos) << part << " in " << notes;
    EXPECT_TRUE(mesh.charts.empty());
    ASSERT_TRUE(mesh.detail);
    EXPECT_GT(mesh.detail->materials[mesh.detail->part_materials[0]].color[1], 0.9F);
  }
}

/// Returns the first tetrahedron of obj() as a .glb with its image embedded, by the format's own rules.
std::string glb(const std::string& picture) {
  std::string data;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F}) data += bytesOf(x);
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 1.F}) data += bytesOf(x);
  for (const uint16_t i : {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}) data += bytesOf(i);
  const size_t picture_begins = data.size();
  data += picture;
  data.resize((data.size() + 3) / 4 * 4);
  const auto view = [](size_t offset, size_t bytes) {
    return R"({"buffer":0,"byteOffset":)" + std::to_string(offset) + R"(,"byteLength":)" + std::to_string(bytes) + "}";
  };
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)"
      R"("attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],)"
      R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],)"
      R"("images":[{"mimeType":"image/png","bufferView":3}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
      R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},)"
      R"({"bufferView":2,"componentType":5123,"count":12,"type":"SCALAR"}],"bufferViews":[)" +
      view(0, 48) + "," + view(48, 32) + "," + view(80, 24) + "," + view(picture_begins, picture.size()) +
      R"(],"buffers":[{"byteLength":)" + std::to_string(data.size()) + "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](size_t value) { return bytesOf(static_cast<uint32_t>(value)); };
  const std::string chunks = word(json.size()) + "JSON" + json + word(data.size()) + std::string("BIN\0", 4) + data;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

TEST(MeshAppearance, PictureWithinAGlbIsRead) {
  const TemporaryFolder folder;
  folder.write("a.glb", glb(pngBytes()));
  ImportReport report;
  const TriangleMesh mesh = importMesh(folder.file("a.glb"), 1, &report, {}, true);
  EXPECT_EQ(joined(report), "");
  ASSERT_TRUE(mesh.detail);
  ASSERT_EQ(mesh.detail->images.size(), 1u);
  EXPECT_EQ(mesh.detail->images[0].width_px, 2);
  ASSERT_EQ(mesh.charts.size(), mesh.triangles.size());
  ASSERT_EQ(std::count(mesh.charts.begin(), mesh.charts.end(), kNoChart), 0);
  const TextureChart& chart = mesh.detail->charts[mesh.charts[0]];
  const Vector3f at(0.25F, 0.25F,
                    0);  // u and v are a quarter: in the image's upper left, red; v points down, unlike in OBJ
  const auto column = static_cast<size_t>(2 * (chart.u.head<3>().dot(at) + chart.u[3]));
  const auto row = static_cast<size_t>(2 * (chart.v.head<3>().dot(at) + chart.v[3]));
  const auto texel = mesh.detail->images[0].rgba.begin() + static_cast<ptrdiff_t>(4 * (2 * row + column));
  EXPECT_EQ(std::vector<uint8_t>(texel, texel + 3), (std::vector<uint8_t>{255, 0, 0}));
}

TEST(MeshAppearance, SpoiltPictureWithinAGlbIsNotedAndLeftOut) {
  const std::string good = pngBytes();
  for (const std::string& spoilt :
       {good.substr(0, good.size() / 2), std::string("no picture"), std::string(64, '\0')}) {
    const TemporaryFolder folder;
    folder.write("a.glb", glb(spoilt));
    ImportReport report;
    const TriangleMesh mesh = importMesh(folder.file("a.glb"), 1, &report, {}, true);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    ASSERT_EQ(report.appearance_notes.size(), 1u) << joined(report);
    for (const char* const part : {"a.glb", "baseColorTexture"})
      EXPECT_NE(joined(report).find(part), std::string::npos) << joined(report);
    EXPECT_TRUE(!mesh.detail || mesh.detail->images.empty());
  }
}

TEST(MeshAppearance, AbsentAndWildCoordinatesAreNoted) {
  const TemporaryFolder folder;
  folder.write("a.mtl", "newmtl m\nmap_Kd picture.png\n");
  folder.write("picture.png", pngBytes());
  folder.write(
      "a.obj",
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no part\nusemtl m\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  ImportReport report;
  EXPECT_TRUE(import(folder, report).charts.empty());
  EXPECT_NE(joined(report).find("part 'part' has no texture coordinates"), std::string::npos) << joined(report);
  folder.write("a.obj", obj("vt 0 0\nvt 1e30 0\nvt 0 1\nvt 1 1\n"));
  const TriangleMesh wild = import(folder, report);
  EXPECT_NE(joined(report).find("texture coordinates are not numbers within"), std::string::npos) << joined(report);
  EXPECT_EQ(std::count(wild.charts.begin(), wild.charts.end(), kNoChart), 3);  // the faces at that corner
  folder.write("a.obj", obj("vt 0 0\nvt 7.5 0\nvt 0 -3\nvt 1 1\n"));           // images repeat
  const TriangleMesh repeated = import(folder, report);
  EXPECT_EQ(joined(report), "");
  EXPECT_EQ(std::count(repeated.charts.begin(), repeated.charts.end(), kNoChart), 0);
}

}  // namespace
}  // namespace viscera
