// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/buffer.h"
#include "solver/gpu/buffers/wall_buffers.h"
#include "solver/tissue/cut_record.h"
#include "solver/tissue/features.h"
#include "solver/tissue/joined_network.h"
#include "solver/tissue/state_fields.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/model.h"

namespace viscera {

class Archive;

/// The nodes and their arrangement.
struct StoreBuffers {
  /// @param bodies  [bodies] material constants
  StoreBuffers(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);
  void bind() const;
  void reset();
  /// Saves or loads node bits.
  /// @throws Error  the nodes of a saved state are not of this tissue
  void persistNodes(Archive& archive);

  size_t active_count, slot_count;
  gpu::Buffer<uint32_t> active;            ///< [active]
  gpu::Buffer<layout::Brick> bricks;       ///< [bricks]
  gpu::Buffer<layout::BodyParams> bodies;  ///< [bodies]
  gpu::Buffer<layout::NodeBits> nodes;     ///< [slots]
  gpu::Buffer<uint32_t> cells;             ///< [cells] slots of the lowest corners of cells; feature volume

 private:
  std::vector<layout::NodeBits> whole_nodes_;
  gpu::TexelView brick_texels_;
};

/// Strengths of springs and cells, and masses of nodes, if the counts of springs do not determine them.
struct StrengthBuffers {
  /// @param masses_kg  [slots] of explicit connections; empty without
  /// @throws SceneError  parts (strengths)
  StrengthBuffers(const Model& model, const FeatureSet& features, const std::vector<float>& masses_kg);
  void bind() const;

  gpu::Buffer<float> spring_stiffness;  ///< [9 * slots] N/m, in planes; feature parts
  gpu::Buffer<float> node_mass;  ///< [slots] kg; features parts, network; [2 * slots] interleaved with surfaceDepths()
  gpu::Buffer<layout::vec4>
      cell_strengths;  ///< [slots] x bulk, y rigidity [J], z index of moments, w index of stress; features parts, law
  gpu::Buffer<layout::vec4> cell_moments;  ///< JoinedMoments::vectors; features parts, law
  gpu::Buffer<uint32_t> surface_offsets;   ///< [slots] surfaceOffsets(), or 0 everywhere; features parts, law
  WallBuffers walls;                       ///< feature walls

 private:
  void writeMoments(const Model& model, const FeatureSet& features, const Strengths& table);
  gpu::TexelView spring_texels_, mass_texels_, bulk_texels_, moment_texels_;
};

/// Motion of all nodes as two states: one is current, the other is the last or the next one.
struct StateBuffers {
  StateBuffers(size_t slots, const FeatureSet& features);
  /// Binds the current state as input and the other one as output.
  void bind() const;
  /// Makes the output state the current one. Rebinds only what changes.
  void swap();

  gpu::Buffer<layout::vec4> displacement[2];  ///< [slots] m
  gpu::Buffer<layout::vec4> velocity[2];      ///< [slots] m/s
  gpu::Buffer<layout::vec4> compensation;     ///< [2 * slots] m, m/s; feature compensated
  int current = 0;

 private:
  void bindBoth() const;
  gpu::TexelView displacement_texels_[2], velocity_texels_[2];
};

/// State of grips and impulses of styluses, feature tools; and impulses of obstacles.
struct ToolBuffers {
  ToolBuffers(size_t slots, const FeatureSet& features);
  void bind() const;

  gpu::Buffer<layout::vec4> grab_offsets;       ///< [slots] m, stylus frame
  gpu::Buffer<layout::vec4> impulses;           ///< [kMaxStyluses * slots] N s
  gpu::Buffer<layout::vec4> obstacle_impulses;  ///< [obstacles * slots] N s
};

/// Explicit connections; feature network.
struct LinkBuffers {
  LinkBuffers(const Model& model, const FeatureSet& features);
  void bind() const;
  /// Restores all links except those that are cut.
  /// @param cut  [springs] as in CutSprings
  void writeSpringCut(const std::vector<float>& cut);

  JoinedNetwork network;                    ///< intact links, as on the host; empty without
  gpu::Buffer<layout::vec4> rest;           ///< [slots] m
  gpu::Buffer<uint32_t> link_starts;        ///< [slots + 1]
  gpu::Buffer<layout::Link> links;          ///< [2 * springs]
  gpu::Buffer<layout::SpringEnds> springs;  ///< [springs]
  gpu::Buffer<float> spring_cut;            ///< [springs]

 private:
  gpu::TexelView rest_texels_, start_texels_, link_texels_;
};

/// The nodes of all bodies in GPU memory with all their data. All kernels of the solver work on it.
struct LatticeBuffers {
  /// @param bodies  [bodies] material constants
  /// @param features  determine which optional buffers exist
  LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);

  /// Binds the buffers that all kernels share, with the current state as input and the other one as output.
  void bind() const;
  void swap() { state.swap(); }
  /// Resets to the rest state with intact springs and no grips.
  void reset();
  /// Calls visit(StateField, buffer) for the state that a scene has, except node bits and cut links, which follow from
  /// the springs.
  template <class Visit>
  void visitState(const Visit& visit) {
    const auto there = [&](const StateField& field, auto& buffer) {
      if (buffer.size()) visit(field, buffer);
    };
    there(fields::kDisplacement, state.displacement[state.current]);
    there(fields::kVelocity, state.velocity[state.current]);
    there(fields::kOtherState, state.displacement[1 - state.current]);
    there(fields::kOtherState, state.velocity[1 - state.current]);
    there(fields::kRoundingErrors, state.compensation);
    there(fields::kAxialCut, axial_cut);
    there(fields::kCutSides, cut_sides);
    there(fields::kGrabOffsets, tools.grab_offsets);
    there(fields::kImpulses, tools.impulses);
    there(fields::kImpulses, tools.obstacle_impulses);
  }
  /// Clears the fields that a roll-back clears.
  void clearRolledBack();
  void persist(Archive& archive);                                               ///< waits
  std::vector<float> readAxialCut(const std::vector<float>& spring_cut) const;  ///< both as in CutSprings; waits
  void writeAxialCut(const std::vector<float>& cut);                            ///< as in CutSprings; empty: all intact
  void writeSpringCut(const std::vector<float>& cut) { links.writeSpringCut(cut); }

  StoreBuffers store;
  LinkBuffers links;
  StrengthBuffers strengths;
  StateBuffers state;
  ToolBuffers tools;
  CutRecord record;
  gpu::Buffer<layout::vec4> cut_sides;   ///< [slots] if there is axial_cut: see shaders/solver/tools/cut_sides.glsl
  gpu::Buffer<float> axial_cut;          ///< [record.size()] of implicit lattices; features cuts, lattice
  gpu::Buffer<layout::TickStats> stats;  ///< [1]
  gpu::Buffer<layout::vec4>
      cell_forces;  ///< [8 * slots] N, see shaders/solver/tissue/cell_forces.comp; feature law; [11 * slots] with walls

 private:
  gpu::TexelView cell_force_texels_;
};

}  // namespace viscera
