// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Exported files are read again by independent readers of this test: equal to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "export/exporter.h"
#include "support/comma_locale.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
template <class T>
T at(const std::string& bytes, size_t position) {
  T out{};
  EXPECT_LE(position + sizeof out, bytes.size());
  if (position + sizeof out <= bytes.size()) std::memcpy(&out, bytes.data() + position, sizeof out);
  return out;
}
template <class T>
std::vector<T> valuesAt(const std::string& bytes, size_t position, size_t count) {
  std::vector<T> out(count);
  EXPECT_LE(position + count * sizeof(T), bytes.size());
  if (position + count * sizeof(T) <= bytes.size()) std::memcpy(out.data(), bytes.data() + position, count * sizeof(T));
  return out;
}
std::string attribute(const std::string& element, const std::string& name) {
  const size_t begin = element.find(" " + name + "=\"");
  if (begin == std::string::npos) return "";
  const size_t first = begin + name.size() + 3;
  return element.substr(first, element.find('"', first) - first);
}
/// Returns the elements with a given name, with their attributes.
std::vector<std::string> elements(const std::string& xml, const std::string& name) {
  std::vector<std::string> out;
  for (size_t at = xml.find("<" + name + " "); at != std::string::npos; at = xml.find("<" + name + " ", at + 1))
    out.push_back(xml.substr(at, xml.find('>', at) - at));
  return out;
}

/// Returns two triangles, one of which belongs to a wound.
VisibleMesh skin() {
  VisibleMesh out;
  out.positions_m = {0.1f, 0.2f, 0.3f, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  out.normals.assign(4, packNormal({1, 0, 0}));
  VisibleTopology topology;
  topology.vertices = 4;
  topology.triangles = {0, 1, 2, 0, 2, 3};
  topology.bodies = {{"organ", Vector3d(1, 0.5, 0.25)}};
  topology.patches = {{0, SurfaceKind::kSkin, 0, 1}, {0, SurfaceKind::kWound, 1, 1}};
  out.topology = std::make_shared<const VisibleTopology>(topology);
  return out;
}
FieldMesh fields(uint32_t corners) {
  FieldMesh mesh;
  mesh.tick = 7;
  mesh.time_s = 0.1;
  mesh.corners = corners;
  for (int i = 0; i < 24; ++i) mesh.points.push_back(0.1f * static_cast<float>(i));
  for (uint32_t i = 0; i < corners; ++i) mesh.cells.push_back(i);
  for (uint32_t i = 0; i < corners; ++i) mesh.cells.push_back(7 - i);
  mesh.of_points = {{"displacement", 3, mesh.points}, {"part", 1, {0, 1, 2, 3, 4, 5, 6, NAN}}};
  mesh.of_cells = {{"von_mises", 1, {12.5f, -1e-30f}}};
  return mesh;
}

void expectSame(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), 4 * a.size()), 0);
}

/// Arrays of a VTK file by name. Checks that they follow each other up to the end.
struct VtkArrays {
  explicit VtkArrays(const std::string& bytes) {
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    const size_t begin = bytes.find(mark) + mark.size();
    size_t expected = 0;
    for (const std::string& array : elements(bytes.substr(0, begin), "DataArray")) {
      const size_t offset = std::stoul(attribute(array, "offset"));
      EXPECT_EQ(offset, expected) << array;
      const uint64_t length = at<uint64_t>(bytes, begin + offset);
      raw[attribute(array, "Name")] = bytes.substr(begin + offset + 8, length);
      expected = offset + 8 + length;
    }
    EXPECT_EQ(bytes.substr(begin + expected), "\n</AppendedData>\n</VTKFile>\n");
  }
  template <class T>
  std::vector<T> of(const std::string& name) const {
    return valuesAt<T>(raw.at(name), 0, raw.at(name).size() / sizeof(T));
  }
  std::map<std::string, std::string> raw;
};

TEST(Vtk, ComesBackAsItWas) {
  const TemporaryFolder folder;
  for (const uint32_t corners : {2u, 3u, 8u}) {
    const FieldMesh mesh = fields(corners);
    const std::string path = folder.file("mesh.vtk");
    writeVtk(mesh, path);
    const std::string bytes = textOf(path);
    const VtkArrays arrays(bytes);
    expectSame(arrays.of<float>("points"), mesh.points);
    expectSame(arrays.of<float>("displacement"), mesh.points);
    expectSame(arrays.of<float>("part"), mesh.of_points[1].values);
    expectSame(arrays.of<float>("von_mises"), mesh.of_cells[0].values);
    const std::vector<int64_t> cells(mesh.cells.begin(), mesh.cells.end()), ends = {corners, 2 * corners};
    EXPECT_EQ(arrays.of<int64_t>("connectivity"), cells);
    EXPECT_EQ(arrays.of<int64_t>("offsets"), ends);
    if (corners == 8) {
      EXPECT_EQ(arrays.of<uint8_t>("types"), std::vector<uint8_t>(2, 12));
    }
    const std::string piece = elements(bytes, "Piece").at(0);
    EXPECT_EQ(attribute(piece, "NumberOfPoints"), "8");
    EXPECT_EQ(attribute(piece, corners == 2 ? "NumberOfLines" : corners == 3 ? "NumberOfPolys" : "NumberOfCells"), "2");
  }
  EXPECT_THROW(writeVtk(fields(3), "/no/such/folder/a.vtp"), Error);
}

TEST(Xdmf, HasCellsOnceAndAllTimes) {
  const TemporaryFolder folder;
  FieldMesh mesh = fields(3);
  {
    const CommaLocale comma;
    XdmfSeries series(folder.file("skin"));
    series.add(mesh);
    mesh.time_s = 0.2;
    mesh.points[0] = 5;
    series.add(mesh);
    series.finish();
  }
  const std::string xml = textOf(folder.file("skin.xdmf")), binary = textOf(folder.file("skin.bin"));
  const std::vector<std::string> items = elements(xml, "DataItem"), times = elements(xml, "Time");
  ASSERT_EQ(items.size(), 10U);  // cells, points, three fields, twice
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(std::stod(attribute(times[1], "Value")), 0.2);
  EXPECT_EQ(attribute(items[5], "Seek"), attribute(items[0], "Seek"));
  EXPECT_EQ(valuesAt<uint32_t>(binary, std::stoul(attribute(items[0], "Seek")), 6), mesh.cells);
  EXPECT_EQ(attribute(items[6], "Dimensions"), "8 3");
  expectSame(valuesAt<float>(binary, std::stoul(attribute(items[6], "Seek")), 24), mesh.points);
  expectSame(valuesAt<float>(binary, std::stoul(attribute(items[9], "Seek")), 2), mesh.of_cells[0].values);
  EXPECT_EQ(std::stoul(attribute(items[9], "Seek")) + 8, binary.size());
}

TEST(Glb, HasColorsOfVerticesWhereTheSkinHasSome) {
  const TemporaryFolder folder;
  VisibleMesh burnt = skin();
  burnt.colors = {0xff0000ffU, 0xff00ff00U, 0xffff0000U, 0xff808080U};
  writeGlb(burnt, folder.file("skin.glb"));
  const std::string bytes = textOf(folder.file("skin.glb"));
  const uint32_t json_length = at<uint32_t>(bytes, 12);
  const auto json = nlohmann::json::parse(bytes.substr(20, json_length));
  for (const auto& primitive : json["meshes"][0]["primitives"]) {
    const auto& accessor = json["accessors"][primitive["attributes"]["COLOR_0"].get<size_t>()];
    EXPECT_EQ(accessor["count"], 4);
    const size_t offset = json["bufferViews"][accessor["bufferView"].get<size_t>()]["byteOffset"];
    const std::vector<float> colors = valuesAt<float>(bytes, 20 + json_length + 8 + offset, 12);
    EXPECT_EQ(std::vector<float>(colors.begin(), colors.begin() + 6), (std::vector<float>{1, 0, 0, 0, 1, 0}));
    EXPECT_NEAR(colors[9], 0.2159, 0.005) << "linear: half of sRGB";
    const auto& material = json["materials"][primitive["material"].get<size_t>()];
    EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], nlohmann::json::array({1.0, 1.0, 1.0, 1.0}));
  }
}

TEST(Ply, HasColorsOfVerticesWhereTheSkinHasSome) {
  const TemporaryFolder folder;
  VisibleMesh burnt = skin();
  writePly(burnt, folder.file("plain.ply"));
  burnt.colors = {0xff0000ffU, 0xff00ff00U, 0xffff0000U, 0xff302010U};
  writePly(burnt, folder.file("burnt.ply"));
  const std::string plain = textOf(folder.file("plain.ply")), bytes = textOf(folder.file("burnt.ply"));
  const std::string properties = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  EXPECT_EQ(plain.find(properties), std::string::npos);
  EXPECT_NE(bytes.find(properties), std::string::npos);
  EXPECT_EQ(bytes.size(), plain.size() + properties.size() + 3 * 4);
  const size_t last = bytes.find("end_header\n") + 11 + 3 * 27 + 24;  // of the fourth vertex: 6 floats, 3 bytes
  EXPECT_EQ(bytes.substr(last, 3), "\x10\x20\x30");
}

TEST(Glb, HasItsLengthsAndItsVertices) {
  const TemporaryFolder folder;
  writeGlb(skin(), folder.file("skin.glb"));
  const std::string bytes = textOf(folder.file("skin.glb"));
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(at<uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(at<uint32_t>(bytes, 8), bytes.size());
  const uint32_t json_length = at<uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_length % 4, 0u);
  const size_t binary = 20 + json_length + 8;
  EXPECT_EQ(at<uint32_t>(bytes, 20 + json_length), bytes.size() - binary);
  EXPECT_EQ(bytes.substr(binary - 4, 4), std::string("BIN\0", 4));
  const auto json = nlohmann::json::parse(bytes.substr(20, json_length));
  EXPECT_EQ(json["asset"]["version"], "2.0");
  EXPECT_EQ(json["buffers"][0]["byteLength"], bytes.size() - binary);
  EXPECT_EQ(json["scenes"][0]["nodes"], nlohmann::json::array({0}));
  EXPECT_EQ(json["nodes"][0]["rotation"].size(), 4U);
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U);
  size_t end = 0;
  for (const auto& view : json["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"], end);
    end += view["byteLength"].get<size_t>();
  }
  EXPECT_EQ(end, bytes.size() - binary);
  const auto accessor = [&](int index) { return json["accessors"][static_cast<size_t>(index)]; };
  const auto begin = [&](const nlohmann::json& accessor) {
    return binary + json["bufferViews"][accessor["bufferView"].get<size_t>()]["byteOffset"].get<size_t>();
  };
  const auto positions = accessor(primitives[0]["attributes"]["POSITION"]);
  EXPECT_EQ(positions["count"], 4);
  EXPECT_EQ(positions["type"], "VEC3");
  EXPECT_EQ(positions["max"], nlohmann::json::array({1.0, 1.0, 1.0}));
  expectSame(valuesAt<float>(bytes, begin(positions), 12), skin().positions_m);
  const auto corners = accessor(primitives[1]["indices"]);
  EXPECT_EQ(valuesAt<uint32_t>(bytes, begin(corners), 3), (std::vector<uint32_t>{0, 2, 3}));
  EXPECT_EQ(json["materials"].size(), 2U);
}

TEST(Pc2, HasAllSamplesAndAsManyPointsInEach) {
  const TemporaryFolder folder;
  Pc2Series series(folder.file("skin.pc2"), 0.05);
  FieldMesh mesh = fields(3);
  series.add(mesh);
  series.add(mesh);
  mesh.points.resize(21);
  EXPECT_THROW(series.add(mesh), Error);
  series.finish();
  const std::string bytes = textOf(folder.file("skin.pc2"));
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(at<int32_t>(bytes, 12), 1);
  EXPECT_EQ(at<int32_t>(bytes, 16), 8);
  EXPECT_EQ(at<float>(bytes, 24), 0.05f);
  EXPECT_EQ(at<int32_t>(bytes, 28), 2);
  ASSERT_EQ(bytes.size(), 32U + 2 * 96);
  expectSame(valuesAt<float>(bytes, 32 + 96, 24), fields(3).points);
}

/// The patient's left is +x in LPS and +y in viscera's frame; the back is +y in LPS and -x in viscera's frame.
TEST(ExportFrames, LeftStaysLeft) {
  std::vector<float> positions = {0.001f, 0.002f, 0.003f};
  const Vector3d origin(0.1, 0.2, 0.3);
  std::vector<float> arrows = positions;
  toFrame(ExportFrame::kLpsMm, origin, Vectors::kPositions, positions);
  EXPECT_FLOAT_EQ(positions[0], 202);
  EXPECT_FLOAT_EQ(positions[1], -101);
  EXPECT_FLOAT_EQ(positions[2], 303);
  toFrame(ExportFrame::kLpsMm, origin, Vectors::kArrows, arrows);
  EXPECT_FLOAT_EQ(arrows[0], 2);
  std::vector<float> forward = {1, 0, 0};
  toFrame(ExportFrame::kLpsMm, origin, Vectors::kDirections, forward);
  EXPECT_EQ(forward, (std::vector<float>{0, -1, 0}));
  toFrame(ExportFrame::kRos, origin, Vectors::kPositions, forward);
  EXPECT_EQ(forward, (std::vector<float>{0, -1, 0}));
}

TEST(ExporterTest, RefusesWhatAFormatDoesNotHold) {
  const TemporaryFolder folder;
  ExportOptions options;
  options.source = ExportSource::kLattice;
  options.format = ExportFormat::kGlb;
  EXPECT_THROW(Exporter(folder.path(), options, 0.02), Error);
  options.source = ExportSource::kSkin;
  options.frame = ExportFrame::kLpsMm;
  EXPECT_THROW(Exporter(folder.path(), options, 0.02), Error);
  options.frame = ExportFrame::kRos;
  options.every_s = 0.1;
  const Exporter exporter(folder.path(), options, 0.02);
  EXPECT_FALSE(exporter.isDue(4));
  EXPECT_TRUE(exporter.isDue(5));
}

}  // namespace
}  // namespace viscera
