// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>

#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/node_pairs.h"
#include "solver/cpu/state/cpu_stepper.h"
#include "solver/device/device.h"

/// Probes and obstacles. They have no effect in scenes without any.
#define WITH_EVERY_CONTACT WITH_CONTACT | WITH_TOOLS | WITH_OBSTACLES

namespace viscera {

namespace glsl {

/// Buffers and uniforms of the kernels of implicit Euler (shaders/solver/implicit/implicit.glsl, implicit_*.comp,
/// pd.comp).
struct ImplicitBuffers : PairBuffers {
  Word* guard = nullptr;
  const vec4* increment = nullptr;
  vec4* increments = nullptr;  // the same buffer, writable
  vec4* next_increments = nullptr;
  vec4* node_contacts = nullptr;
  uint contact_rows = 0;
  vec4* energies = nullptr;
  uint iteration = 0, bound_energy = 0, first_sweep = 0, ends_sweep = 0;
  float omega = 1;
};

struct ImplicitKernel : Kernel, ImplicitBuffers {
  using Kernel::Kernel;
};

}  // namespace glsl

/// Bricks per job: large enough to be worth dispatching, and independent of the number of threads.
constexpr size_t kBricksPerJob = 4;
constexpr size_t kNodesPerJob = kBricksPerJob * layout::kBrickSlots;  ///< at most

inline size_t nodeJobs(const CpuLattice& lattice) {
  return (lattice.brickCount() + kBricksPerJob - 1) / kBricksPerJob;
}

/// Runs a kernel's invocations from `first` until before `end`.
template <class Kernel>
__attribute__((flatten)) void runRange(Kernel& kernel, size_t first, size_t end) {
  for (size_t i = first; i < end; ++i) {
    kernel.index = static_cast<uint32_t>(i);
    kernel.main();
  }
}

/// Returns the range of a job's nodes in `active`.
inline std::array<size_t, 2> nodesOfJob(const CpuLattice& lattice, size_t job) {
  return {lattice.store.first_active[job * kBricksPerJob],
          lattice.store.first_active[std::min((job + 1) * kBricksPerJob, lattice.brickCount())]};
}

/// Runs a kernel for every active node.
template <class Kernel>
void runNodes(const Parallel& parallel, const CpuLattice& lattice, const Kernel& kernel) {
  parallel(nodeJobs(lattice), [&](size_t job) {
    Kernel mine = kernel;
    const auto range = nodesOfJob(lattice, job);
    runRange(mine, range[0], range[1]);
  });
}

/// The CPU as a device (solver/device/device.h).
class CpuDevice {
 public:
  struct Stepper : CpuStepper {
    virtual void run(CpuLattice& lattice, const Substep& step) = 0;
    void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* of_substep) final {
      motions = of_substep;
      run(lattice, step);
    }
    const layout::ToolMotion* motions = nullptr;  ///< of this substep
  };
  using Lattice = CpuLattice;
  using vec4 = glsl::vec4;
  using Word = glsl::Word;

  template <class T>
  class Field : public std::vector<T> {
   public:
    explicit Field(size_t count, const char* = "", bool = false) : std::vector<T>(count) {}
    void clear() { std::fill(this->begin(), this->end(), 0); }
    std::vector<uint32_t> read() const { return {this->begin(), this->end()}; }
  };
  /// Function that runs invocations first .. end of a kernel with these buffers and uniforms.
  using Run = void (*)(CpuLattice& lattice, const glsl::ImplicitKernel& bound, size_t first, size_t end);
  struct Pass {
    explicit operator bool() const { return runs[0]; }
    Run runs[2] = {};  ///< without contacts, and with contacts
  };

  /// All arguments must outlive the device.
  /// @param contacts  between nodes, part of the solution; null: none
  CpuDevice(CpuLattice& lattice, const Parallel& parallel, CpuNodePairs* contacts = nullptr);

  size_t slots() const { return lattice_.slotCount(); }
  size_t sumSize() const { return lattice_.store.active.size(); }
  uint32_t contactRows() const { return bound_.contact_rows; }

  Pass pass(const char* name, uint32_t options) const;
  void bindLattice() {}
  void begin(const Stepper& stepper) { motions_ = stepper.motions; }
  void bind(uint32_t, Field<Word>& guard) { bound_.guard = guard.data(); }
  void bind(uint32_t binding, Field<vec4>& field);
  void run(const Pass& pass, const Substep& step, Over over, std::initializer_list<Uniform> uniforms = {});
  /// Writes the best share found by implicit_guess.comp into the guard (implicit_fold.comp).
  void chooseShare(bool bound_energy);
  void findPairs(const Substep& step) {
    if (pairs) pairs->find(lattice_, step, bound_.increments);
  }
  bool mayHavePairs() const { return pairs && !pairs->slots().empty(); }

  CpuNodePairs* pairs;

 private:
  using Energies = std::array<double, 8>;  ///< [J] as two vectors of implicit_guess.comp
  CpuLattice& lattice_;
  const Parallel& parallel_;
  const layout::ToolMotion* motions_ = nullptr;
  glsl::ImplicitBuffers bound_;
  std::vector<Energies> energies_;  ///< [jobs]
};

}  // namespace viscera
