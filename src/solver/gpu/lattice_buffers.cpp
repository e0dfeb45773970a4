// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/lattice_buffers.h"

#include <utility>

#include "layout/bindings.h"
#include "layout/edge_forces.h"
#include "solver/joined_lattice.h"

namespace viscera {

LatticeBuffers::LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& params,
                               const FeatureSet& features)
    : active_count(model.activeNodes()),
      slot_count(model.slots()),
      active(activeSlots(model)),
      bricks(allBricks(model)),
      bodies(layout::kMaxBodies),
      nodes(slot_count),
      stats(1),
      network(joinNetworks(model)),
      edge_forces(features.edge_forces ? orderByOwner(network) : EdgeForces{}),
      whole_nodes_(allNodes(model)) {
  for (int i = 0; i < 2; ++i) {
    displacement[i] = gpu::Buffer<layout::vec4>(slot_count);
    velocity[i] = gpu::Buffer<layout::vec4>(slot_count);
    displacement_texels_[i] = gpu::TexelView(displacement[i].raw(), gpu::TexelFormat::kRgba32f);
    velocity_texels_[i] = gpu::TexelView(velocity[i].raw(), gpu::TexelFormat::kRgba32f);
  }
  brick_texels_ = gpu::TexelView(bricks.raw(), gpu::TexelFormat::kR32ui);
  if (features.volume) allocateVolume(model);
  if (features.parts) allocateParts(model);
  if (features.network) allocateNetwork();
  if (features.edge_forces) allocateEdgeForces();
  if (features.compensated) compensation = gpu::Buffer<layout::vec4>(2 * slot_count);
  if (features.tools) {
    grab_offsets = gpu::Buffer<layout::vec4>(slot_count);
    impulses = gpu::Buffer<layout::vec4>(slot_count * layout::kMaxStyluses);
  }
  bodies.write(params);
  nodes.write(whole_nodes_);
}

void LatticeBuffers::allocateVolume(const Model& model) {
  cells = gpu::Buffer<uint32_t>(cellSlots(model));
  cell_forces = gpu::Buffer<layout::vec4>(3 * slot_count);
  cell_force_texels_ = gpu::TexelView(cell_forces.raw(), gpu::TexelFormat::kRgba32f);
}

void LatticeBuffers::allocateParts(const Model& model) {
  const Strengths table = allStrengths(model);
  spring_stiffness = gpu::Buffer<float>(table.spring_n_per_m);
  if (network.masses_kg.empty()) node_mass = gpu::Buffer<float>(table.mass_kg);
  cell_bulk = gpu::Buffer<float>(table.bulk_j);
  spring_texels_ = gpu::TexelView(spring_stiffness.raw(), gpu::TexelFormat::kR32f);
  if (node_mass.size()) mass_texels_ = gpu::TexelView(node_mass.raw(), gpu::TexelFormat::kR32f);
  bulk_texels_ = gpu::TexelView(cell_bulk.raw(), gpu::TexelFormat::kR32f);
}

void LatticeBuffers::allocateNetwork() {
  node_mass = gpu::Buffer<float>(network.masses_kg);
  rest = gpu::Buffer<layout::vec4>(network.rest_m);
  link_starts = gpu::Buffer<uint32_t>(network.starts);
  links = gpu::Buffer<layout::Link>(network.links);
  springs = gpu::Buffer<layout::SpringEnds>(network.springs);
  spring_cut = gpu::Buffer<float>(network.springs.size());
  mass_texels_ = gpu::TexelView(node_mass.raw(), gpu::TexelFormat::kR32f);
  rest_texels_ = gpu::TexelView(rest.raw(), gpu::TexelFormat::kRgba32f);
  start_texels_ = gpu::TexelView(link_starts.raw(), gpu::TexelFormat::kR32ui);
  link_texels_ = gpu::TexelView(links.raw(), gpu::TexelFormat::kRgba32ui);
}

void LatticeBuffers::allocateEdgeForces() {
  link_runs = gpu::Buffer<layout::uvec4>(edge_forces.links);
  start_texels_ = gpu::TexelView(link_runs.raw(), gpu::TexelFormat::kRgba32ui);
  spring_owners = gpu::Buffer<layout::SpringOwner>(edge_forces.owners);
  force_starts = gpu::Buffer<uint32_t>(edge_forces.starts);
  link_forces = gpu::Buffer<layout::vec4>(edge_forces.places());
  owner_texels_ = gpu::TexelView(spring_owners.raw(), gpu::TexelFormat::kRgba32ui);
  force_start_texels_ = gpu::TexelView(force_starts.raw(), gpu::TexelFormat::kR32ui);
  link_force_texels_ = gpu::TexelView(link_forces.raw(), gpu::TexelFormat::kRgba32f);
}

void LatticeBuffers::writeSpringCut(const std::vector<float>& cut) {
  if (network.springs.empty()) return;
  std::vector<layout::Link> now = network.links;
  eraseSprings(cut, network.springs, now);
  links.write(now);
  spring_cut.clear();
  spring_cut.write(cut);
}

/// Two calls, as this is done after every substep.
void LatticeBuffers::bindState() const {
  const int next = 1 - current;
  gpu::bindStorages(layout::kBindDisplacementIn,
                    {displacement[current].id(), velocity[current].id(), displacement[next].id(), velocity[next].id()});
  gpu::bindTexels(layout::kUnitDisplacement, {displacement_texels_[current].id(), velocity_texels_[current].id()});
}

void LatticeBuffers::swap() {
  current = 1 - current;
  bindState();
}

void LatticeBuffers::bind() const {
  bindState();
  active.bindStorage(layout::kBindActive);
  bricks.bindStorage(layout::kBindBricks);
  bodies.bindUniform(layout::kBindBodies);
  nodes.bindStorage(layout::kBindNodes);
  stats.bindStorage(layout::kBindStats);
  brick_texels_.bind(layout::kUnitBricks);
  if (cells.size()) {
    cells.bindStorage(layout::kBindCells);
    cell_forces.bindStorage(layout::kBindCellForces);
    cell_force_texels_.bind(layout::kUnitCellForces);
  }
  if (spring_stiffness.size()) {
    spring_texels_.bind(layout::kUnitSpringStiffness);
    bulk_texels_.bind(layout::kUnitCellBulk);
  }
  if (node_mass.size()) mass_texels_.bind(layout::kUnitNodeMass);
  if (rest.size()) bindNetwork();
  if (compensation.size()) compensation.bindStorage(layout::kBindCompensation);
  if (grab_offsets.size()) grab_offsets.bindStorage(layout::kBindGrabOffsets);
  if (impulses.size()) impulses.bindStorage(layout::kBindImpulses);
}

void LatticeBuffers::bindNetwork() const {
  links.bindStorage(layout::kBindLinks);
  springs.bindStorage(layout::kBindSprings);
  spring_cut.bindStorage(layout::kBindSpringCut);
  rest.bindStorage(layout::kBindRest);
  rest_texels_.bind(layout::kUnitRest);
  start_texels_.bind(layout::kUnitLinkStarts);
  link_texels_.bind(layout::kUnitLinks);
  if (!force_starts.size()) return;
  owner_texels_.bind(layout::kUnitSpringOwners);
  force_start_texels_.bind(layout::kUnitForceStarts);
  link_forces.bindStorage(layout::kBindLinkForces);
  link_force_texels_.bind(layout::kUnitLinkForces);
}

void LatticeBuffers::reset() {
  writeSpringCut({});
  nodes.write(whole_nodes_);
  for (int i = 0; i < 2; ++i) {
    displacement[i].clear();
    velocity[i].clear();
  }
  if (grab_offsets.size()) grab_offsets.clear();
  if (impulses.size()) impulses.clear();
  if (compensation.size()) compensation.clear();
  stats.clear();
  current = 0;
}

}  // namespace viscera
