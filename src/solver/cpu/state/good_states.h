// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/state/cpu_lattice.h"

namespace viscera {

/// Ring of states that the stability monitor may restore. Holds every field with FieldRollBack::kUndo.
class CpuGoodStates {
 public:
  /// @param depth  number of states kept; 0: none
  explicit CpuGoodStates(size_t depth) : ring_(depth) {}
  void save(CpuLattice& lattice);
  /// Restores these fields, as SolverBackend::restoreGood().
  void restore(CpuLattice& lattice, int back);
  void clear() { kept_ = 0; }
  /// Saves or loads the ring.
  /// @throws Error  a saved state refers to an impossible good state, or belongs to other tissue
  void persist(Archive& archive, CpuLattice& lattice);

 private:
  using Bytes = std::vector<std::vector<char>>;  ///< [fields that are restored]
  static void allocate(CpuLattice& lattice, Bytes& state);
  std::vector<Bytes> ring_;
  int next_ = 0, kept_ = 0;
};

}  // namespace viscera
