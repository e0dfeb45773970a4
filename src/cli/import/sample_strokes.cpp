// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/sample_strokes.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "math/number_text.h"

namespace viscera::cli {
namespace {

constexpr double kUsualOrgan_m = 0.1;  ///< size of the organ for which the motions are written [m]

/// Directions from which tools come, the best first: that of the scene's first camera. An organ is fixed at its back.
const Vector3d kDirections[] = {{1, 0.35, 0.3}, {1, 0, 0.6},    {1, -0.35, 0.3}, {0.5, 0, 1},
                                {0.3, 1, 0.2},  {0.3, -1, 0.2}, {0.5, 0, -1}};
constexpr double kFacing = 0.85;  ///< least cosine between a surface normal and the tool's direction
constexpr size_t kTries = 12;     ///< number of positions that are tried for each direction

/// Returns whether a ray from a position hits a mesh.
bool hides(const TriangleMesh& mesh, const Vector3d& position, const Vector3d& direction) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<uint32_t, 3>& t) {
    Matrix3d m;  // place + s way = a + u (b - a) + v (c - a)
    const Vector3d a = mesh.positions_m[t[0]].cast<double>();
    m << mesh.positions_m[t[1]].cast<double>() - a, mesh.positions_m[t[2]].cast<double>() - a, -direction;
    const double det = m.determinant();
    if (det == 0) return false;
    const Vector3d uvs = m.inverse() * (position - a);
    return uvs.x() >= 0 && uvs.y() >= 0 && uvs.x() + uvs.y() <= 1 && uvs.z() > 0;
  });
}

/// Returns positions of an organ that face a direction, sorted by distance from its centre as seen from there.
/// @param without  [triangles] that are excluded
std::vector<Vector3d> facing(const TriangleMesh& mesh, const std::vector<bool>& without, const Eigen::AlignedBox3d& box,
                             const Vector3d& direction) {
  std::vector<std::pair<double, Vector3d>> found;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (without[i]) continue;
    const std::array<uint32_t, 3>& t = mesh.triangles[i];
    const Vector3d a = mesh.positions_m[t[0]].cast<double>(), b = mesh.positions_m[t[1]].cast<double>(),
                   c = mesh.positions_m[t[2]].cast<double>(), middle = (a + b + c) / 3;
    if ((b - a).cross(c - a).normalized().dot(direction) > kFacing)
      found.emplace_back((middle - box.center()).cross(direction).norm(), middle);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vector3d> positions;
  for (size_t n = 0; n < found.size(); n += 1 + found.size() / kTries) positions.push_back(found[n].second);
  return positions;
}

/// A position and the outward direction there.
struct Spot {
  Vector3d at_m, outward;
};

/// Returns a position that can move and is not hidden by organs, if there is one; otherwise one that is not hidden.
Spot positionOn(const std::vector<const TriangleMesh*>& organs, const TriangleMesh& organ,
                const std::vector<bool>& is_held, const Eigen::AlignedBox3d& box) {
  for (const std::vector<bool>& without : {is_held, std::vector<bool>(is_held.size(), false)}) {
    for (const Vector3d& direction : kDirections) {
      const Vector3d outward = direction.normalized();
      for (const Vector3d& position : facing(organ, without, box, outward)) {
        const Vector3d clear = position + 1e-3 * box.sizes().norm() * outward;  // clear of the organ's own triangle
        const auto isHidden = [&](const TriangleMesh* other) { return hides(*other, clear, outward); };
        if (std::none_of(organs.begin(), organs.end(), isHidden)) return {position, outward};
      }
    }
  }
  return {box.center(), kDirections[0].normalized()};
}

std::string list(const Vector3d& v) {
  TextOut out;
  out.precision(5);
  out << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
  return out.str();
}

/// Key in millimetres for an organ of the usual size, in the anchor's frame: x right, y up, z towards the user.
struct Key {
  double t_s;
  Vector3d at_mm;
  const char* buttons;
  const char* turned = "";  ///< rotation of the tool from here on; empty: unchanged
};

constexpr const char* kGrab = ", button1: true";
constexpr const char* kCut = ", button2: true";
// Shafts point aside, so that a camera looking along them sees the tips; a blade stays in the plane of its cut.
constexpr const char* kToTheLeft = "[0, -50, 0]";
constexpr const char* kToTheRight = "[0, 50, 0]";
constexpr const char* kUpwards = "[-40, 0, 0]";

const Key kLeft[] = {{0.0, {-20, 0, 40}, "", kToTheLeft},
                     {0.4, {0, 0, 10}, ""},
                     {0.9, {0, 0, -8}, ""},
                     {1.1, {0, 0, -8}, ""},
                     {1.4, {0, 0, 12}, ""},
                     {1.8, {0, 0, -5}, kGrab},
                     {2.5, {-4, 4, 14}, kGrab},
                     {2.8, {-4, 4, 14}, kGrab},
                     {3.1, {0, 0, 4}, ", button1: false"},
                     {3.5, {-40, 0, 50}, ""}};
const Key kRight[] = {{3.2, {40, 20, 50}, "", kUpwards},
                      {3.6, {0, 22, 16}, kCut},
                      {3.8, {0, 22, -14}, kCut},
                      {4.5, {0, -22, -14}, kCut},
                      {5.0, {0, 22, -14}, kCut},
                      {5.2, {0, 22, 16}, ", button2: false"},
                      {5.5, {9, 0, 10}, "", kToTheRight},
                      {5.8, {9, 0, -6}, kGrab},
                      {6.4, {18, 0, 6}, kGrab},
                      {6.8, {18, 0, 6}, kGrab},
                      {7.0, {12, 0, 4}, ", button1: false"},
                      {7.4, {40, 0, 50}, ""}};

template <size_t N>
void addStroke(std::ostringstream& out, const char* stylus, const std::string& anchor, const Key (&keys)[N],
               double size) {
  constexpr double kMm = 1e-3;
  out << "  - stylus: " << stylus << "\n    anchor: " << anchor << "\n    keys:\n";
  const char* turned = "[0, 0, 0]";
  for (const Key& key : keys) {
    if (*key.turned != '\0') turned = key.turned;
    out << "      - {t_s: " << key.t_s << ", position_m: " << list(size * kMm * key.at_mm)
        << ", rotation_deg: " << turned << key.buttons << "}\n";
  }
}

}  // namespace

std::string strokesFor(const std::vector<const TriangleMesh*>& organs, size_t largest, const std::vector<bool>& is_held,
                       const Vector3d& moved_m, double most_size) {
  const TriangleMesh& organ = *organs[largest];
  Eigen::AlignedBox3d box;
  for (const Vector3f& p : organ.positions_m) box.extend(p.cast<double>());
  const auto [position, direction] = positionOn(organs, organ, is_held, box);
  const double size = std::min(most_size, std::cbrt(box.sizes().prod()) / kUsualOrgan_m);
  const Vector3d towards = position + moved_m, from = towards + 2 * box.sizes().norm() * direction;
  const std::string anchor = "{from_m: " + list(from) + ", towards_m: " + list(towards) + "}";
  TextOut out;
  out << "# The left hand dents the largest organ and pulls it, the right hand cuts it. Keys are relative to where "
         "the\n"
         "# anchor's ray meets the skin: x right, y up, z towards the hand.\nstrokes:\n";
  addStroke(out, "left", anchor, kLeft, size);
  addStroke(out, "right", anchor, kRight, size);
  out << "marks:\n  - {name: dented, t_s: 1}\n  - {name: pulled, t_s: 2.7}\n  - {name: opened, t_s: 6.7}\n";
  return out.str();
}

}  // namespace viscera::cli
