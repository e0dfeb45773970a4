// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/buffers/lattice_buffers.h"

#include <string>

#include "gpu/archive.h"
#include "gpu/limits.h"
#include "layout/bindings.h"
#include "layout/law.h"
#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/restored_nodes.h"

namespace viscera {

StoreBuffers::StoreBuffers(const Model& model, const std::vector<layout::BodyParams>& params,
                           const FeatureSet& features)
    : active_count(movingSlots(model).size()),
      slot_count(model.slots()),
      active(movingSlots(model), "active nodes"),
      bricks(allBricks(model), "bricks"),
      bodies(layout::kMaxBodies),
      nodes(slot_count, "nodes"),
      whole_nodes_(allNodes(model)),
      brick_texels_(bricks.raw(), gpu::TexelFormat::kR32ui) {
  if (features.law) cells = gpu::Buffer<uint32_t>(cellSlots(model), "cells");
  bodies.write(params);
  nodes.write(whole_nodes_);
}

void StoreBuffers::bind() const {
  active.bindStorage(layout::kBindActive);
  bricks.bindStorage(layout::kBindBricks);
  bodies.bindUniform(layout::kBindBodies);
  nodes.bindStorage(layout::kBindNodes);
  brick_texels_.bind(layout::kUnitBricks);
  if (cells.size()) cells.bindStorage(layout::kBindCells);
}

void StoreBuffers::reset() {
  nodes.write(whole_nodes_);
}

void StoreBuffers::persistNodes(Archive& archive) {
  std::vector<layout::NodeBits> bits = archive.reads() ? whole_nodes_ : nodes.read();
  archive.values(bits);
  if (!archive.reads()) return;
  requireNodesOf(whole_nodes_, bodies.read(), bits, archive);
  nodes.write(bits);
}

namespace {

/// Interleaves masses and depths.
std::vector<float> inTurn(const std::vector<float>& masses_kg, const std::vector<float>& depths_m) {
  std::vector<float> out;
  for (size_t slot = 0; slot < masses_kg.size(); ++slot) out.insert(out.end(), {masses_kg[slot], depths_m[slot]});
  return out;
}

/// Rearranges arrays with `planes` numbers per slot as inPlanes() of lattice.glsl expects.
std::vector<float> inPlanes(const std::vector<float>& by_slot, size_t planes) {
  std::vector<float> out(by_slot.size());
  for (size_t i = 0; i < by_slot.size(); ++i) {
    const size_t slot = i / planes, brick = slot / layout::kBrickSlots;
    out[(brick * planes + i % planes) * layout::kBrickSlots + slot % layout::kBrickSlots] = by_slot[i];
  }
  return out;
}

}  // namespace

StrengthBuffers::StrengthBuffers(const Model& model, const FeatureSet& features, const std::vector<float>& masses_kg) {
  const std::vector<float> depths_m = surfaceDepths(model);
  std::vector<float> masses = masses_kg;
  if (features.parts) {
    const Strengths table = allStrengths(model);
    spring_stiffness = gpu::Buffer<float>(inPlanes(table.spring_n_per_m, kSpringPairs), "spring stiffness");
    if (features.law) writeMoments(model, features, table);
    if (masses.empty()) masses = table.mass_kg;
    spring_texels_ = gpu::TexelView(spring_stiffness.raw(), gpu::TexelFormat::kR32f);
  }
  if (masses.empty()) return;
  node_mass = gpu::Buffer<float>(depths_m.empty() ? masses : inTurn(masses, depths_m), "node mass");
  mass_texels_ = gpu::TexelView(node_mass.raw(), depths_m.empty() ? gpu::TexelFormat::kR32f : gpu::TexelFormat::kRg32f);
}

void StrengthBuffers::writeMoments(const Model& model, const FeatureSet& features, const Strengths& table) {
  const JoinedMoments moments = allMoments(model);
  std::vector<layout::vec4> cells(table.bulk_j.size());
  for (size_t slot = 0; slot < cells.size(); ++slot) {
    const uint32_t stress = moments.stress_of_cell.empty() ? 0 : moments.stress_of_cell[slot];
    cells[slot] = {table.bulk_j[slot], table.rigidity_j[slot], static_cast<float>(moments.of_cell[slot]),
                   static_cast<float>(stress)};
  }
  cell_strengths = gpu::Buffer<layout::vec4>(cells, "cell strengths");
  cell_moments = gpu::Buffer<layout::vec4>(moments.vectors, "cell moments");
  std::vector<uint32_t> offsets = surfaceOffsets(model);
  offsets.resize(model.slots(), 0);
  surface_offsets = gpu::Buffer<uint32_t>(offsets, "ways to the surface");
  bulk_texels_ = gpu::TexelView(cell_strengths.raw(), gpu::TexelFormat::kRgba32f);
  moment_texels_ = gpu::TexelView(cell_moments.raw(), gpu::TexelFormat::kRgba32f);
  if (features.walls) walls = WallBuffers(model, moments);
}

void StrengthBuffers::bind() const {
  if (spring_stiffness.size()) {
    spring_texels_.bind(layout::kUnitSpringStiffness);
    if (cell_strengths.size()) bulk_texels_.bind(layout::kUnitCellBulk);
    if (gpu::driverLimits().loads) {  // other drivers have texel buffers only, which may be longer
      spring_stiffness.bindStorage(layout::kBindSpringStiffness);
      if (cell_strengths.size()) cell_strengths.bindStorage(layout::kBindCellStrengths);
    }
  }
  if (cell_moments.size()) {
    moment_texels_.bind(layout::kUnitCellMoments);
    surface_offsets.bindStorage(layout::kBindSurfaceOffsets);
    walls.bind();
  }
  if (node_mass.size()) mass_texels_.bind(layout::kUnitNodeMass);
}

StateBuffers::StateBuffers(size_t slots, const FeatureSet& features) {
  for (int i = 0; i < 2; ++i) {
    displacement[i] = gpu::Buffer<layout::vec4>(slots, "displacement");
    velocity[i] = gpu::Buffer<layout::vec4>(slots, "velocity");
    displacement[i].raw().requireBlock();
    displacement_texels_[i] = gpu::TexelView(displacement[i].raw(), gpu::TexelFormat::kRgba32f);
    velocity_texels_[i] = gpu::TexelView(velocity[i].raw(), gpu::TexelFormat::kRgba32f);
  }
  if (features.compensated) compensation = gpu::Buffer<layout::vec4>(2 * slots, "compensation");
}

/// Binds both states with two calls, as this happens after every substep.
void StateBuffers::bindBoth() const {
  const int next = 1 - current;
  gpu::bindStorages(layout::kBindDisplacementIn,
                    {displacement[current].id(), velocity[current].id(), displacement[next].id(), velocity[next].id()});
  gpu::bindTexels(layout::kUnitDisplacement, {displacement_texels_[current].id(), velocity_texels_[current].id()});
}

void StateBuffers::bind() const {
  bindBoth();
  if (compensation.size()) compensation.bindStorage(layout::kBindCompensation);
}

void StateBuffers::swap() {
  current = 1 - current;
  bindBoth();
}

ToolBuffers::ToolBuffers(size_t slots, const FeatureSet& features) {
  if (features.obstacles > 0) {
    obstacle_impulses = gpu::Buffer<layout::vec4>(slots * features.obstacles, "impulses of obstacles");
  }
  if (!features.tools) return;
  grab_offsets = gpu::Buffer<layout::vec4>(slots, "grab offsets");
  impulses = gpu::Buffer<layout::vec4>(slots * layout::kMaxStyluses, "impulses");
}

void ToolBuffers::bind() const {
  if (grab_offsets.size()) grab_offsets.bindStorage(layout::kBindGrabOffsets);
  if (impulses.size()) impulses.bindStorage(layout::kBindImpulses);
  if (obstacle_impulses.size()) obstacle_impulses.bindStorage(layout::kBindObstacleImpulses);
}

LatticeBuffers::LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& params,
                               const FeatureSet& features)
    : store(model, params, features),
      links(model, features),
      strengths(model, features, links.network.masses_kg),
      state(store.slot_count, features),
      tools(store.slot_count, features),
      record(model, links.network, features),
      stats(1, "measurements") {
  if (features.lattice && record.size() > 0) {
    axial_cut = gpu::Buffer<float>(record.size(), "record of cuts");
    cut_sides = gpu::Buffer<layout::vec4>(record.size() / 3, "sides of cuts");
    cut_sides.clear();
  }
  if (features.law) {
    const size_t vectors = layout::kCellVectors + (features.walls ? layout::kRowVectors : 0);
    cell_forces = gpu::Buffer<layout::vec4>(vectors * store.slot_count, "cell forces");
    cell_force_texels_ = gpu::TexelView(cell_forces.raw(), gpu::TexelFormat::kRgba32f);
  }
  bind();  // reports buffers that are too large for the driver at once
}

void LatticeBuffers::bind() const {
  state.bind();
  store.bind();
  stats.bindStorage(layout::kBindStats);
  if (cell_forces.size()) {
    cell_forces.bindStorage(layout::kBindCellForces);
    cell_force_texels_.bind(layout::kUnitCellForces);
  }
  strengths.bind();
  links.bind();
  tools.bind();
  if (!axial_cut.size()) return;
  axial_cut.bindStorage(layout::kBindAxialCut);
  cut_sides.bindStorage(layout::kBindCutSides);
}

std::vector<float> LatticeBuffers::readAxialCut(const std::vector<float>& spring_cut) const {
  std::vector<float> out = axial_cut.size() ? axial_cut.read() : std::vector<float>(record.size());
  record.addExplicit(spring_cut, out);
  return out;
}

void LatticeBuffers::persist(Archive& archive) {
  archive.section("springs");
  store.persistNodes(archive);
  std::vector<float> spring_cut = links.spring_cut.read();
  archive.values(spring_cut);
  if (archive.reads()) links.writeSpringCut(spring_cut);
  std::string section;
  visitState([&](const StateField& field, auto& buffer) {
    if (section != field.section) archive.section(section = field.section);
    gpu::persist(archive, buffer);
  });
  archive.section("measurements");
  gpu::persist(archive, stats);
}

void LatticeBuffers::writeAxialCut(const std::vector<float>& cut) {
  if (!axial_cut.size()) return;
  axial_cut.clear();
  cut_sides.clear();
  if (!cut.empty()) axial_cut.write(cut);
}

void LatticeBuffers::reset() {
  links.writeSpringCut({});
  store.reset();
  visitState([](const StateField&, auto& buffer) { buffer.clear(); });  // the whole state on the GPU is 0 at rest
  state.current = 0;
  stats.clear();
}

void LatticeBuffers::clearRolledBack() {
  visitState([](const StateField& field, auto& buffer) {
    if (field.roll_back == FieldRollBack::kClear) buffer.clear();
  });
}

}  // namespace viscera
