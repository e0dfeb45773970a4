// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "math/aligned.h"
#include "solver/cpu/state/cpu_store.h"
#include "solver/cpu/state/cpu_walls.h"
#include "solver/tissue/features.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Strengths of springs and cells, and masses of nodes, derived from the node bits of a store.
struct CpuStrengths {
  /// @param store  the one of all later calls
  /// @param masses_kg  [slots] of explicit connections; empty without
  /// @throws SceneError  parts (strengths)
  CpuStrengths(const Model& model, const CpuStore& store, const FeatureSet& features,
               const std::vector<float>& masses_kg);

  /// Updates the values that are derived from a node's bits (stiffness of its even springs, mobility) after a change of
  /// these.
  void refresh(const CpuStore& store, uint32_t slot);
  void refreshAll(const CpuStore& store);
  /// Returns the sum of the positive bulks of the cells around a node [J].
  float bulkAround(const CpuStore& store, uint32_t slot) const;

  AlignedVector<float> stiffness;  ///< [9 * slots] N/m of even springs (stiffnessAt); 0 if cut or absent
  std::vector<float> left;  ///< [9 * slots] share of it that tearing has left (stiffnessAt); empty unless tissue tears
  AlignedVector<float> mass;              ///< [slots] kg; 1 where there is no node
  std::vector<float> surface_depth;       ///< [slots] m, surfaceDepths(); empty where there are none
  std::vector<uint32_t> surface_offsets;  ///< [slots] surfaceOffsets(); empty where there are none
  AlignedVector<float> mobility;   ///< [slots] 1/kg of nodes that take part in a substep, including held ones; 0 if
                                   ///< absent, fixed or isolated
  AlignedVector<float> bulk;       ///< [slots] J of the cell above the node; 0 if torn or absent; empty without a law
  AlignedVector<float> both_ends;  ///< [18 * slots] N/m of all springs, from either end (springAt() in kernels.h)
  AlignedVector<float> rigidity;   ///< [slots] J of the cell above the node (law.glsl); 0 if torn, absent, or of
                                   ///< springs; empty without a law
  CpuWalls walls;                  ///< cells in thin walls; their rigidity above is 0
  JoinedMoments moments;           ///< of partly filled and laminated cells and of prestress; empty without
  std::vector<const float*> brick_moments;   ///< [bricks] [9 * 64] moments of its cells, number by number, those of
                                             ///< LawMoments (law-inl.h); null where all are full; empty without a law
  std::vector<const float*> brick_tensions;  ///< [bricks] [kTensionNumbers * 64] prestress of its cells over mu, number
                                             ///< by number; null where none has one; empty without a law
  std::vector<const float*> brick_laminates;  ///< [bricks] [kLaminateNumbers * 64] laminates of its cells, number by
                                              ///< number; null where none has two materials; empty without a law
  /// [bricks] [kBrokenNumbers * 64] N, stiffness times 4 h of the springs within cells of a law that have lost one,
  /// number by number (kernels.h); null where all are intact; empty without a law.
  std::vector<float*> broken;
  std::vector<uint16_t> partial_rows;  ///< [bricks] bit r: at least one of the four cells from 4 r on is partly filled
  std::vector<uint16_t> idle_cells;    ///< [bricks] bit r: the four cells from 4 r on never act on a node that moves
  bool has_parts = false;              ///< at least one body has parts with their own elasticities
  std::vector<uint8_t> uniform;        ///< [bricks] 1: all springs of all nodes are intact and have full strength
  std::vector<uint16_t> idle_rows;     ///< [bricks] bit r: none of the four nodes from 4 r on can ever move

 private:
  float springStiffness(const CpuStore& store, uint32_t slot, uint32_t pair) const;
  float cellBulk(const CpuStore& store, uint32_t slot) const;
  float cellRigidity(const CpuStore& store, uint32_t slot) const;
  bool hasSoftened(const CpuStore& store, uint32_t slot) const;
  bool isFull(const CpuStore& store, uint32_t slot) const;
  void spreadMoments(const CpuStore& store);
  void spreadTensions(const CpuStore& store);
  void spreadLaminates(const CpuStore& store);
  void refreshWalls(const CpuStore& store, uint32_t slot);
  void refreshGhosts(const CpuStore& store, uint32_t slot);
  float wholeRigidity(const CpuStore& store, uint32_t slot) const;
  void breakCells(const CpuStore& store, uint32_t slot);
  float* newBrokenPlanes();
  void setBroken(const CpuStore& store, uint32_t cell);
  void recordIdleRows();
  void recordCells(const CpuStore& store);
  bool isIdleRow(const CpuStore& store, uint32_t first) const;

  AlignedVector<float> moment_planes_;              ///< storage of brick_moments
  AlignedVector<float> tension_planes_;             ///< storage of brick_tensions
  AlignedVector<float> laminate_planes_;            ///< storage of brick_laminates
  std::vector<AlignedVector<float>> broken_slabs_;  ///< storage of `broken`: planes of kSlabBricks bricks each
  size_t broken_bricks_ = 0;                        ///< number of bricks with planes there
  Strengths table_;  ///< of models with parts, where counts only show intact or cut; otherwise empty
};

}  // namespace viscera
