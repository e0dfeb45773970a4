// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mappings that a scene can select (docs/surface.md), each compared with a float64 formula written from EGVE's
// equations, with normals carried in the interpolated one. Of a binding only its nodes are used.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "surface/follow/host_surface.h"
#include "surface/reference_mapping.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kMappingKindsSpacing_m = 0.01, kMappingKindsRadius_m = 0.05;
constexpr double kMappingKindsPosition_m =
    1e-6;  // float rounding of positions of up to 0.3 m, carried through directions
constexpr double kMappingKindsNormalError =
    2.0 / 511;  // a step of a packed normal per axis: rounding may go either way
const std::vector<Mapping> kAll = {Mapping::kOneToOne, Mapping::kConstant, Mapping::kInterpolated,
                                   Mapping::kAlongNormal};

class MappingKinds : public ::testing::Test {
 protected:
  gpu::Context context_;
};

Body mapped(const Solid& solid, const TriangleMesh& mesh, Mapping mapping) {
  Body body;
  body.lattice = buildLattice(solid, Weights::kCell);
  body.skin = bindSkin(mesh, body.lattice, solid, mapping);
  return body;
}
Body ball(Mapping mapping, const Vector3d& center_m = {0.01, 0.02, 0.03}) {
  return mapped(ballSolid(center_m, kMappingKindsRadius_m, kMappingKindsSpacing_m),
                sphereMesh(center_m, kMappingKindsRadius_m, 10), mapping);
}
Body partialBall(Mapping mapping) {
  const TriangleMesh mesh = weldedSphereMesh({0.01, 0.02, 0.03}, kMappingKindsRadius_m, 10);
  return mapped(voxeliseByMoments(mesh, kMappingKindsSpacing_m), mesh, mapping);
}
/// Returns a bar of 12 x 4 x 4 cells with a surface mesh 0.4 cells around it, as a smooth mesh of coarse cells has.
Body bar(Mapping mapping, int n = 24) {
  const Vector3d size = kMappingKindsSpacing_m * Vector3d(12, 4, 4),
                 around = Vector3d::Constant(0.4 * kMappingKindsSpacing_m);
  return mapped(blockSolid({12, 4, 4}, kMappingKindsSpacing_m), boxMesh(-around, size + around, n), mapping);
}

/// Returns a deformed position: bent and twisted, without symmetry; far less than would make normals ambiguous.
Vector3d mappingKindsDeformed(const Vector3d& x) {
  const double twist = 4 * x.z();
  return {1.1 * x.x() * std::cos(twist) - x.y() * std::sin(twist) + 2 * x.z() * x.z(),
          x.x() * std::sin(twist) + 0.95 * x.y() * std::cos(twist), 1.1 * x.z() + 0.1};
}
/// Bends to a circle around a line along y, above the bar.
Vector3d bent(const Vector3d& x) {
  constexpr double kBend_m = 8 * kMappingKindsSpacing_m;
  const double angle = (x.x() - 0.06) / kBend_m, radius = kBend_m - (x.z() - 0.02);
  return {radius * std::sin(angle), x.y(), kBend_m - radius * std::cos(angle)};
}

/// EGVE's equations over moved nodes.
class Egve {
 public:
  template <class Moved>
  Egve(const Body& body, Moved moved) : body_(body) {
    const Lattice& lattice = body.lattice;
    rest_.resize(lattice.nodes.size());
    now_.resize(lattice.nodes.size());
    for (const uint32_t slot : lattice.active_slots) {
      rest_[slot] = lattice.restPosition(slot);
      now_[slot] = moved(rest_[slot]);
    }
  }
  struct Vertex {
    Vector3d position, normal;
    bool clear = true;  ///< its nodes have approximate normals, at rest and now
  };
  Vertex map(Mapping mapping, size_t v, const Vector3d& vertex_normal) const {
    const layout::SkinBinding& s = body_.skin.bindings[v];
    const std::array<uint32_t, 3> node = {s.slot0, s.slot1, s.slot2};
    const Vector3d vertex = body_.skin.mesh.positions_m[v].cast<double>();
    Vertex out;
    for (const uint32_t slot : node)
      out.clear = out.clear && sumAt(rest_, slot).norm() > 0.75 && sumAt(now_, slot).norm() > 0.75;
    if (mapping == Mapping::kOneToOne) {
      out.position = now_[node[0]] + (vertex - rest_[node[0]]);
      out.normal = sumAt(now_, node[0]).normalized();
      return out;
    }
    const Vector3d e1 = rest_[node[1]] - rest_[node[0]], e2 = rest_[node[2]] - rest_[node[0]];
    // Eq 4: the nearest point of the face.
    double w1 = std::clamp((vertex - rest_[node[0]]).dot(e1) / e1.squaredNorm(), 0.0, 1.0),
           w2 = std::clamp((vertex - rest_[node[0]]).dot(e2) / e2.squaredNorm(), 0.0, 1.0);
    if (mapping == Mapping::kAlongNormal) {
      w1 = s.weights.y;  // 3.5 does not say how to find it; its correctness is tested at rest
      w2 = s.weights.z;
      const Vector3d normal = normalAt(now_, node, w1, w2);
      out.position = at(now_, node, w1, w2) + s.weights.w * normal;
      out.normal = normal;
      return out;
    }
    const Vector3d offset = vertex - at(rest_, node, w1, w2);
    const std::array<Vector3d, 3> then = basis(mapping, rest_, node, w1, w2), now = basis(mapping, now_, node, w1, w2);
    out.position = at(now_, node, w1, w2);
    out.normal = Vector3d::Zero();
    for (size_t i = 0; i < 3; ++i) {  // eqs 7 and 9
      out.position += offset.dot(then[i]) * now[i];
      out.normal += vertex_normal.dot(then[i]) * now[i];
    }
    return out;
  }
  Vector3d at(const std::vector<Vector3d>& p, const std::array<uint32_t, 3>& n, double w1, double w2) const {
    return (1 - w1 - w2) * p[n[0]] + w1 * p[n[1]] + w2 * p[n[2]];
  }
  /// Returns eq 3, without `normalize`.
  Vector3d sumAt(const std::vector<Vector3d>& p, uint32_t slot) const {
    Vector3d sum = Vector3d::Zero();
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      const int64_t other = body_.lattice.neighborSlot(slot, spring);
      if (springCount(body_.lattice.nodes[slot], spring)) sum += (p[slot] - p[static_cast<size_t>(other)]).normalized();
    }
    return sum;
  }
  /// Returns eq 8, first line, normalised, from the sums of eq 3.
  Vector3d normalAt(const std::vector<Vector3d>& p, const std::array<uint32_t, 3>& n, double w1, double w2) const {
    const std::array<double, 3> w = {1 - w1 - w2, w1, w2};
    Vector3d sum = Vector3d::Zero();
    for (size_t i = 0; i < 3; ++i) sum += w[i] * sumAt(p, n[i]).normalized();
    return sum.normalized();
  }
  /// Returns the same from eq 3 at rest, rotated with the tissue: half way between the normal of a plane with two
  /// tangents that follow the node's axial neighbours, and a fibre along the normal.
  Vector3d carriedAt(const std::vector<Vector3d>& p, const std::array<uint32_t, 3>& n, double w1, double w2) const {
    const std::array<double, 3> w = {1 - w1 - w2, w1, w2};
    Vector3d sum = Vector3d::Zero();
    for (size_t i = 0; i < 3; ++i) {
      const Vector3d normal = sumAt(rest_, n[i]).normalized(), tangent = normal.unitOrthogonal();
      const Vector3d plane = alongAt(p, n[i], tangent).cross(alongAt(p, n[i], normal.cross(tangent)));
      sum += w[i] * (plane.normalized() + alongAt(p, n[i], normal).normalized()).normalized();
    }
    return sum.normalized();
  }
  Vector3d alongAt(const std::vector<Vector3d>& p, uint32_t slot, const Vector3d& direction) const {
    Vector3d out = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const auto spring = static_cast<uint32_t>(2 * axis);
      const auto end = [&](uint32_t s) {
        return springCount(body_.lattice.nodes[slot], s) ? static_cast<size_t>(body_.lattice.neighborSlot(slot, s))
                                                         : slot;
      };
      const size_t ahead = end(spring), behind = end(spring + 1);
      out += direction[axis] * (p[ahead] - p[behind]) / (rest_[ahead] - rest_[behind]).norm();
    }
    return out;
  }
  const std::vector<Vector3d>& rest() const { return rest_; }

 private:
  /// Returns the basis of eq 6 or eq 8.
  std::array<Vector3d, 3> basis(Mapping mapping, const std::vector<Vector3d>& p, const std::array<uint32_t, 3>& n,
                                double w1, double w2) const {
    const Vector3d t = (p[n[1]] - p[n[0]]).normalized(), b_t = (p[n[2]] - p[n[0]]).normalized();
    const Vector3d normal = t.cross(b_t).normalized();
    if (mapping == Mapping::kConstant) return {t, normal, normal.cross(t)};
    const Vector3d n_c = carriedAt(p, n, w1, w2), b_c = n_c.cross(t).normalized();
    return {b_c.cross(n_c), n_c, b_c};
  }

  const Body& body_;
  std::vector<Vector3d> rest_, now_;
};

/// Returns whether a point is in the middle of the bar's two bent faces, away from edges, where normals of nodes are a
/// mean over faces.
bool isAbove(const Vector3d& rest) {
  return std::abs(rest.x() - 0.06) < 0.04 && std::abs(rest.y() - 0.02) < 0.01 && std::abs(rest.z() - 0.02) > 0.02;
}

VisibleMesh onHost(const SurfaceRig& rig) {
  HostSurface host(rig.model);
  StateSnapshot snapshot;
  snapshot.bricks = host.shownBricks();
  for (const uint32_t brick : snapshot.bricks) {
    const layout::vec4* const first = &rig.displacement_m[size_t{layout::kBrickSlots} * brick];
    for (float layout::vec4::*component : {&layout::vec4::x, &layout::vec4::y, &layout::vec4::z}) {
      for (uint32_t i = 0; i < layout::kBrickSlots; ++i) snapshot.displacement_m.push_back(first[i].*component);
    }
  }
  snapshot.nodes = rig.nodes;
  snapshot.spring_cut = rig.spring_cut;
  VisibleMesh out;
  host.show(snapshot, out);
  return out;
}

bool isAsAsked(Mapping mapping, const layout::SkinBinding& s) {
  if (mapping == Mapping::kInterpolated) return s.springs & layout::kInterpolatedBit;
  if (mapping == Mapping::kAlongNormal) return s.springs & layout::kAlongNormalBit;
  return true;
}

}  // namespace

TEST_F(MappingKinds, EachIsItsEquationsInFloat64OnBothBackends) {
  for (const Mapping mapping : kAll) {
    for (const bool partial : {false, true}) {
      SurfaceRig rig(partial ? partialBall(mapping) : ball(mapping));
      rig.moveNodes(mappingKindsDeformed);
      rig.follow();
      const Body& body = rig.model.bodies[0];
      const Egve egve(body, mappingKindsDeformed);
      const std::vector<Vector3f> rest_normals = vertexNormals(body.skin.mesh);
      const std::vector<Vector3d> positions = rig.positions(), normals = rig.normals();
      const VisibleMesh host = onHost(rig);
      size_t judged = 0;
      for (size_t v = 0; v < positions.size(); ++v) {
        ASSERT_EQ(body.skin.bindings[v].springs & layout::kInCellBit, 0u);
        const Mapping own = isAsAsked(mapping, body.skin.bindings[v]) ? mapping : Mapping::kConstant;
        const Egve::Vertex expected = egve.map(own, v, rest_normals[v].cast<double>());
        if (own != Mapping::kConstant && !expected.clear) continue;
        judged += own == mapping ? 1 : 0;
        ASSERT_LT((positions[v] - expected.position).norm(), kMappingKindsPosition_m)
            << int(mapping) << ", vertex " << v;
        ASSERT_LT((normals[v] - expected.normal).norm(), kMappingKindsNormalError) << int(mapping) << ", vertex " << v;
        ASSERT_LT((host.position_m(v).cast<double>() - expected.position).norm(), kMappingKindsPosition_m)
            << int(mapping);
        ASSERT_LT((unpackNormal(host.normals[v]).cast<double>() - expected.normal).norm(), kMappingKindsNormalError);
      }
      EXPECT_GT(judged, positions.size() / 2) << int(mapping) << (partial ? ", partial" : "");
    }
  }
}

TEST_F(MappingKinds, EachIsExactAtRest) {
  for (const Mapping mapping : kAll) {
    for (Body body : {ball(mapping), partialBall(mapping), bar(mapping)}) {
      SurfaceRig rig(std::move(body));
      rig.follow();
      const std::vector<Vector3d> positions = rig.positions();
      const VisibleMesh host = onHost(rig);
      for (size_t v = 0; v < positions.size(); ++v) {
        const Vector3d rest = rig.model.bodies[0].skin.mesh.positions_m[v].cast<double>();
        ASSERT_LT((positions[v] - rest).norm(), kMappingKindsPosition_m) << int(mapping) << ", vertex " << v;
        ASSERT_LT((host.position_m(v).cast<double>() - rest).norm(), kMappingKindsPosition_m)
            << int(mapping) << ", vertex " << v;
      }
    }
  }
}

TEST_F(MappingKinds, AlongNormalLiesOnTheNormalAtRest) {
  const Body body = ball(Mapping::kAlongNormal);
  const Egve egve(body, [](const Vector3d& x) { return x; });
  size_t along = 0;
  for (size_t v = 0; v < body.skin.bindings.size(); ++v) {
    const layout::SkinBinding& s = body.skin.bindings[v];
    if (!(s.springs & layout::kAlongNormalBit)) continue;
    ++along;
    const std::array<uint32_t, 3> node = {s.slot0, s.slot1, s.slot2};
    const Vector3d foot = egve.at(egve.rest(), node, s.weights.y, s.weights.z);
    const Vector3d offset = body.skin.mesh.positions_m[v].cast<double>() - foot;
    ASSERT_LT((offset - s.weights.w * egve.normalAt(egve.rest(), node, s.weights.y, s.weights.z)).norm(),
              kMappingKindsPosition_m);
  }
  EXPECT_GT(along, body.skin.bindings.size() / 2);
  EXPECT_EQ(along + body.skin.constant_vertices, body.skin.bindings.size());
}

TEST_F(MappingKinds, OneToOneDoesNotTurnItsOffsets) {
  const Eigen::AngleAxisd turn(1.2, Vector3d(1, -2, 0.7).normalized());
  const auto moved = [&](const Vector3d& x) { return Vector3d(turn * x); };
  const auto largestError = [&](Mapping mapping) {
    SurfaceRig rig(bar(mapping));
    rig.moveNodes(moved);
    rig.follow();
    const std::vector<Vector3d> positions = rig.positions();
    double largest = 0;
    for (size_t v = 0; v < positions.size(); ++v) {
      const Vector3d rest = rig.model.bodies[0].skin.mesh.positions_m[v].cast<double>();
      largest = std::max(largest, (positions[v] - moved(rest)).norm());
    }
    return largest;
  };
  for (const Mapping mapping : {Mapping::kConstant, Mapping::kInterpolated, Mapping::kAlongNormal})
    EXPECT_LT(largestError(mapping), kMappingKindsPosition_m) << int(mapping);
  // The longest offset is near 0.87 cells, rotated by 69 degrees: an error of at most 2 sin(34.4 degrees) of it.
  EXPECT_GT(largestError(Mapping::kOneToOne), 0.5 * kMappingKindsSpacing_m);
}

TEST_F(MappingKinds, OneToOneShadesByTheNodesAndNotByTheMesh) {
  SurfaceRig rig(ball(Mapping::kOneToOne));
  rig.follow();
  const std::vector<Vector3f> mesh_normals = vertexNormals(rig.model.bodies[0].skin.mesh);
  const std::vector<Vector3d> normals = rig.normals();
  double sum = 0;
  for (size_t v = 0; v < normals.size(); ++v)
    sum += std::acos(std::min(1.0, normals[v].dot(mesh_normals[v].cast<double>())));
  const double mean = sum / static_cast<double>(normals.size());
  EXPECT_GT(mean, 0.05);  // rad: stairs are visible
  EXPECT_LT(mean, 0.5);   // and yet normals point outward
}

/// Constant bases separate neighbours of two triangles (EGVE figure 5); interpolated ones keep them together.
TEST_F(MappingKinds, ConstantHasJumpsUnderBendingWhereInterpolatedHasNone) {
  const auto largestJumps = [&](Mapping mapping) {
    SurfaceRig rig(bar(mapping, 96));
    rig.moveNodes(bent);
    rig.follow();
    const std::vector<Vector3d> positions = rig.positions(), normals = rig.normals();
    const Skin& skin = rig.model.bodies[0].skin;
    double position = 0, angle = 0;
    for (const auto& t : skin.mesh.triangles) {
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t a = t[i], b = t[(i + 1) % 3];
        const Vector3d rest_a = skin.mesh.positions_m[a].cast<double>(),
                       rest_b = skin.mesh.positions_m[b].cast<double>();
        if (!isAbove(rest_a) || !isAbove(rest_b)) continue;
        position = std::max(position, ((positions[b] - positions[a]) - (bent(rest_b) - bent(rest_a))).norm());
        angle = std::max(angle, std::atan2(normals[a].cross(normals[b]).norm(), normals[a].dot(normals[b])));
      }
    }
    return std::array<double, 2>{position / kMappingKindsSpacing_m, angle};
  };
  const auto constant = largestJumps(Mapping::kConstant), interpolated = largestJumps(Mapping::kInterpolated);
  EXPECT_GT(constant[0], 0.03);  // cells: 0.4 of offset times 1/8 rad between two triangles is 0.05
  EXPECT_LT(interpolated[0], constant[0] / 2);
  EXPECT_GT(constant[1], 0.1);  // rad of the 1/8
  EXPECT_LT(interpolated[1], constant[1] / 2);
}

TEST_F(MappingKinds, WoundsOfEachAreShutAtRestAndClosedWhenOpened) {
  for (const Mapping mapping : kAll) {
    const TriangleMesh mesh = weldedSphereMesh({0.01, 0.02, 0.03}, kMappingKindsRadius_m, 10);
    Body body = mapped(ballSolid({0.01, 0.02, 0.03}, kMappingKindsRadius_m, kMappingKindsSpacing_m), mesh, mapping);
    body.skin.can_be_cut = true;
    SurfaceRig rig(std::move(body));
    const Lattice& lattice = rig.model.bodies[0].lattice;
    const auto side = [](const Vector3d& x) { return x.x() > 0.0123; };
    const std::vector<layout::NodeBits> before = rig.nodes;
    cutBetween(lattice, side, rig.nodes);
    std::vector<float> axial_cut(3 * rig.nodes.size());
    for (const uint32_t slot : lattice.active_slots) {
      if (springCount(before[slot], 0) && !springCount(rig.nodes[slot], 0))
        axial_cut[3 * slot] = static_cast<float>((0.0123 - lattice.restPosition(slot).x()) / kMappingKindsSpacing_m);
    }
    rig.surface.wound({rig.nodes, {}, axial_cut}, 1);
    rig.follow();
    const std::vector<Vector3d> still = rig.positions();
    for (size_t v = 0; v < rig.model.bodies[0].skin.bindings.size(); ++v)
      ASSERT_LT((still[v] - rig.model.bodies[0].skin.mesh.positions_m[v].cast<double>()).norm(),
                kMappingKindsPosition_m);
    rig.moveNodes([&](const Vector3d& x) {
      return Vector3d(mappingKindsDeformed(x) + (side(x) ? 0.02 : 0) * Vector3d::UnitX());
    });
    rig.follow();
    const std::vector<Vector3d> opened = rig.positions();
    std::map<std::pair<std::array<int64_t, 3>, std::array<int64_t, 3>>, int> balance;
    const auto key = [&](uint32_t v) {
      const Vector3d at = opened[v] / kMappingKindsPosition_m;
      return std::array<int64_t, 3>{std::llround(at.x()), std::llround(at.y()), std::llround(at.z())};
    };
    const auto topology = rig.surface.skin().shown(rig.surface.alive().read().data(), rig.surface.wounds().get());
    ASSERT_GT(topology->triangles.size(), 3 * rig.surface.triangles());
    for (size_t t = 0; t < topology->triangles.size(); t += 3) {
      for (size_t i = 0; i < 3; ++i) {
        const auto a = key(topology->triangles[t + i]), b = key(topology->triangles[t + (i + 1) % 3]);
        if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    }
    for (const auto& [edge, sum] : balance) ASSERT_EQ(sum, 0) << int(mapping);
  }
}
