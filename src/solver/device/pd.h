// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/device/implicit_substep.h"
#include "solver/tissue/jacobi.h"

namespace viscera {

/// PD-Jacobi in majorise-minimise form on implicit Euler (physics.md 2), with optional Chebyshev acceleration. If
/// acceleration diverges, which the device decides, the rest of the substep restarts without it.
/// Owner of shaders/solver/implicit/pd.comp.
template <class Device>
class PdStepper : public Device::Stepper {
 public:
  PdStepper(Device device, const PdOptions& options)
      : implicit_(std::move(device), options.iterations),
        sweep_(implicit_.device.pass("pd.comp", kInSubstep)),
        options_(options) {
    if (options_.accelerated && options_.spectral_radius == 0) findRates();
  }

  /// Advances the device's lattice by a substep.
  void run(typename Device::Lattice&, const Substep& step) override {
    implicit_.device.begin(*this);
    implicit_.begin(step);
    const double rho = spectralRadius(static_cast<double>(step.dt_s));
    double weight = 1;
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
      weight = options_.accelerated ? chebyshevWeight(iteration, weight, rho) : 1;
      implicit_.device.run(sweep_, step, Over::kNodes,
                           {{"iteration", static_cast<uint32_t>(iteration)}, {"omega", static_cast<float>(weight)}});
      implicit_.swap();
      implicit_.movePairs(step, iteration);
    }
    implicit_.end(step);
  }

  /// Returns a bound on the spectral radius of the plain iteration (jacobiRadius).
  double spectralRadius(double dt_s) const {
    if (options_.spectral_radius > 0) return options_.spectral_radius;
    return jacobiRadius(stiffness_rate_per_s2_, damping_rate_per_s_, dt_s);
  }

  /// Returns the largest step of a node per iteration of the last substep, before acceleration [m]. Waits for the
  /// device.
  std::vector<float> changes() const {
    const std::vector<uint32_t> words = implicit_.guard.read();
    std::vector<float> out;
    for (size_t n = 1; n < words.size(); n += 2) out.push_back(floatFromBits(words[n]));
    return out;
  }

  /// Returns whether the last substep abandoned its acceleration. Waits for the device.
  bool gaveUp() const { return implicit_.guard.read().back() != 0; }

 private:
  void findRates() {
    Device& device = implicit_.device;
    typename Device::template Field<typename Device::Word> rates(2);
    device.bindLattice();
    device.bind(layout::kBindGuard, rates);
    device.run(device.pass("pd.comp", kOfRates), {}, Over::kNodes);
    const std::vector<uint32_t> found = rates.read();
    stiffness_rate_per_s2_ = static_cast<double>(floatFromBits(found[0]));
    damping_rate_per_s_ = static_cast<double>(floatFromBits(found[1]));
  }

  ImplicitSubstep<Device> implicit_;
  typename Device::Pass sweep_;
  PdOptions options_;
  double stiffness_rate_per_s2_ = 0, damping_rate_per_s_ = 0;  ///< max of (sum of k)/m, of (sum of c)/m
};

}  // namespace viscera
