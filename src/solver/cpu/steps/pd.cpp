// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/pd.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Sweep
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME SweepVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME SweepContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME SweepContactVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Rate
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_RATE
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME RateVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/pd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_RATE | WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

CpuPd::CpuPd(CpuLattice& lattice, const Parallel& parallel, const PdOptions& options, CpuNodePairs* pairs)
    : implicit_(lattice, parallel, options.iterations, pairs), parallel_(parallel), options_(options) {
  if (options_.accelerated && options_.spectral_radius == 0) findRates(lattice);
}

void CpuPd::findRates(CpuLattice& lattice) {
  std::array<glsl::Word, 2> rates = {};
  const auto find = [&](auto kernel) {
    kernel.guard = rates.data();
    runNodes(parallel_, lattice, kernel);
  };
  if (lattice.strengths.bulk.empty()) {
    find(implicit_.kernel<glsl::Rate>(lattice, {}));
  } else {
    find(implicit_.kernel<glsl::RateVolumes>(lattice, {}));
  }
  stiffness_rate_per_s2_ = static_cast<double>(glsl::uintBitsToFloat(rates[0]));
  damping_rate_per_s_ = static_cast<double>(glsl::uintBitsToFloat(rates[1]));
}

double CpuPd::spectralRadius(double dt_s) const {
  if (options_.spectral_radius > 0) return options_.spectral_radius;
  return jacobiRadius(stiffness_rate_per_s2_, damping_rate_per_s_, dt_s);
}

template <class Sweep>
void CpuPd::sweep(CpuLattice& lattice, const Substep& step, int iteration, double weight) {
  auto kernel = implicit_.kernel<Sweep>(lattice, step);
  kernel.iteration = static_cast<uint32_t>(iteration);
  kernel.omega = static_cast<float>(weight);
  runNodes(parallel_, lattice, kernel);
}

void CpuPd::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  implicit_.begin(lattice, step, motions);
  const double rho = spectralRadius(static_cast<double>(step.dt_s));
  double weight = 1;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    implicit_.updateVolumes(lattice, step, iteration);
    weight = options_.accelerated ? chebyshevWeight(iteration, weight, rho) : 1;
    const bool volumes = !lattice.strengths.bulk.empty();
    if (implicit_.hasContacts(step)) {
      volumes ? sweep<glsl::SweepContactVolumes>(lattice, step, iteration, weight)
              : sweep<glsl::SweepContact>(lattice, step, iteration, weight);
    } else {
      volumes ? sweep<glsl::SweepVolumes>(lattice, step, iteration, weight)
              : sweep<glsl::Sweep>(lattice, step, iteration, weight);
    }
    implicit_.swap();
    implicit_.movePairs(lattice, step, iteration);
  }
  implicit_.end(lattice, step);
}

std::vector<float> CpuPd::changes() const {
  std::vector<float> out;
  for (int n = 0; n < options_.iterations; ++n)
    out.push_back(glsl::uintBitsToFloat(implicit_.guard[1 + 2 * static_cast<size_t>(n)]));
  return out;
}

bool CpuPd::gaveUp() const {
  return implicit_.guard.back() != 0;
}

}  // namespace viscera
