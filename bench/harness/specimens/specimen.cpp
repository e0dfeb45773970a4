// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/specimen.h"

#include "bench/harness/specimens/clamp.h"

#include <cmath>

namespace viscera::bench {

namespace {

constexpr double kSpacing_m = 0.003;  // for cubes of every size, so that the substep is the same
constexpr double kWave = 0.02;        // amplitude over spacing
constexpr double kNumber = 0.7;       // wave number in radians per spacing: the wave is nine spacings long

/// Drift velocity: no component is zero, and none grows far during a measurement.
const Vector3d kDrift_m_per_s(0.05, 0.03, 0.02);

Scene specimenScene(const Model& model) {
  return plainScene(model, kSpecimenSubsteps);
}

Specimen specimenOf(const std::string& name, Model model) {
  Specimen out{name, std::move(model), {}, {}};
  out.scene = specimenScene(out.model);
  out.start = wobbling(out.model, kWave * out.model.bodies[0].lattice.spacing_m, 1);
  return out;
}

BodyConfig heartBody(int nodes) {
  BodyConfig body;
  body.name = "heart";
  body.source = TissueSource::kPhantom;
  body.phantom_wall_scale = 0.6;
  body.target_nodes = nodes;
  return body;
}

}  // namespace

MaterialConfig specimenMaterial(double stiffness_damping_ratio) {
  MaterialConfig material;
  material.mass_damping_per_s = 0;  // the drift must continue
  material.stiffness_damping_ratio = stiffness_damping_ratio;
  material.law = Law::kSprings;
  return material;
}

HostState wobbling(const Model& model, double wave_m, double drift) {
  HostState state = restState(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    for (uint32_t local : lattice.active_slots) {
      const Vector3d phase = kNumber * lattice.nodeAt(local).cast<double>();
      const uint32_t slot = model.slotOffset(b) + local;
      if (isFixed(lattice.nodes[local])) continue;
      state.displacement_m[slot] = vec4(
          wave_m * Vector3d(std::sin(phase.y() + phase.z() + 1), std::sin(phase.z() + 2), std::sin(phase.x() + 3)));
      state.velocity_m_per_s[slot] = vec4(drift * kDrift_m_per_s);
    }
  }
  return state;
}

Specimen cubeOf(int nodes_per_edge, const MaterialConfig& material) {
  return specimenOf("cube", blockModel(Vector3i::Constant(nodes_per_edge - 1), kSpacing_m, material));
}

Specimen heartOf(int nodes, const MaterialConfig& material) {
  Scene scene;
  scene.bodies.push_back(heartBody(nodes));
  scene.bodies[0].material = material;
  return specimenOf("heart", buildModel(scene));
}

int edgeOf(double nodes) {
  return static_cast<int>(std::lround(std::cbrt(nodes)));
}

double filledShare(const Model& model) {
  return static_cast<double>(model.activeNodes()) / model.bodies[0].lattice.nodes_per_axis.cast<double>().prod();
}

Scene pigHeartScene(int nodes, double stiffness_damping_ratio) {
  Scene scene;
  scene.name = "pig_heart_size";
  scene.bodies.push_back(heartBody(nodes));
  scene.bodies[0].material.stiffness_damping_ratio = stiffness_damping_ratio;
  scene.bodies[0].material.law = Law::kSprings;  // as in the paper
  scene.bodies[0].fixed.push_back(clampAbove(0.03));
  scene.styluses.resize(2);
  scene.styluses[0].name = "left";
  scene.styluses[1].name = "right";
  CameraConfig camera;
  camera.position_m = Vector3d(-0.11, -0.29, 0.05);
  camera.target_m = Vector3d(0, 0, -0.003);
  camera.vertical_fov_deg = 28;
  scene.cameras.push_back(camera);
  return scene;
}

Vector3d farthestNode(const Model& model, const HostState& state, const Vector3d& direction) {
  const Lattice& lattice = model.bodies[0].lattice;
  const auto positionOf = [&](uint32_t slot) -> Vector3d {
    return lattice.restPosition(slot) + xyz(state.displacement_m[slot]);
  };
  Vector3d best = positionOf(lattice.active_slots[0]);
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d at = positionOf(slot);
    if (at.dot(direction) > best.dot(direction)) best = at;
  }
  return best;
}

void cutSpring(const Lattice& lattice, uint32_t slot, uint32_t spring, std::vector<layout::NodeBits>& nodes) {
  const uint32_t far = static_cast<uint32_t>(lattice.neighborSlot(slot, spring));
  setSpringCount(nodes[slot], spring, 0);
  setSpringCount(nodes[far], oppositeSpring(spring), 0);
  for (uint32_t end : {slot, far}) nodes[end].lo = (nodes[end].lo | layout::kSeveredBit) & ~layout::kCellBit;
}

ToolMotions probeAt(const Vector3d& tip_m) {
  ToolMotions motions;
  motions[0].mode = ToolMode::kProbe;
  motions[0].present = true;
  motions[0].from.position_m = motions[0].to.position_m = tip_m;
  return motions;
}

}  // namespace viscera::bench
