// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/cpu_device.h"

#include <cassert>
#include <cstring>
#include <utility>

#include "layout/bindings.h"

namespace viscera {

namespace glsl {

namespace {

struct KernelRow {
  const char* name;
  int features, choosable;  ///< features of this kernel; features in which kernels of this name differ
  CpuDevice::Run run;
};

template <class Variant>
void runVariant(CpuLattice& lattice, const ImplicitKernel& bound, size_t first, size_t end) {
  Variant mine(lattice);
  static_cast<ImplicitKernel&>(mine) = bound;
  runRange(mine, first, end);
}

#define VARIANT_NAME Choose
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_fold.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#include "kernels/implicit_kernels.inc"

}  // namespace

}  // namespace glsl

namespace {

constexpr layout::ToolMotion kNoMotions[layout::kMaxStyluses] = {};

bool mayTouch(const Substep& step) {
  return step.tools || step.obstacle_count > 0;
}

CpuDevice::Run find(const std::string& name, int features) {
  for (const glsl::KernelRow& row : glsl::kKernels) {
    if (name == row.name && ((row.features ^ features) & (row.choosable | WITH_RATE)) == 0) return row.run;
  }
  assert(false && "a kernel of src/solver/device/kernels.txt");
  return nullptr;
}

}  // namespace

CpuDevice::CpuDevice(CpuLattice& lattice, const Parallel& parallel, CpuNodePairs* contacts)
    : pairs(contacts), lattice_(lattice), parallel_(parallel), energies_(nodeJobs(lattice)) {
  bound_.contact_rows = viscera::contactRows(!lattice.tools.impulses.empty(), lattice.tools.obstacle_count);
}

CpuDevice::Pass CpuDevice::pass(const char* name, uint32_t options) const {
  const int features = options & kOfRates ? WITH_RATE : WITH_NOTHING;
  return {{find(name, features), find(name, features | WITH_EVERY_CONTACT)}};
}

void CpuDevice::bind(uint32_t binding, Field<vec4>& field) {
  if (binding == layout::kBindIncrement) bound_.increment = bound_.increments = field.data();
  if (binding == layout::kBindIncrementOut) bound_.next_increments = field.data();
  if (binding == layout::kBindNodeContacts) bound_.node_contacts = field.data();
  if (binding == layout::kBindPartials) bound_.energies = field.data();
}

void CpuDevice::run(const Pass& pass, const Substep& step, Over over, std::initializer_list<Uniform> uniforms) {
  glsl::ImplicitKernel bound(lattice_);
  static_cast<glsl::ImplicitBuffers&>(bound) = bound_;
  bound.tell(step);
  bound.tool_motions = step.tools ? motions_ : kNoMotions;
  if (pairs) pairs->tell(bound, step);
  const std::pair<gpu::UniformName, void*> known[] = {{"iteration", &bound.iteration},
                                                      {"omega", &bound.omega},
                                                      {"first_sweep", &bound.first_sweep},
                                                      {"ends_sweep", &bound.ends_sweep},
                                                      {"dt_s", &bound.dt_s}};
  for (const Uniform& uniform : uniforms) {
    for (const auto& [name, at] : known)
      if (name.key() == uniform.name.key()) std::memcpy(at, &uniform.word, sizeof uniform.word);
  }
  const Run part = pass.runs[mayTouch(step)];
  if (over == Over::kNodes) {
    parallel_(nodeJobs(lattice_), [&](size_t job) {
      const auto range = nodesOfJob(lattice_, job);
      part(lattice_, bound, range[0], range[1]);
    });
    return;
  }
  const size_t count = pairs->slots().size();
  bound.active_nodes = pairs->slots().data();
  bound.active_count = static_cast<uint32_t>(count);
  parallel_.ranges(count, {layout::kBrickSlots, kNodesPerJob},
                   [&](size_t first, size_t end) { part(lattice_, bound, first, end); });
}

void CpuDevice::chooseShare(bool bound_energy) {
  parallel_(energies_.size(), [&](size_t job) {
    const auto range = nodesOfJob(lattice_, job);
    Energies& sum = energies_[job];
    sum.fill(0);
    for (size_t i = 2 * range[0]; i < 2 * range[1]; ++i) {
      for (int c = 0; c < 4; ++c)
        sum[4 * (i & 1) + static_cast<size_t>(c)] += static_cast<double>(bound_.energies[i][c]);
    }
  });
  glsl::dvec4 potential(0), energy(0);
  for (const Energies& sum : energies_) {
    potential += glsl::dvec4(sum[0], sum[1], sum[2], sum[3]);
    energy += glsl::dvec4(sum[4], sum[5], sum[6], sum[7]);
  }
  glsl::Choose choose(lattice_);
  choose.bound_energy = bound_energy ? 1 : 0;
  bound_.guard[0] = glsl::floatBitsToUint(choose.kShares[choose.bestShare(glsl::vec4(potential), glsl::vec4(energy))]);
}

}  // namespace viscera
