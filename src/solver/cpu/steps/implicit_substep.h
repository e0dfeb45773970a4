// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "solver/cpu/store/cpu_stepper.h"
#include "solver/cpu/text/glsl_kernel.h"
#include "solver/cpu/text/node_pairs.h"

/// Probes and obstacles: what a scene has none of does nothing.
#define WITH_EVERY_CONTACT WITH_CONTACT | WITH_TOOLS | WITH_OBSTACLES

namespace viscera {

namespace glsl {

/// A run of a buffer: element i of the whole is element i - first of it.
struct Window {
  vec4* at = nullptr;
  size_t first = 0;
  vec4& operator[](size_t index) const { return at[index - first]; }
};

/// What kernels of implicit Euler find in buffers and uniforms (shaders/solver/implicit/implicit.glsl, implicit_*.comp,
/// pd.comp).
struct ImplicitKernel : Kernel, PairBuffers {
  using Kernel::Kernel;
  Word* guard = nullptr;
  const vec4* increment = nullptr;
  vec4* increments = nullptr;  // the same buffer, to write
  vec4* next_increments = nullptr;
  vec4* cell_forces_out = nullptr;
  vec4* node_contacts = nullptr;
  uint contact_rows = 0;
  Window energies;
  uint iteration = 0, bound_energy = 0, first_sweep = 0, ends_sweep = 0;
  float omega = 1;
};

}  // namespace glsl

/// Nodes brick by brick as jobs: large enough to be worth a thread's while, the same whatever the threads.
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

/// Places in `active` of a job's nodes.
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

/// Runs a kernel for the first `count` of whatever it goes through.
template <class Kernel>
void runCount(const Parallel& parallel, size_t count, const Kernel& kernel) {
  parallel.ranges(count, {layout::kBrickSlots, kNodesPerJob}, [&](size_t first, size_t end) {
    Kernel mine = kernel;
    runRange(mine, first, end);
  });
}

/// A contact of a node in a substep (shaders/solver/implicit/implicit_contact.glsl).
struct CpuContact {
  Vector3f normal, force;  ///< force on the node in the last solution [N]
  float friction;
};

/// Start and end of a substep of implicit Euler and the increments du = u+ - u in between, which pd iterates:
/// shaders/solver/implicit/implicit_*.comp on the CPU. See solver/gpu/steps/implicit_substep.h for what the stages promise.
class CpuImplicitSubstep {
 public:
  /// @param iterations  at most, in a substep
  /// @param pairs  contacts between nodes that are part of the solution; null: none
  CpuImplicitSubstep(const CpuLattice& lattice, const Parallel& parallel, int iterations,
                     CpuNodePairs* pairs = nullptr);

  void begin(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  void end(CpuLattice& lattice, const Substep& step);
  /// May nodes be in contact, or held, in this substep?
  bool hasContacts(const Substep& step) const { return step.tools || step.obstacle_count > 0; }
  void swap() { current_ = 1 - current_; }
  /// [slots] xyz m; w 1 where prescribed, below 0 where the node has contacts.
  std::vector<glsl::vec4>& increments() { return increments_[current_]; }
  /// Contacts of a node in this substep; at most kMostContacts, the first ones are there.
  std::vector<CpuContact> contactsOf(const Substep& step, uint32_t slot) const;
  /// Forces and majorisers of the cells in the current iterate, for the iteration that follows.
  void updateVolumes(CpuLattice& lattice, const Substep& step, int iteration);

  /// The part of a sweep that moves nodes which may touch others. After the rest of it.
  void movePairs(CpuLattice& lattice, const Substep& step, int iteration);

  /// A kernel that works on this substep, told of it.
  template <class Kernel>
  Kernel kernel(CpuLattice& lattice, const Substep& step) {
    Kernel out(lattice);
    out.tell(step);
    out.tool_motions = motions_;
    out.node_contacts = contacts_.data();
    out.contact_rows = hasContacts(step) ? contact_rows_ : 0;
    if (pairs_) pairs_->tell(out, step);
    out.guard = guard.data();
    out.increments = increments_[current_].data();
    out.increment = out.increments;
    out.next_increments = increments_[1 - current_].data();
    out.cell_forces = out.cell_forces_out = cell_forces_.data();
    return out;
  }

  std::vector<glsl::Word> guard;  ///< [1 + 2 iterations], see shaders/solver/implicit/implicit.glsl

 private:
  template <class Guess>
  void sumEnergies(CpuLattice& lattice, const Substep& step);
  template <class Kernel>
  void runPairs(CpuLattice& lattice, const Kernel& kernel);
  template <class Pull, class Place>
  void sweepPairs(CpuLattice& lattice, const Substep& step, int iteration);
  void keepBestShare(CpuLattice& lattice, const Substep& step, bool bound_energy);

  using Energies = std::array<double, 8>;  ///< [J] as two vectors of implicit_guess.comp
  const Parallel& parallel_;
  CpuNodePairs* pairs_;
  std::vector<glsl::vec4> increments_[2];  ///< [slots] xyz m; w 1 where prescribed; this iterate and the last
  std::vector<glsl::vec4> cell_forces_;  ///< [cellVectors() * slots] N, see shaders/solver/tissue/volume.comp; or empty
  uint32_t contact_rows_;                ///< contacts that a node may have at once
  std::vector<glsl::vec4> contacts_;     ///< [3 * rows * slots], see shaders/solver/implicit/implicit_contact.glsl
  const layout::ToolMotion* motions_ = nullptr;  ///< of this substep
  std::vector<Energies> energies_;               ///< [jobs]
  int current_ = 0;
};

}  // namespace viscera
