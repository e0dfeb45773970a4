// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>

#include "export/writers.h"
#include "math/number_text.h"
#include "math/srgb.h"
#include "viscera/model/scene/scene.h"
#include "viscera/render/camera.h"

namespace viscera {
namespace {

constexpr int64_t kPerMetre = 10000000;  // steps of positions
constexpr int kDecimals = 7;             // of these steps
constexpr size_t kCodeWidth = 20;        // room for the last time code, which is known at the end
constexpr double kAperture = 24;         // of a camera; only its ratio to the focal length counts
constexpr double kShaftsPerRadius = 40;  // length of a drawn shaft over its default radius
constexpr double kRadPerDeg = 3.14159265358979323846 / 180;

/// Appends a coordinate: exact to its step, in any locale, and ten times as fast as a stream.
void putCoordinate(std::string& out, float metres) {
  const double steps = std::round(static_cast<double>(metres) * static_cast<double>(kPerMetre));
  if (!(std::abs(steps) < 1e18)) {  // no number of USD, such as NaN
    out += '0';
    return;
  }
  const auto whole = static_cast<int64_t>(std::abs(steps));
  if (steps < 0) out += '-';
  out += std::to_string(whole / kPerMetre);
  std::string rest = std::to_string(whole % kPerMetre);
  rest.insert(0, static_cast<size_t>(kDecimals) - rest.size(), '0');
  while (!rest.empty() && rest.back() == '0') rest.pop_back();
  if (!rest.empty()) out += '.' + rest;
}

std::string pointsText(const std::vector<float>& positions_m) {
  constexpr size_t kBytesPerPoint = 36;
  std::string out = "[";
  out.reserve(kBytesPerPoint * positions_m.size() / 3);
  for (size_t i = 0; i + 2 < positions_m.size(); i += 3) {
    out += i ? ", (" : "(";
    for (size_t axis = 0; axis < 3; ++axis) {
      if (axis) out += ", ";
      putCoordinate(out, positions_m[i + axis]);
    }
    out += ')';
  }
  return out + "]";
}

std::string tripleText(const Vector3d& v) {
  return "(" + numberText(v.x()) + ", " + numberText(v.y()) + ", " + numberText(v.z()) + ")";
}

/// Returns a pose as USD's matrix, of which rows are axes. @param scene_axes  axes of the object in the pose's frame
std::string matrixText(const Pose& pose, const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity()) {
  constexpr int kDigits = 9;
  const Eigen::Matrix3d turn = pose.orientation.toRotationMatrix() * axes;
  std::string out = "( ";
  for (int column = 0; column < 4; ++column) {
    const Vector3d row = column < 3 ? Vector3d(turn.col(column)) : pose.position_m;
    out += column ? ", (" : "(";
    for (int i = 0; i < 3; ++i) out += numberText(row[i], kDigits) + ", ";
    out += column < 3 ? "0)" : "1)";
  }
  return out + " )";
}

/// Returns a name of a prim: letters, digits and underscores, no digit first.
std::string primName(const std::string& prefix, const std::string& name) {
  std::string out = prefix + name;
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return out;
}

std::string colorsText(const VisibleMesh& skin) {
  const VisibleTopology& topology = *skin.topology;
  std::vector<Vector3d> colors(skin.vertices(), Vector3d::Ones());
  for (const VisiblePatch& patch : topology.patches) {
    const Vector3d& body = topology.bodies[patch.body].color;
    const Vector3d color = patch.kind == SurfaceKind::kWound ? woundColor(body) : body;
    for (size_t i = 3 * patch.first; i < 3 * (patch.first + patch.count); ++i) colors[topology.triangles[i]] = color;
  }
  for (size_t v = 0; v < skin.colors.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      colors[v][axis] = static_cast<double>(skin.colors[v] >> (8 * axis) & 255U) / 255;
  constexpr int kDigits = 3;
  std::string out = "[";
  for (size_t v = 0; v < colors.size(); ++v) {
    out += v ? ", (" : "(";
    for (int axis = 0; axis < 3; ++axis)
      out += (axis ? ", " : "") + fixedText(linearFromSrgb(colors[v][axis]), kDigits);
    out += ')';
  }
  return out + "]";
}

std::string numbersText(const std::vector<uint32_t>& numbers) {
  std::string out = "[";
  for (size_t i = 0; i < numbers.size(); ++i) out += (i ? ", " : "") + std::to_string(numbers[i]);
  return out + "]";
}

std::string extentText(const VisibleMesh& skin) {
  Eigen::AlignedBox3f box;
  for (size_t v = 0; v < skin.vertices(); ++v) box.extend(skin.position_m(v));
  if (box.isEmpty()) return "[(0, 0, 0), (0, 0, 0)]";
  return "[" + tripleText(box.min().cast<double>()) + ", " + tripleText(box.max().cast<double>()) + "]";
}

/// Returns the cameras that do not move: of the others only the viewer of a session knows the poses.
std::string camerasText(const Scene& scene) {
  std::string out;
  for (const CameraConfig& camera : scene.cameras) {
    if (!camera.frame.empty() || !camera.stylus.empty()) continue;
    const double focal = kAperture / 2 / std::tan(kRadPerDeg * camera.vertical_fov_deg / 2);
    // An optical frame looks along z with y down, a camera of USD along -z with y up.
    const Eigen::Matrix3d axes = Vector3d(1, -1, -1).asDiagonal();
    out += "    def Camera \"" + primName("camera_", camera.name) +
           "\"\n    {\n        float focalLength = " + numberText(focal) +
           "\n        float verticalAperture = " + numberText(kAperture) +
           "\n        float horizontalAperture = " + numberText(kAperture * camera.width_px / camera.height_px) +
           "\n        float2 clippingRange = (0.001, 100)\n        matrix4d xformOp:transform = " +
           matrixText(opticalPose(camera), axes) +
           "\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }\n";
  }
  return out;
}

}  // namespace

void UsdSeries::Samples::add(uint64_t code, const std::string& value) {
  if (value == last) return;
  last = value;
  text += "            " + std::to_string(code) + ": " + value + ",\n";
}

std::string UsdSeries::Samples::written(const std::string& attribute, const std::string& metadata) const {
  std::string out = "        " + attribute;
  if (!metadata.empty()) out += " (" + metadata + ")\n        " + attribute;
  return out + ".timeSamples = {\n" + text + "        }\n";
}

UsdSeries::UsdSeries(const std::string& path, const Scene& scene, double moments_per_s)
    : file_(path, FileKind::kText), cameras_(camerasText(scene)) {
  for (const StylusConfig& stylus : scene.styluses) {
    const double radius_m =
        stylus.shaft_radius_m > 0 ? stylus.shaft_radius_m : stylus.shaft_length_m / kShaftsPerRadius;
    tools_.push_back({primName("tool_", stylus.name), stylus.shaft_length_m, radius_m, {}, {}});
  }
  const std::string head = "#usda 1.0\n(\n    defaultPrim = \"session\"\n    doc = \"" + primName("", scene.name) +
                           ", by viscera\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n    timeCodesPerSecond = " +
                           exactText(moments_per_s) + "\n    startTimeCode = 0\n    endTimeCode = ";
  end_at_ = head.size();
  file_.write(head + std::string(kCodeWidth, ' ') +
              "\n)\n\ndef Xform \"session\"\n{\n    def Mesh \"tissue\"\n    {\n"
              "        uniform token subdivisionScheme = \"none\"\n        uniform bool doubleSided = true\n"
              "        point3f[] points.timeSamples = {\n");
}

void UsdSeries::add(uint64_t code, const VisibleMesh& skin, const ToolMotions& tools) {
  file_.write("            " + std::to_string(code) + ": " + pointsText(skin.positions_m) + ",\n");
  end_ = code;
  if (!begun_ || revision_ != skin.topology->revision) {
    const std::vector<uint32_t>& triangles = skin.topology->triangles;
    counts_.add(code, numbersText(std::vector<uint32_t>(triangles.size() / 3, 3)));
    corners_.add(code, numbersText(triangles));
  }
  begun_ = true;
  revision_ = skin.topology->revision;
  colors_.add(code, colorsText(skin));
  extents_.add(code, extentText(skin));
  for (size_t s = 0; s < tools_.size() && s < tools.size(); ++s) {
    tools_[s].visibility.add(code, tools[s].present ? "\"inherited\"" : "\"invisible\"");
    tools_[s].poses.add(code, matrixText(tools[s].present ? tools[s].to : Pose{}));
  }
}

void UsdSeries::finish() {
  if (!begun_) return;
  file_.write("        }\n" + counts_.written("int[] faceVertexCounts") + corners_.written("int[] faceVertexIndices") +
              colors_.written("color3f[] primvars:displayColor", "interpolation = \"vertex\"") +
              extents_.written("float3[] extent") + "    }\n" + cameras_);
  for (const Tool& tool : tools_)
    file_.write("    def Xform \"" + tool.name + "\"\n    {\n" + tool.poses.written("matrix4d xformOp:transform") +
                "        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n" +
                tool.visibility.written("token visibility") +
                "        def Cylinder \"shaft\"\n        {\n            uniform token axis = \"Z\"\n            double "
                "height = " +
                numberText(tool.length_m) + "\n            double radius = " + numberText(tool.radius_m) +
                "\n            double3 xformOp:translate = (0, 0, " + numberText(tool.length_m / 2) +
                ")\n            uniform token[] xformOpOrder = [\"xformOp:translate\"]\n        }\n    }\n");
  file_.write("}\n");
  const std::string last = std::to_string(end_);
  file_.writeAt(end_at_, last.data(), last.size());
  file_.keep();
}

}  // namespace viscera
