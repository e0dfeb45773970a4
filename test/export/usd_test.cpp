// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// USD text is read again by a small reader of its grammar: prims, attributes with types, values and time samples.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <map>

#include "export/exporter.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kUsdStep_m = 0.5e-7 + 1e-9;  // half a step of positions, and float32

/// Reads USD text into attributes by path, as in /session/tissue.points, with one value or one per time code.
class UsdReader {
 public:
  explicit UsdReader(const std::string& text) : text_(text) {
    if (text_.rfind("#usda 1.0\n", 0) != 0) throw Error("no #usda 1.0");
    at_ = 10;
    metadata("");
    while (skip(), at_ < text_.size()) prim("");
  }
  using Samples = std::map<double, std::string>;
  std::map<std::string, Samples> attributes;  ///< by path; a value without time has the code -1
  std::map<std::string, std::string> types, prims;

 private:
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  void need(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) throw Error(std::string("no ") + c + " at " + text_.substr(at_, 30));
    ++at_;
  }
  bool has(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string word() {
    skip();
    const size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' ||
                                  text_[at_] == ':' || text_[at_] == '.' || text_[at_] == '[' || text_[at_] == ']'))
      ++at_;
    if (from == at_) throw Error("no word at " + text_.substr(at_, 30));
    return text_.substr(from, at_ - from);
  }
  /// Reads a number, a text, a tuple or an array.
  std::string value() {
    skip();
    const size_t from = at_;
    if (has('"')) {
      at_ = text_.find('"', at_) + 1;
    } else if (text_[at_] == '(' || text_[at_] == '[') {
      const char end = text_[at_++] == '(' ? ')' : ']';
      if (!has(end)) {
        do value();
        while (has(','));
        need(end);
      }
    } else {
      size_t length = 0;
      if (text_.compare(at_, 4, "true") == 0)
        length = 4;
      else
        std::stod(text_.substr(at_, 40), &length);
      at_ += length;
    }
    return text_.substr(from, at_ - from);
  }
  void metadata(const std::string& of) {
    if (!has('(')) return;
    while (!has(')')) {
      const std::string key = word();
      need('=');
      attributes[of + "#" + key][-1] = value();
    }
  }
  void prim(const std::string& above) {
    if (word() != "def") throw Error("no def");
    const std::string type = word();
    std::string name = value();
    name = above + "/" + name.substr(1, name.size() - 2);
    prims[name] = type;
    metadata(name);
    need('{');
    while (!has('}')) {
      skip();
      if (text_.compare(at_, 4, "def ") == 0)
        prim(name);
      else
        attribute(name);
    }
  }
  void attribute(const std::string& of) {
    std::string type = word();
    if (type == "uniform") type = word();
    std::string name = word();
    const bool sampled = name.size() > 12 && name.substr(name.size() - 12) == ".timeSamples";
    if (sampled) name.resize(name.size() - 12);
    const std::string path = of + "." + name;
    types[path] = type;
    metadata(path);
    if (!has('=')) return;
    if (!sampled) {
      attributes[path][-1] = value();
      return;
    }
    need('{');
    while (!has('}')) {
      const double code = std::stod(value());
      need(':');
      attributes[path][code] = value();
      has(',');
    }
  }
  const std::string text_;
  size_t at_ = 0;
};

std::vector<double> numbersOf(const std::string& value) {
  std::vector<double> out;
  for (size_t i = 0; i < value.size();) {
    if (!std::isdigit(static_cast<unsigned char>(value[i])) && value[i] != '-') {
      ++i;
      continue;
    }
    size_t length = 0;
    out.push_back(std::stod(value.substr(i, 40), &length));
    i += length;
  }
  return out;
}

VisibleMesh meshOf(std::vector<uint32_t> triangles, uint64_t revision) {
  VisibleMesh out;
  out.positions_m = {0.1f, -0.2f, 0.3f, 1, 0, 0, 0, 1, 0, 0, 0, 1.2345678e-3f};
  out.normals.assign(4, packNormal({1, 0, 0}));
  VisibleTopology topology;
  topology.revision = revision;
  topology.vertices = 4;
  topology.triangles = std::move(triangles);
  topology.bodies = {{"organ", Vector3d(1, 0.5, 0)}};
  topology.patches = {{0, SurfaceKind::kSkin, 0, topology.triangles.size() / 3}};
  out.topology = std::make_shared<const VisibleTopology>(topology);
  return out;
}

UsdReader written(const std::string& path) {
  Scene scene;
  scene.name = "a \"scene\"";
  scene.cameras.resize(2);
  scene.cameras[1].name = "on arm";
  scene.cameras[1].frame = "arm";
  scene.styluses.resize(1);
  scene.styluses[0].name = "left";
  UsdSeries series(path, scene, 20);
  ToolMotions tools{};
  series.add(0, meshOf({0, 1, 2}, 1), tools);
  VisibleMesh moved = meshOf({0, 1, 2}, 1);
  moved.positions_m[0] = NAN;
  tools[0].present = true;
  tools[0].to = {{0.01, 0.02, 0.03}, rotationFromDegrees({0, 0, 90})};
  series.add(1, moved, tools);
  moved = meshOf({0, 1, 2, 0, 2, 3}, 2);
  moved.colors.assign(4, 0xff0000ffu);
  series.add(12, moved, tools);
  series.finish();
  std::ifstream file(path, std::ios::binary);
  return UsdReader({std::istreambuf_iterator<char>(file), {}});
}

TEST(Usd, HasUnitsAxesAndTime) {
  const TemporaryFolder folder;
  UsdReader usd = written(folder.file("skin.usda"));
  const auto of = [&](const char* key) { return usd.attributes[std::string("#") + key][-1]; };
  EXPECT_EQ(of("metersPerUnit"), "1");
  EXPECT_EQ(of("upAxis"), "\"Z\"");
  EXPECT_EQ(of("timeCodesPerSecond"), "20");
  EXPECT_EQ(of("endTimeCode"), "12");
  EXPECT_EQ(of("defaultPrim"), "\"session\"");
  EXPECT_EQ(usd.prims["/session/tissue"], "Mesh");
  EXPECT_EQ(usd.prims["/session/camera_camera"], "Camera");
  EXPECT_EQ(usd.prims.count("/session/camera_on_arm"), 0U) << "it moves";
  EXPECT_EQ(usd.prims["/session/tool_left/shaft"], "Cylinder");
}

TEST(Usd, HasPositionsColorsAndCutsOverTime) {
  const TemporaryFolder folder;
  UsdReader usd = written(folder.file("skin.usda"));
  const std::string tissue = "/session/tissue.";
  EXPECT_EQ(usd.types[tissue + "points"], "point3f[]");
  auto& points = usd.attributes[tissue + "points"];
  ASSERT_EQ(points.size(), 3U);
  const std::vector<float> wanted = meshOf({0, 1, 2}, 1).positions_m;
  const std::vector<double> found = numbersOf(points[0]);
  ASSERT_EQ(found.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], kUsdStep_m);
  EXPECT_EQ(numbersOf(points[1])[0], 0) << "NaN is no number of USD";
  EXPECT_EQ(usd.attributes[tissue + "faceVertexIndices"].size(), 2U) << "only where a cut changes them";
  EXPECT_EQ(usd.attributes[tissue + "faceVertexIndices"][12], "[0, 1, 2, 0, 2, 3]");
  EXPECT_EQ(usd.attributes[tissue + "faceVertexCounts"][12], "[3, 3]");
  auto& colors = usd.attributes[tissue + "primvars:displayColor"];
  ASSERT_EQ(colors.size(), 2U);
  EXPECT_EQ(colors[0].substr(0, 22), "[(1.000, 0.214, 0.000)") << "linear, of the body";
  EXPECT_EQ(colors[12].substr(0, 22), "[(1.000, 0.000, 0.000)") << "of the vertices";
  EXPECT_EQ(usd.attributes[tissue + "primvars:displayColor#interpolation"][-1], "\"vertex\"");
}

TEST(Usd, HasPosesOfToolsAndCameras) {
  const TemporaryFolder folder;
  UsdReader usd = written(folder.file("skin.usda"));
  auto& poses = usd.attributes["/session/tool_left.xformOp:transform"];
  ASSERT_EQ(poses.size(), 2U);
  const std::vector<double> rows = numbersOf(poses[1]);
  const std::vector<double> turned = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.01, 0.02, 0.03, 1};
  ASSERT_EQ(rows.size(), turned.size());
  for (size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], turned[i], 1e-9);
  EXPECT_EQ(usd.attributes["/session/tool_left.visibility"][0], "\"invisible\"");
  EXPECT_EQ(usd.attributes["/session/tool_left.visibility"][1], "\"inherited\"");
  // The camera of the default scene is at (0, -0.3, 0.1) and looks at the origin: its -z, the third row.
  const std::vector<double> camera = numbersOf(usd.attributes["/session/camera_camera.xformOp:transform"][-1]);
  const Vector3d back = -Vector3d(0, 0.3, -0.1).normalized();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(camera[static_cast<size_t>(8 + i)], back[i], 1e-8);
  EXPECT_NEAR(camera[13], -0.3, 1e-9);
}

TEST(Usd, HoldsOnlySkinsInMetres) {
  const TemporaryFolder folder;
  ExportOptions options;
  options.format = ExportFormat::kUsda;
  options.frame = ExportFrame::kLpsMm;
  EXPECT_THROW(Exporter(folder.path(), options, 0.02), Error);
  options.frame = ExportFrame::kRos;
  options.source = ExportSource::kLattice;
  EXPECT_THROW(Exporter(folder.path(), options, 0.02), Error);
}

}  // namespace
}  // namespace viscera
