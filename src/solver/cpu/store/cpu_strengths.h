// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "math/aligned.h"
#include "solver/cpu/store/cpu_store.h"
#include "solver/cpu/store/cpu_walls.h"
#include "solver/tissue/features.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// How strong springs and cells are and how heavy the nodes, as their bits in a store say.
struct CpuStrengths {
  /// @param store  that it is always used with   @param masses_kg  [slots] of explicit connections; empty without
  /// @throws SceneError  parts (strengths)
  CpuStrengths(const Model& model, const CpuStore& store, const FeatureSet& features,
               const std::vector<float>& masses_kg);

  /// Fits what is derived from a node's bits (stiffness of its even springs, mobility) to bits that have changed.
  void refresh(const CpuStore& store, uint32_t slot);
  void refreshAll(const CpuStore& store);
  /// Sum over the cells around a node of their positive bulks [J].
  float bulkAround(const CpuStore& store, uint32_t slot) const;

  AlignedVector<float> stiffness;      ///< [9 * slots] N/m of even springs (stiffnessAt); 0 cut or absent
  std::vector<float> left;             ///< [9 * slots] share of it that tearing has left (stiffnessAt); empty unless
                                       ///< tissue tears
  AlignedVector<float> mass;           ///< [slots] kg; 1 where no node is
  std::vector<float> surface_depth;    ///< [slots] m, surfaceDepths(); empty where there are none
  std::vector<uint32_t> surface_ways;  ///< [slots] surfaceWays(); empty where there are none
  AlignedVector<float> mobility;       ///< [slots] 1/kg of nodes that take part in a substep, held ones too; 0: absent,
                                       ///< fixed, alone
  AlignedVector<float> bulk;           ///< [slots] J of the cell above the node; 0 torn or absent; empty without a law
  AlignedVector<float> both_ends;      ///< [18 * slots] N/m of all springs, from either end (springAt() in kernels.h)
  AlignedVector<float> rigidity;  ///< [slots] J of the cell above the node (law.glsl); 0 torn, absent, or of springs;
                                  ///< empty without a law
  CpuWalls walls;                 ///< cells in thin walls, whose rigidity above is 0
  JoinedMoments moments;          ///< empty without
  std::vector<const float*> brick_moments;    ///< [bricks] [9 * 64] moments of its cells, number by number, the
                                              ///< those of LawMoments (law-inl.h); null where all are full; empty
                                              ///< without a law
  std::vector<const float*> brick_tensions;   ///< [bricks] [kTensionNumbers * 64] stress at rest of its cells over mu,
                                              ///< number by number; null where none has one; empty without a law
  std::vector<const float*> brick_laminates;  ///< [bricks] [kLaminateNumbers * 64] laminates of its cells, number by
                                              ///< number; null where none is of two materials; empty without a law
  std::vector<float*> broken;          ///< [bricks] [kBrokenNumbers * 64] stiffness times 4 h of the springs within
                                       ///< cells of a law that have lost one, number by number (kernels.h) [N];
                                       ///< null where all are whole; empty without a law
  std::vector<uint16_t> partial_rows;  ///< [bricks] bit r: some of the four cells from 4 r on is tissue in part
  std::vector<uint16_t> idle_cells;    ///< [bricks] bit r: the four cells from 4 r on never do anything to a node
                                       ///< that moves
  bool has_parts = false;              ///< some body has parts with elasticities of their own
  std::vector<uint8_t> uniform;     ///< [bricks] all springs of all its nodes are whole and of the body's full strength
  std::vector<uint16_t> idle_rows;  ///< [bricks] bit r: none of the four nodes from 4 r on will ever move

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
  float wholeRigidity(const CpuStore& store, uint32_t slot) const;
  void breakCells(const CpuStore& store, uint32_t slot);
  float* newBrokenPlanes();
  void setBroken(const CpuStore& store, uint32_t cell);
  void noteIdleRows();
  void noteCells(const CpuStore& store);
  bool isIdleRow(const CpuStore& store, uint32_t first) const;

  AlignedVector<float> moment_planes_;              ///< what brick_moments points to
  AlignedVector<float> tension_planes_;             ///< what brick_tensions points to
  AlignedVector<float> laminate_planes_;            ///< what brick_laminates points to
  std::vector<AlignedVector<float>> broken_slabs_;  ///< what broken points to: planes of kSlab bricks each
  size_t broken_bricks_ = 0;                        ///< how many there are
  Strengths table_;  ///< of models with parts, whose counts only say alive or cut; else empty
};

}  // namespace viscera
