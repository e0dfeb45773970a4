// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/lattice_buffers.h"

#include <utility>

#include "viscera/solver/material.h"

namespace viscera {

namespace {

std::vector<uint32_t> activeSlots(const Model& model) {
  std::vector<uint32_t> out;
  out.reserve(model.activeNodes());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (uint32_t slot : model.bodies[b].lattice.active_slots) out.push_back(model.slotOffset(b) + slot);
  }
  return out;
}

std::vector<layout::Brick> allBricks(const Model& model) {
  std::vector<layout::Brick> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const uint32_t first = static_cast<uint32_t>(out.size());
    for (layout::Brick brick : model.bodies[b].lattice.bricks) {
      brick.body = static_cast<uint32_t>(b);
      for (uint32_t& neighbor : brick.neighbors) neighbor += first;
      out.push_back(brick);
    }
  }
  return out;
}

std::vector<layout::NodeBits> allNodes(const Model& model) {
  std::vector<layout::NodeBits> out;
  out.reserve(model.slots());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (layout::NodeBits bits : model.bodies[b].lattice.nodes) {
      bits.hi |= static_cast<uint32_t>(b) << layout::kBodyShift;
      out.push_back(bits);
    }
  }
  return out;
}

}  // namespace

LatticeBuffers::LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& params,
                               const FeatureSet& features)
    : active_count(model.activeNodes()),
      slot_count(model.slots()),
      active(activeSlots(model)),
      bricks(allBricks(model)),
      bodies(layout::kMaxBodies),
      nodes(slot_count),
      stats(1),
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
  if (features.compensated) compensation = gpu::Buffer<layout::vec4>(2 * slot_count);
  if (features.tools) {
    grab_offsets = gpu::Buffer<layout::vec4>(slot_count);
    impulses = gpu::Buffer<layout::vec4>(slot_count * layout::kMaxStyluses);
  }
  bodies.write(params);
  nodes.write(whole_nodes_);
}

void LatticeBuffers::allocateVolume(const Model& model) {
  std::vector<uint32_t> slots;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    for (uint32_t slot : lattice.active_slots) {
      if (lattice.nodes[slot].lo & layout::kCellBit) slots.push_back(model.slotOffset(b) + slot);
    }
  }
  cells = gpu::Buffer<uint32_t>(slots);
  cell_forces = gpu::Buffer<layout::vec4>(3 * slot_count);
  cell_force_texels_ = gpu::TexelView(cell_forces.raw(), gpu::TexelFormat::kRgba32f);
}

void LatticeBuffers::allocateParts(const Model& model) {
  std::vector<float> springs, masses, bulks;
  for (const Body& body : model.bodies) {
    const Strengths table = strengths(body);
    springs.insert(springs.end(), table.spring_n_per_m.begin(), table.spring_n_per_m.end());
    masses.insert(masses.end(), table.mass_kg.begin(), table.mass_kg.end());
    bulks.insert(bulks.end(), table.bulk_j.begin(), table.bulk_j.end());
  }
  spring_stiffness = gpu::Buffer<float>(springs);
  node_mass = gpu::Buffer<float>(masses);
  cell_bulk = gpu::Buffer<float>(bulks);
  spring_texels_ = gpu::TexelView(spring_stiffness.raw(), gpu::TexelFormat::kR32f);
  mass_texels_ = gpu::TexelView(node_mass.raw(), gpu::TexelFormat::kR32f);
  bulk_texels_ = gpu::TexelView(cell_bulk.raw(), gpu::TexelFormat::kR32f);
}

void LatticeBuffers::bind() const {
  active.bindStorage(layout::kBindActive);
  bricks.bindStorage(layout::kBindBricks);
  bodies.bindUniform(layout::kBindBodies);
  nodes.bindStorage(layout::kBindNodes);
  displacement[current].bindStorage(layout::kBindDisplacementIn);
  velocity[current].bindStorage(layout::kBindVelocityIn);
  displacement[1 - current].bindStorage(layout::kBindDisplacementOut);
  velocity[1 - current].bindStorage(layout::kBindVelocityOut);
  stats.bindStorage(layout::kBindStats);
  brick_texels_.bind(layout::kUnitBricks);
  displacement_texels_[current].bind(layout::kUnitDisplacement);
  velocity_texels_[current].bind(layout::kUnitVelocity);
  if (cells.size()) {
    cells.bindStorage(layout::kBindCells);
    cell_forces.bindStorage(layout::kBindCellForces);
    cell_force_texels_.bind(layout::kUnitCellForces);
  }
  if (spring_stiffness.size()) {
    spring_texels_.bind(layout::kUnitSpringStiffness);
    mass_texels_.bind(layout::kUnitNodeMass);
    bulk_texels_.bind(layout::kUnitCellBulk);
  }
  if (compensation.size()) compensation.bindStorage(layout::kBindCompensation);
  if (grab_offsets.size()) grab_offsets.bindStorage(layout::kBindGrabOffsets);
  if (impulses.size()) impulses.bindStorage(layout::kBindImpulses);
}

void LatticeBuffers::reset() {
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
