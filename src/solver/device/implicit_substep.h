// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "layout/bindings.h"
#include "solver/contact/node_pairs.h"
#include "solver/device/device.h"
#include "solver/tissue/substep.h"

namespace viscera {

/// Start and end of a substep of implicit Euler and the increments du = u+ - u in between, which pd iterates
/// (shaders/solver/implicit/implicit.glsl has the equations), on any device. Owner of shaders/solver/implicit/*.comp
template <class Device>
class ImplicitSubstep {
 public:
  /// @param iterations  at most, in a substep
  ImplicitSubstep(Device on, int iterations)
      : device(std::move(on)),
        guard(1 + 2 * static_cast<size_t>(iterations)),
        begin_(device.pass("implicit_begin.comp", kInSubstep)),
        guess_(device.pass("implicit_guess.comp", kInSubstep | kWithPairs)),
        scale_(device.pass("implicit_scale.comp", kInSubstep)),
        end_(device.pass("implicit_end.comp", kInSubstep | kWithPairs)),
        increments_{Vectors(device.slots(), "increments", true), Vectors(device.slots(), "increments", true)},
        contacts_(size_t{3} * device.contactRows() * device.slots(), "contacts of nodes"),
        energies_(2 * device.sumSize(), "energies") {
    bindIncrements();  // what is too large for the driver is said now
    if (!device.pairs) return;
    pull_ = device.pass("implicit_pull.comp", kInSubstep | kWithPairs);
    meet_ = device.pass("implicit_meet.comp", kWithPairs);
    place_ = device.pass("implicit_place.comp", kInSubstep | kWithPairs);
  }

  /// First iterate: held nodes are where their tools have them, none is in a probe or an obstacle; the others at the
  /// best share of the motion without forces, that of 0, 1/2, 3/4, 1 with the lowest incremental potential.
  void begin(const Substep& step) {
    guard.clear();
    device.bind(layout::kBindGuard, guard);
    bindIncrements();
    device.run(begin_, step, Over::kNodes);
    device.findPairs(step);
    keepBestShare(step, false);
  }

  /// State = displacement + last iterate, v = du/dt; tools, sleep. The last iterate is taken in the largest share of 0,
  /// 1/2, 3/4, 1 that does not end with more kinetic + elastic energy than there was before the substep and gravity
  /// added, so energy cannot grow, whatever the state, dt and the number of iterations. Where tools act, which may
  /// bring energy in, only the incremental potential must not be above that of no motion. Who holds or touches nodes
  /// gives them what their balance of forces at the end of the substep lacks.
  void end(const Substep& step) {
    keepBestShare(step, !step.tools);
    device.run(end_, step, Over::kNodes);
  }

  /// The next iterate is where the last but one was; swap() makes it the current one.
  void swap() {
    current_ = 1 - current_;
    bindIncrements();
  }

  /// The part of a sweep that moves nodes which may touch others: all of them together. After the rest of it.
  void movePairs(const Substep& step, int iteration) {
    if (!device.mayHavePairs()) return;
    device.run(pull_, step, Over::kPairs, {{"first_sweep", iteration == 0 ? 1u : 0u}});
    for (int round = 1; round <= kPairRounds; ++round) {
      device.run(meet_, step, Over::kPairs);
      device.run(place_, step, Over::kPairs, {{"ends_sweep", round == kPairRounds ? 1u : 0u}});
    }
  }

  Device device;
  typename Device::template Field<typename Device::Word> guard;  ///< [1 + 2 iterations], see implicit.glsl

 private:
  void bindIncrements() {
    device.bind(layout::kBindIncrement, increments_[current_]);
    device.bind(layout::kBindIncrementOut, increments_[1 - current_]);
    device.bind(layout::kBindNodeContacts, contacts_);
  }

  void keepBestShare(const Substep& step, bool bound_energy) {
    device.bind(layout::kBindPartials, energies_);
    device.run(guess_, step, Over::kNodes);
    device.chooseShare(bound_energy);
    device.run(scale_, step, Over::kNodes);
  }

  using Vectors = typename Device::template Field<typename Device::vec4>;
  typename Device::Pass begin_, guess_, scale_, end_;
  typename Device::Pass pull_, meet_, place_;  ///< of pairs, where there are any
  Vectors increments_[2];  ///< [slots] xyz m; w 1 where prescribed, below 0 where in contact; this iterate and the last
  Vectors contacts_;       ///< [3 * rows * slots], see shaders/solver/implicit/implicit_contact.glsl
  Vectors energies_;       ///< [2 * device.sumSize()] J
  int current_ = 0;
};

}  // namespace viscera
