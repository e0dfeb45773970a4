// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/implicit_substep.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Begin
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_begin.comp"
#define VARIANT_FEATURES WITH_DASHPOT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME BeginContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_begin.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Guess
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_guess.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME GuessVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_guess.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_VOLUME | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME GuessContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_guess.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME GuessContactVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_guess.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Choose
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_fold.comp"
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Scale
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_scale.comp"
#define VARIANT_FEATURES WITH_DASHPOT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME ScaleContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_scale.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Cells
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_cells.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME End
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_end.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME EndContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_end.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME EndContactVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_end.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME | WITH_PAIRS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Pull
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_pull.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME PullVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_pull.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Meet
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_meet.comp"
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Place
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_place.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME PlaceVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_place.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

constexpr layout::ToolMotion kNoMotions[layout::kMaxStyluses] = {};

}  // namespace

CpuImplicitSubstep::CpuImplicitSubstep(const CpuLattice& lattice, const Parallel& parallel, int iterations,
                                       CpuNodePairs* pairs)
    : guard(1 + 2 * static_cast<size_t>(iterations)),
      parallel_(parallel),
      pairs_(pairs),
      contact_rows_(contactRows(!lattice.hands.impulses.empty(), lattice.hands.obstacle_count)),
      contacts_(3 * lattice.slotCount() * contact_rows_, glsl::vec4(0)),
      energies_(nodeJobs(lattice)) {
  for (std::vector<glsl::vec4>& iterate : increments_) iterate.assign(lattice.slotCount(), glsl::vec4(0));
  if (!lattice.strengths.bulk.empty())
    cell_forces_.assign(lattice.strengths.cellVectors() * lattice.slotCount(), glsl::vec4(0));
}

void CpuImplicitSubstep::begin(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  for (glsl::Word& word : guard) word = 0;
  motions_ = step.tools ? motions : kNoMotions;
  if (hasContacts(step)) {
    runNodes(parallel_, lattice, kernel<glsl::BeginContact>(lattice, step));
  } else {
    runNodes(parallel_, lattice, kernel<glsl::Begin>(lattice, step));
  }
  if (pairs_) pairs_->find(lattice, step, increments_[current_].data());
  keepBestShare(lattice, step, false);
}

void CpuImplicitSubstep::updateVolumes(CpuLattice& lattice, const Substep& step, int iteration) {
  if (cell_forces_.empty()) return;
  auto cells = kernel<glsl::Cells>(lattice, step);
  cells.iteration = static_cast<uint32_t>(iteration);
  cells.active_count = static_cast<uint32_t>(lattice.store.cells.size());
  runCount(parallel_, lattice.store.cells.size(), cells);
}

template <class Kernel>
void CpuImplicitSubstep::runPairs(CpuLattice&, const Kernel& kernel) {
  Kernel all = kernel;
  all.active_nodes = pairs_->slots().data();
  all.active_count = static_cast<uint32_t>(pairs_->slots().size());
  runCount(parallel_, pairs_->slots().size(), all);
}

template <class Pull, class Place>
void CpuImplicitSubstep::sweepPairs(CpuLattice& lattice, const Substep& step, int iteration) {
  auto pull = kernel<Pull>(lattice, step);
  auto place = kernel<Place>(lattice, step);
  pull.first_sweep = iteration == 0 ? 1 : 0;
  runPairs(lattice, pull);
  for (int round = 1; round <= kPairRounds; ++round) {
    runPairs(lattice, kernel<glsl::Meet>(lattice, step));
    place.ends_sweep = round == kPairRounds ? 1 : 0;
    runPairs(lattice, place);
  }
}

void CpuImplicitSubstep::movePairs(CpuLattice& lattice, const Substep& step, int iteration) {
  if (!pairs_ || pairs_->slots().empty()) return;
  if (cell_forces_.empty()) {
    sweepPairs<glsl::Pull, glsl::Place>(lattice, step, iteration);
  } else {
    updateVolumes(lattice, step, 0);
    sweepPairs<glsl::PullVolumes, glsl::PlaceVolumes>(lattice, step, iteration);
  }
}

std::vector<CpuContact> CpuImplicitSubstep::contactsOf(const Substep& step, uint32_t slot) const {
  std::vector<CpuContact> out;
  for (uint32_t row = 0; hasContacts(step) && row < contact_rows_; ++row) {
    const glsl::vec4* at = &contacts_[3 * (size_t{slot} * contact_rows_ + row)];
    if (at[2].w == 0) break;
    out.push_back({{at[0].x, at[0].y, at[0].z}, {at[2].x, at[2].y, at[2].z}, at[1].w});
  }
  return out;
}

template <class Guess>
void CpuImplicitSubstep::sumEnergies(CpuLattice& lattice, const Substep& step) {
  const auto guess = kernel<Guess>(lattice, step);
  parallel_(energies_.size(), [&](size_t job) {
    glsl::vec4 terms[2 * kNodesPerJob];
    const auto range = nodesOfJob(lattice, job);
    Guess mine = guess;
    mine.energies = {terms, 2 * range[0]};
    runRange(mine, range[0], range[1]);
    Energies& sum = energies_[job];
    sum.fill(0);
    for (size_t i = 0; i < 2 * (range[1] - range[0]); ++i) {
      for (int c = 0; c < 4; ++c) sum[4 * (i & 1) + static_cast<size_t>(c)] += static_cast<double>(terms[i][c]);
    }
  });
}

void CpuImplicitSubstep::keepBestShare(CpuLattice& lattice, const Substep& step, bool bound_energy) {
  const bool volumes = !cell_forces_.empty();
  if (hasContacts(step)) {
    volumes ? sumEnergies<glsl::GuessContactVolumes>(lattice, step) : sumEnergies<glsl::GuessContact>(lattice, step);
  } else {
    volumes ? sumEnergies<glsl::GuessVolumes>(lattice, step) : sumEnergies<glsl::Guess>(lattice, step);
  }
  glsl::dvec4 potential(0), energy(0);
  for (const Energies& sum : energies_) {
    potential += glsl::dvec4(sum[0], sum[1], sum[2], sum[3]);
    energy += glsl::dvec4(sum[4], sum[5], sum[6], sum[7]);
  }
  auto choose = kernel<glsl::Choose>(lattice, step);
  choose.bound_energy = bound_energy ? 1 : 0;
  const int best = choose.bestShare(glsl::vec4(potential), glsl::vec4(energy));
  guard[0] = glsl::floatBitsToUint(choose.kShares[best]);
  if (hasContacts(step)) {
    runNodes(parallel_, lattice, kernel<glsl::ScaleContact>(lattice, step));
  } else {
    runNodes(parallel_, lattice, kernel<glsl::Scale>(lattice, step));
  }
}

void CpuImplicitSubstep::end(CpuLattice& lattice, const Substep& step) {
  keepBestShare(lattice, step, !step.tools);  // tools may bring energy in
  if (!hasContacts(step)) {
    runNodes(parallel_, lattice, kernel<glsl::End>(lattice, step));
  } else if (cell_forces_.empty()) {
    runNodes(parallel_, lattice, kernel<glsl::EndContact>(lattice, step));
  } else {
    updateVolumes(lattice, step, 0);  // the momentum of who holds or touches needs them
    runNodes(parallel_, lattice, kernel<glsl::EndContactVolumes>(lattice, step));
  }
}

}  // namespace viscera
