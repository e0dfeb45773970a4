// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/walls/walls_shapes.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "bench/harness/specimens/clamp.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::bench {

namespace {

constexpr double kOrganEdge_m = 0.0015;    ///< edge length of triangles; halving it changes results by 0.2 % at most
constexpr double kOrganBorder_m = 0.0043;  ///< x of the border between the block's two materials, inside cells
constexpr double kStomachCut = 0.045;      ///< position at which the straight stomach is cut off and fixed [m]
constexpr double kStomachBend = 0.06;      ///< radius [m]

/// Returns an ellipsoid with its pole at -z, cut off at a height; the axes of its inside are shorter by the wall.
std::function<Vector3d(double, double, double)> ellipsoid(const Vector3d& axes_m, double wall_m, double cut_m) {
  return [=](double s, double f, double t) {
    const Vector3d axes = axes_m.array() - wall_m * (1 - t);
    const double angle = s * std::acos(-cut_m / axes.z()), c = s > 0 ? std::sin(angle) : 0;
    return Vector3d(axes.x() * c * std::cos(f), axes.y() * c * std::sin(f), -axes.z() * std::cos(angle));
  };
}

/// Returns half a sphere of radius 40 mm with an opening, with its pole at -y, cut off at y = 25 mm.
Vector3d bowl(double s, double f, double t) {
  const double r = 0.037 + 0.003 * t, angle = s * std::acos(-0.025 / r);
  return {r * std::sin(angle) * std::cos(f), -r * std::cos(angle), r * std::sin(angle) * std::sin(f)};
}

/// Returns a tube of radius 12 mm: 20 mm along x, a quarter turn of radius 35 mm, 20 mm up to z = 0.
Vector3d tube(double s, double f, double t) {
  constexpr double kLeg = 0.02, kBend = 0.035, kTurn = kBend * M_PI / 2;
  const double r = 0.009 + 0.003 * t, path = (1 - s) * (2 * kLeg + kTurn);
  const double bent = std::clamp(path - kLeg, 0.0, kTurn) / kBend, out = r * std::cos(f);
  const double x = kBend * (1 - std::cos(bent)) + std::max(path - kLeg - kTurn, 0.0);
  const double z = -std::min(path, kLeg) - kBend * std::sin(bent);
  return {x + out * std::cos(bent), r * std::sin(f), z + out * std::sin(bent)};
}

/// Returns half of a torus of radii 30 and 12 mm, both ends at y = 0.
Vector3d torus(double s, double f, double t) {
  const double r = 0.009 + 0.003 * t, around = M_PI / 2 * (1 - s), out = 0.03 + r * std::cos(f);
  const double y = std::abs(s) == 1 ? 0 : out * std::sin(around);
  return {out * std::cos(around), y, r * std::sin(f)};
}

/// Returns an ellipsoid of 28 x 28 x 60 mm, cut off at 45 mm, bent with a radius of 60 mm.
Vector3d stomach(double s, double f, double t) {
  static const auto straight = ellipsoid({0.028, 0.028, 0.06}, 0.004, kStomachCut);
  const Vector3d at = straight(s, f, t);
  const double bent = (kStomachCut - at.z()) / kStomachBend, out = kStomachBend - at.x();
  return {kStomachBend - out * std::cos(bent), at.y(), -out * std::sin(bent)};
}

/// Returns a clamp of everything at a plane and beyond. @param axis  of its normal
FixedConfig clampFrom(int axis, double at_m) {
  return clampBehind(at_m * Vector3d::Unit(axis), -Vector3d::Unit(axis));
}

/// Triangles of a mapped organ's surface: the faces of the box that is the map's domain.
class OrganSurface {
 public:
  explicit OrganSurface(const Organ& organ) : organ_(organ), round_(organ.f_high - organ.f_low > 2 * M_PI - 1e-9) {
    along_ = stepsOf([&](double q) { return position(q, 0.5, 1); });
    around_ = stepsOf([&](double q) { return position(0.7, q, 1); });
    for (int t = 0; t < 2; ++t)
      for (int i = 0; i <= along_; ++i)
        for (int j = 0; j <= around_; ++j)
          mesh_.positions_m.push_back(
              position(static_cast<double>(i) / along_, static_cast<double>(j) / around_, t).cast<float>());
    addWall();
    addEnds();
    if (signedVolume(mesh_) > 0) return;
    for (std::array<uint32_t, 3>& triangle : mesh_.triangles) std::swap(triangle[1], triangle[2]);
  }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  /// @param s, f  0 to 1 within their ranges
  Vector3d position(double s, double f, double t) const {
    return organ_.position(organ_.s_low + (1 - organ_.s_low) * s, organ_.f_low + (organ_.f_high - organ_.f_low) * f, t);
  }
  template <class Curve>
  static int stepsOf(const Curve& curve) {
    constexpr int kChords = 200;
    double length_m = 0;
    for (int k = 0; k < kChords; ++k)
      length_m += (curve((k + 1.0) / kChords) - curve(static_cast<double>(k) / kChords)).norm();
    return std::max(2, static_cast<int>(std::lround(length_m / kOrganEdge_m)));
  }
  uint32_t vertex(int i, int j, int t) const {
    if (round_) j %= around_;
    if (organ_.pole && i == 0) j = 0;
    return static_cast<uint32_t>((t * (along_ + 1) + i) * (around_ + 1) + j);
  }
  void addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    for (const std::array<uint32_t, 3>& t : {std::array<uint32_t, 3>{a, b, c}, std::array<uint32_t, 3>{a, c, d}}) {
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
    }
  }
  void addWall() {
    for (int i = 0; i < along_; ++i)
      for (int j = 0; j < around_; ++j) {
        addQuad(vertex(i, j, 1), vertex(i + 1, j, 1), vertex(i + 1, j + 1, 1), vertex(i, j + 1, 1));
        addQuad(vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0), vertex(i + 1, j, 0));
      }
  }
  void addEnds() {
    for (int j = 0; j < around_; ++j) {
      addQuad(vertex(along_, j, 1), vertex(along_, j, 0), vertex(along_, j + 1, 0), vertex(along_, j + 1, 1));
      if (!organ_.pole) addQuad(vertex(0, j, 0), vertex(0, j, 1), vertex(0, j + 1, 1), vertex(0, j + 1, 0));
    }
    if (round_) return;
    for (int i = 0; i < along_; ++i) {
      addQuad(vertex(i, 0, 0), vertex(i + 1, 0, 0), vertex(i + 1, 0, 1), vertex(i, 0, 1));
      addQuad(vertex(i, around_, 1), vertex(i + 1, around_, 1), vertex(i + 1, around_, 0), vertex(i, around_, 0));
    }
  }

  const Organ& organ_;
  bool round_;
  int along_, around_;
  TriangleMesh mesh_;
};

void writeMapped(const Organ& organ, std::ostream& out) {
  const OrganSurface surface(organ);
  out << "o " << organ.name << '\n';
  for (const Vector3f& at : surface.mesh().positions_m) out << "v " << at.x() << ' ' << at.y() << ' ' << at.z() << '\n';
  for (const std::array<uint32_t, 3>& t : surface.mesh().triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

/// @param first  number of vertices that are already in the file
void writeBlockPart(const char* name, const Vector3d& low_m, const Vector3d& high_m, int first, std::ostream& out) {
  out << "o " << name << '\n';
  for (int c = 0; c < 8; ++c) {
    out << 'v';
    for (int axis = 0; axis < 3; ++axis) out << ' ' << ((c >> axis & 1) ? high_m : low_m)[axis];
    out << '\n';
  }
  constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : kFaces) {
    out << "f " << first + q[0] + 1 << ' ' << first + q[1] + 1 << ' ' << first + q[2] + 1 << '\n'
        << "f " << first + q[0] + 1 << ' ' << first + q[2] + 1 << ' ' << first + q[3] + 1 << '\n';
  }
}

}  // namespace

const std::vector<Organ>& organs() {
  static const Vector3d down = -Vector3d::UnitZ(), left = -Vector3d::UnitX();
  static const std::vector<Organ> all = {
      {"bowl", "Bowl, wall 3 mm, half a sphere of radius 40 mm held at one side", 0.003, down, clampFrom(1, 0.025),
       bowl, 0, -M_PI, 0},
      {"bladder", "Bladder, wall 3 mm, ellipsoid of 36 x 32 x 28 mm held above 20 mm", 0.003, left, clampFrom(2, 0.02),
       ellipsoid({0.036, 0.032, 0.028}, 0.003, 0.02)},
      {"tube", "Bent tube, wall 3 mm, radius 12 mm", 0.003, down, clampFrom(2, 0), tube, 0, -M_PI, M_PI, false},
      {"ellipsoid", "Ellipsoid of 22 x 22 x 45 mm, wall 3 mm, held above 30 mm", 0.003, left, clampFrom(2, 0.03),
       ellipsoid({0.022, 0.022, 0.045}, 0.003, 0.03)},
      {"torus", "Half of a hollow torus of radii 30 and 12 mm, wall 3 mm, held at both ends", 0.003, down,
       clampBehind(Vector3d::Zero(), Vector3d::UnitY()), torus, -1, -M_PI, M_PI, false},
      {"stomach", "Stomach, wall 4 mm, ellipsoid of 28 x 28 x 60 mm bent by a radius of 60 mm, held at its upper end",
       0.004, left, clampFrom(2, 0), stomach},
      {"block",
       "Block of 60 x 40 x 30 mm, 2 kPa up to x = 4.3 mm and 20 kPa beyond, held at x = 30 mm",
       0.03,
       down,
       clampFrom(0, 0.03),
       {}},
  };
  return all;
}

OrganFile::OrganFile(const Organ& organ)
    : path_((std::filesystem::temp_directory_path() /
             ("viscera-" + std::string(organ.name) + "-" + std::to_string(getpid()) + ".obj"))
                .string()) {
  std::ofstream out(path_);
  out.precision(9);
  if (organ.position) {
    writeMapped(organ, out);
  } else {
    writeBlockPart("soft", {-0.03, -0.02, -0.015}, {kOrganBorder_m, 0.02, 0.015}, 0, out);
    writeBlockPart("stiff", {kOrganBorder_m, -0.02, -0.015}, {0.03, 0.02, 0.015}, 8, out);
  }
  if (!out.flush()) throw Error(path_ + ": cannot be written");
}

OrganFile::~OrganFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace viscera::bench
