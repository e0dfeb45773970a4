// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/mapped_body.h"

#include <cmath>
#include <utility>

namespace viscera::bench {

std::string nameOf(Mapping mapping) {
  switch (mapping) {
    case Mapping::kOneToOne:
      return "one_to_one";
    case Mapping::kConstant:
      return "constant";
    case Mapping::kInterpolated:
      return "interpolated";
    case Mapping::kAlongNormal:
      return "along_normal";
    default:
      return "auto";
  }
}

const std::vector<Mapping>& allMappings() {
  static const std::vector<Mapping> all = {Mapping::kOneToOne, Mapping::kConstant, Mapping::kInterpolated,
                                           Mapping::kAlongNormal, Mapping::kAuto};
  return all;
}

Model mappedModel(const Solid& solid, const TriangleMesh& mesh, Mapping mapping) {
  Body body;
  body.name = "mapped";
  body.lattice = buildLattice(solid, Weights::kCell);
  body.skin = bindSkin(mesh, body.lattice, solid, mapping);
  Model model;
  model.bodies.push_back(std::move(body));
  return model;
}

double shareAsAsked(const Model& model) {
  const Skin& skin = model.bodies[0].skin;
  return 1 - static_cast<double>(skin.constant_vertices) / static_cast<double>(skin.bindings.size());
}

StateSnapshot movedState(const Model& model, const std::vector<uint32_t>& bricks, const Deformation& deformation) {
  const Lattice& lattice = model.bodies[0].lattice;
  std::vector<Vector3f> u_m(model.slots(), Vector3f::Zero());
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d rest = lattice.restPosition(slot);
    u_m[slot] = (deformation(rest) - rest).cast<float>();
  }
  StateSnapshot out;
  out.bricks = bricks;
  for (const uint32_t brick : bricks) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < layout::kBrickSlots; ++i)
        out.displacement_m.push_back(u_m[size_t{layout::kBrickSlots} * brick + i][axis]);
    }
  }
  out.nodes = lattice.nodes;
  return out;
}

TriangleMesh closedMesh(int around, int up, const std::function<Vector3d(const Vector3d& direction)>& position) {
  TriangleMesh mesh;
  mesh.part_names = {"skin"};
  const auto add = [&](const Vector3d& direction) { mesh.positions_m.push_back(position(direction).cast<float>()); };
  add(-Vector3d::UnitZ());
  for (int j = 1; j < up; ++j) {
    const double polar = M_PI * j / up;
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * M_PI * i / around;
      add({std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), -std::cos(polar)});
    }
  }
  add(Vector3d::UnitZ());
  const auto at = [&](int ring, int i) { return static_cast<uint32_t>(1 + (ring - 1) * around + i % around); };
  const auto last = static_cast<uint32_t>(mesh.positions_m.size() - 1);
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
    mesh.triangles.push_back({last, at(up - 1, i), at(up - 1, i + 1)});
    for (int j = 1; j + 1 < up; ++j) {
      mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j + 1, i)});
    }
  }
  mesh.parts.assign(mesh.triangles.size(), 0);
  return mesh;
}

}  // namespace viscera::bench
