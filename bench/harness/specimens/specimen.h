// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

/// A body whose stepping is timed. It drifts and wobbles, so that every spring works, none of its numbers is a denormal
/// one, and nothing may sleep.
struct Specimen {
  std::string name;
  Model model;
  Scene scene;      ///< no gravity, no governor, no tools; ticks of kSpecimenSubsteps
  HostState start;  ///< displacements and velocities of time 0

  size_t nodes() const { return model.activeNodes(); }
};
constexpr int kSpecimenSubsteps = 20;  ///< per tick: one pass of measurement in 20 substeps, as live sessions have it

/// Springs alone, without drag and dashpot: what rates are quoted for. @param dashpot_ratio  xi
MaterialConfig specimenMaterial(double dashpot_ratio = 0);

/// A solid cube, cell-assembled. @param nodes_per_edge  > 1
Specimen cubeOf(int nodes_per_edge, const MaterialConfig& material = specimenMaterial());
/// A hollow heart. @param nodes  wanted; met within 2 %
Specimen heartOf(int nodes, const MaterialConfig& material = specimenMaterial());

/// Nodes per edge of the cube that comes nearest to a number of nodes.
int edgeOf(double nodes);
/// Share of a body's bounding box that is nodes, 0..1.
double filledShare(const Model& model);

/// The heart of VR05's size in a scene as sessions have it: gravity, governor, fixed top, two styluses, a camera; the
/// values of config/scenes/pig_heart_size.yaml, but of springs, as the paper's is. @param nodes  42745 is the size
Scene pigHeartScene(int nodes, double dashpot_ratio);

/// The place of a deformed body that lies farthest along a direction [m]. @param model  one body
Vector3d farthestNode(const Model& model, const HostState& state, const Vector3d& direction);
/// A probe at rest. @param tip_m  its centre
ToolMotions probeAt(const Vector3d& tip_m);

/// Takes a spring out of a state, from both ends, and marks the cells at its ends as broken.
/// @param nodes  [slots] of a model of one body
void cutSpring(const Lattice& lattice, uint32_t slot, uint32_t spring, std::vector<layout::NodeBits>& nodes);

/// A wave through the free nodes of a body, which drifts. @param wave_m  amplitude   @param drift  1: as specimens do
HostState wobbling(const Model& model, double wave_m, double drift);

}  // namespace viscera::bench
