// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/scan/surface_net.h"

namespace viscera::test {

constexpr double kTurnsDeg[3] = {30, 24, 17};      ///< rotation of phantoms against the voxels: nothing is aligned
constexpr double kOffCentre[3] = {.31, .17, .43};  ///< offset of the phantom's centre from a voxel's [voxels]

/// Shape with an analytical surface. Lengths in mm.
struct NetPhantom {
  std::function<double(const Vector3d&)> distance;  ///< negative inside
  double volume;
  int euler;
  Vector3d half;                                ///< half edges of a box around it
  std::function<int(const Vector3d&)> label{};  ///< empty: 1 inside

  int labelAt(const Vector3d& p) const { return label ? label(p) : distance(p) < 0 ? 1 : 0; }
};

inline NetPhantom ballPhantom() {
  return {[](const Vector3d& p) { return p.norm() - 12; }, 4 * M_PI / 3 * 1728, 2, Vector3d::Constant(12)};
}

/// Returns a tube of radius 10 and length 28.
inline NetPhantom tubePhantom(double wall) {
  const auto distance = [wall](const Vector3d& p) {
    const double across = std::abs(p.head<2>().norm() - 10) - wall / 2, along = std::abs(p.z()) - 14;
    return std::hypot(std::max(across, 0.), std::max(along, 0.)) + std::min(0., std::max(across, along));
  };
  return {distance, 2 * M_PI * 10 * wall * 28, 0, {10 + wall, 10 + wall, 14}};
}

inline double boxDistance(const Vector3d& p, const Vector3d& half) {
  const Vector3d q = p.cwiseAbs() - half;
  return q.cwiseMax(0).norm() + std::min(0., q.maxCoeff());
}

inline NetPhantom platePhantom(double thickness) {
  const auto distance = [thickness](const Vector3d& p) { return boxDistance(p, {12, thickness / 2, 9}); };
  return {distance, 24 * thickness * 18, 2, {12, thickness, 9}};
}

/// Returns the distance to three capsules that meet.
inline double vesselDistance(const Vector3d& p) {
  const auto capsule = [&](const Vector3d& a, const Vector3d& b, double radius) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
    return (p - a - t * (b - a)).norm() - radius;
  };
  const Vector3d fork = Vector3d::Zero();
  return std::min({capsule({0, 0, -14}, fork, 4), capsule(fork, {8, 1, 12}, 2.7), capsule(fork, {-7, 3, 13}, 2.2)});
}

inline NetPhantom vesselPhantom() {
  const Vector3d half(12, 8, 20);
  static const double volume = [&] {
    // Spacing of samples, which count as shares of their cells: an error of at most 1e-3 of the volume.
    constexpr double h = 0.2;
    double sum = 0;
    for (double z = -half.z() + h / 2; z < half.z(); z += h) {
      for (double y = -half.y() + h / 2; y < half.y(); y += h) {
        for (double x = -half.x() + h / 2; x < half.x(); x += h) {
          sum += std::clamp(0.5 - vesselDistance({x, y, z}) / h, 0., 1.);
        }
      }
    }
    return sum * h * h * h;
  }();
  return {vesselDistance, volume, 2, half};
}

/// Returns one of two balls of R 10 at x = -8 and 8, each ending at the plane x = 0, where they touch in a disc.
inline NetPhantom touchingBalls(int which) {
  const double side = which == 1 ? -1 : 1;
  const auto ball = [](const Vector3d& p, double middle) { return (p - Vector3d(middle, 0, 0)).norm() - 10; };
  NetPhantom out{[=](const Vector3d& p) { return std::max(ball(p, 8 * side), -side * p.x()); },
                 4 * M_PI / 3 * 1000 - M_PI * 4 * (30 - 2) / 3,
                 2,
                 {18, 10, 10}};
  out.label = [=](const Vector3d& p) {
    const int label = p.x() < 0 ? 1 : 2;
    return ball(p, label == 1 ? -8 : 8) < 0 ? label : 0;
  };
  return out;
}

/// Returns a frame with voxels around the phantom and a margin; its axes have these directions, each as long as the
/// spacing.
inline VolumeFrame frameAround(const NetPhantom& phantom, const Vector3d& spacing_mm, const Matrix3d& directions) {
  VolumeFrame frame;
  frame.axes = directions * (spacing_mm / 1000).asDiagonal();
  const Matrix3d to_voxels = frame.axes.inverse() / 1000;
  const Vector3d reach = to_voxels.cwiseAbs() * phantom.half;
  for (int a = 0; a < 3; ++a) frame.size[a] = 2 * static_cast<int>(std::ceil(reach[a] + 4)) + 1;
  const Vector3d middle(frame.size.x() / 2 + kOffCentre[0], frame.size.y() / 2 + kOffCentre[1],
                        frame.size.z() / 2 + kOffCentre[2]);
  frame.origin = -(frame.axes * middle);
  return frame;
}

inline Matrix3d turned() {
  return rotationFromDegrees({kTurnsDeg[0], kTurnsDeg[1], kTurnsDeg[2]}).toRotationMatrix();
}

inline Vector3d positionMm(const VolumeFrame& frame, const Vector3d& voxel) {
  return 1000 * (frame.axes * voxel + frame.origin);
}

/// Calls visit(voxel number, position in mm) for all voxels.
template <class Visit>
void forEachVoxel(const VolumeFrame& frame, Visit visit) {
  size_t at = 0;
  for (int k = 0; k < frame.size.z(); ++k) {
    for (int j = 0; j < frame.size.y(); ++j) {
      for (int i = 0; i < frame.size.x(); ++i) visit(at++, positionMm(frame, Vector3d(i, j, k)));
    }
  }
}

inline LabelVolume sampled(const NetPhantom& phantom, const VolumeFrame& frame) {
  LabelVolume volume{frame, std::vector<uint8_t>(frame.voxels()), {{0, ""}, {1, "one"}, {2, "two"}}};
  forEachVoxel(frame, [&](size_t at, const Vector3d& p) { volume.labels[at] = phantom.labelAt(p); });
  return volume;
}

/// Deviation of a label's surface from the true one. Lengths in voxels (cube root of a voxel's volume).
struct NetScore {
  double rms = 0, largest = 0;
  double volume_percent = 0;
  double normals_deg = 0;  ///< RMS over the area, except where the true surface has an edge
};

inline NetScore score(const SurfaceNet& net, uint8_t label, const NetPhantom& phantom, double voxel_mm) {
  NetScore out;
  double area = 0, smooth_area = 0;
  const auto gradient = [&](const Vector3d& p, double h) {
    Vector3d g;
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = h * Vector3d::Unit(a);
      g[a] = (phantom.distance(p + step) - phantom.distance(p - step)) / (2 * h);
    }
    return g;
  };
  for (size_t i = 0; i < net.triangles.size(); ++i) {
    if (net.sides[i][0] != label && net.sides[i][1] != label) continue;
    const auto& t = net.triangles[i];
    const Vector3d a = 1000 * net.positions_m[t[0]], b = 1000 * net.positions_m[t[1]], c = 1000 * net.positions_m[t[2]];
    const Vector3d n = (net.sides[i][0] == label ? 0.5 : -0.5) * (b - a).cross(c - a), middle = (a + b + c) / 3;
    const double d = phantom.distance(middle);
    out.rms += n.norm() * d * d;
    area += n.norm();
    out.largest = std::max(out.largest, std::abs(d) / voxel_mm);
    const double fine = 0.02 * voxel_mm;
    const Vector3d on_surface = middle - d * gradient(middle, fine);
    constexpr double kOfAnEdge = 0.97;  // of the gradient over most of a voxel, which is 1 where the surface is smooth
    if (n.norm() < 1e-9 || gradient(on_surface, 0.6 * voxel_mm).norm() < kOfAnEdge) continue;
    const Vector3d truth = gradient(on_surface, fine).normalized();
    const double angle = std::acos(std::clamp(n.normalized().dot(truth), -1., 1.));
    out.normals_deg += n.norm() * angle * angle;
    smooth_area += n.norm();
  }
  out.rms = std::sqrt(out.rms / area) / voxel_mm;
  out.normals_deg = std::sqrt(out.normals_deg / smooth_area) * 180 / M_PI;
  out.volume_percent = 100 * (net.volumeM3(label) * 1e9 / phantom.volume - 1);
  return out;
}

/// Topology of a closed surface, from its edges.
struct NetTopology {
  int euler = 0;
  size_t open = 0;      ///< edges with unequal numbers of triangles in both directions
  size_t touching = 0;  ///< edges of four triangles
};

inline NetTopology topology(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, std::pair<int, int>> edges;
  std::vector<bool> used(mesh.positions_m.size(), false);
  for (const auto& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = t[c], b = t[(c + 1) % 3];
      auto& [net, count] = edges[std::minmax(a, b)];
      net += a < b ? 1 : -1;
      ++count;
      used[a] = true;
    }
  }
  NetTopology out;
  for (const auto& [ends, found] : edges) {
    out.open += found.first != 0;
    out.touching += found.second == 4;
  }
  out.euler = static_cast<int>(std::count(used.begin(), used.end(), true)) - static_cast<int>(edges.size()) +
              static_cast<int>(mesh.triangles.size());
  return out;
}

}  // namespace viscera::test
