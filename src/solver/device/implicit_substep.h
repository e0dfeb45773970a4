// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "layout/bindings.h"
#include "solver/contact/node_pairs.h"
#include "solver/device/device.h"
#include "solver/tissue/substep.h"

namespace viscera {

/// Start and end of a substep of implicit Euler, and the increments du = u+ - u in between, which pd iterates, on any
/// device. The equations are in shaders/solver/implicit/implicit.glsl. Owner of shaders/solver/implicit/*.comp
template <class Device>
class ImplicitSubstep {
 public:
  /// @param iterations  largest number in a substep
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
    bindIncrements();  // reports now what is too large for the driver
    if (!device.pairs) return;
    pull_ = device.pass("implicit_pull.comp", kInSubstep | kWithPairs);
    meet_ = device.pass("implicit_meet.comp", kWithPairs);
    position_ = device.pass("implicit_place.comp", kInSubstep | kWithPairs);
  }

  /// Sets the first iterate. Held nodes are at their prescribed positions, and no node is in a probe or an obstacle.
  /// The others move by the best share of the motion without forces: that of 0, 1/2, 3/4, 1 with the lowest incremental
  /// potential.
  void begin(const Substep& step) {
    guard.clear();
    device.bind(layout::kBindGuard, guard);
    bindIncrements();
    device.run(begin_, step, Over::kNodes);
    device.findPairs(step);
    keepBestShare(step, false);
  }

  /// Sets state = displacement + last iterate, v = du/dt; applies tools and sleep. The last iterate is scaled by the
  /// largest share of 0, 1/2, 3/4, 1 with which kinetic + elastic energy does not exceed that before the substep plus
  /// the work of gravity. So energy cannot grow, whatever the state, dt and the number of iterations. Where tools act,
  /// which may add energy, only the incremental potential must not exceed that of no motion. Tools and obstacles that
  /// hold or touch nodes receive the residual of their balance of forces at the end of the substep.
  void end(const Substep& step) {
    keepBestShare(step, !step.tools);
    device.run(end_, step, Over::kNodes);
  }

  /// Makes the next iterate the current one. It is stored in place of the iterate before the last.
  void swap() {
    current_ = 1 - current_;
    bindIncrements();
  }

  /// Moves the nodes that may touch others, all together. Call after the rest of a sweep.
  void movePairs(const Substep& step, int iteration) {
    if (!device.mayHavePairs()) return;
    device.run(pull_, step, Over::kPairs, {{"first_sweep", iteration == 0 ? 1u : 0u}});
    for (int round = 1; round <= kPairRounds; ++round) {
      device.run(meet_, step, Over::kPairs);
      device.run(position_, step, Over::kPairs, {{"ends_sweep", round == kPairRounds ? 1u : 0u}});
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
  typename Device::Pass pull_, meet_, position_;  ///< passes of pairs, where there are any
  Vectors increments_[2];  ///< [slots] xyz m; w 1 where prescribed, below 0 where in contact; this iterate and the last
  Vectors contacts_;       ///< [3 * rows * slots], see shaders/solver/implicit/implicit_contact.glsl
  Vectors energies_;       ///< [2 * device.sumSize()] J
  int current_ = 0;
};

}  // namespace viscera
