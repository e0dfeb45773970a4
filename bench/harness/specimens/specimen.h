// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

/// A body for timing its steps. It drifts and oscillates, so every spring has a force, no value is denormal, and
/// nothing sleeps.
struct Specimen {
  std::string name;
  Model model;
  Scene scene;      ///< no gravity, stability monitor or tools; ticks of kSpecimenSubsteps
  HostState start;  ///< displacements and velocities at time 0

  size_t nodes() const { return model.activeNodes(); }
};
constexpr int kSpecimenSubsteps = 20;  ///< substeps per tick: one measurement per 20 substeps, as in live sessions

/// Returns the material for which rates are quoted: springs without drag and dashpot. @param stiffness_damping_ratio xi
MaterialConfig specimenMaterial(double stiffness_damping_ratio = 0);

/// Creates a solid cube with cell-assembled stiffness. @param nodes_per_edge  > 1
Specimen cubeOf(int nodes_per_edge, const MaterialConfig& material = specimenMaterial());
/// Creates a hollow heart. @param nodes  approximate number, met within 2 %
Specimen heartOf(int nodes, const MaterialConfig& material = specimenMaterial());

/// Returns the nodes per edge of the cube with the closest number of nodes.
int edgeOf(double nodes);
/// Returns the share of a body's bounding box that is filled with nodes, 0..1.
double filledShare(const Model& model);

/// Returns a scene with a heart of VR05's size as in sessions: gravity, stability monitor, fixed top, two styluses, a
/// camera. The values are those of config/scenes/pig_heart_size.yaml, but with springs as in the paper.
/// @param nodes  42745 is the paper's size
Scene pigHeartScene(int nodes, double stiffness_damping_ratio);

/// Returns the position of a deformed body's node that is farthest along a direction [m]. @param model  one body
Vector3d farthestNode(const Model& model, const HostState& state, const Vector3d& direction);
/// Returns a probe at rest. @param tip_m  position of its centre
ToolMotions probeAt(const Vector3d& tip_m);

/// Removes a spring from a state, at both ends, and marks the cells at its ends as broken.
/// @param nodes  [slots] of a model of one body
void cutSpring(const Lattice& lattice, uint32_t slot, uint32_t spring, std::vector<layout::NodeBits>& nodes);

/// Returns a state with a wave through the free nodes of a body, which drifts.
/// @param wave_m  amplitude   @param drift  factor; 1: as in specimens
HostState wobbling(const Model& model, double wave_m, double drift);

}  // namespace viscera::bench
