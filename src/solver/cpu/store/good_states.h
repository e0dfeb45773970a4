// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/store/cpu_lattice.h"

namespace viscera {

/// States that the stability monitor may put back, in a ring: of every field with FieldRollBack::kUndo.
class CpuGoodStates {
 public:
  /// @param depth  how many are kept; 0: none ever
  explicit CpuGoodStates(size_t depth) : ring_(depth) {}
  void save(CpuLattice& lattice);
  /// As SolverBackend::restoreGood(), of these fields alone.
  void restore(CpuLattice& lattice, int back);
  void clear() { kept_ = 0; }
  /// @throws Error  a saved state names a good state that there cannot be, or is of other tissue
  void persist(Archive& archive, CpuLattice& lattice);

 private:
  using Bytes = std::vector<std::vector<char>>;  ///< [fields that go back]
  static void allocate(CpuLattice& lattice, Bytes& state);
  std::vector<Bytes> ring_;
  int next_ = 0, kept_ = 0;
};

}  // namespace viscera
