// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "solver/cpu/text/glsl_kernel.h"
#include "solver/multigrid/steps/stage_solver.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/tool_motion.h"

namespace viscera::multigrid {

/// What grips, probes and obstacles do to nodes in a step (physics.md 2). Held nodes go where hands take them; others
/// that would end in a probe or an obstacle get a contact, a half space n . du >= b (implicit_contact.glsl), to whose
/// plane they keep while the balance of their forces presses them there. Only the finest level knows of either.
class Touching {
 public:
  /// @param level, lattice  must outlive it
  Touching(const FineLevel& level, const CpuLattice& lattice);

  /// A step begins. @param motions  [kMaxStyluses] of the step; looked at where step.tools
  void begin(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);
  /// The state was written from outside: what pressed is unknown.
  void restart() { pressed_.clear(); }
  void persist(Archive& archive);
  /// Of the step that a stage ends at.
  void setShare(double share) { share_ = static_cast<float>(share); }
  bool any() const { return !nodes_.empty(); }

  /// Moves what an increment may not have, and looks for what it meets.
  void place(Vectors& increment);
  /// Tells the level who is held. @param lacks  residual of the increment, to which friction is added
  /// @return others than before
  bool press(Vectors& lacks, const Vectors& increment, FineLevel& level);

  /// Calls each(place) for nodes that were pressed or held at the end of the last step, or are in this one.
  template <class Each>
  void forPressedBefore(const Each& each) const {
    for (const uint32_t place : pressed_) each(size_t{place});
  }
  /// Calls each(place) for nodes that press: they go on evenly to the step's end, their inertia not in the balance.
  template <class Each>
  void goOnEvenly(const Each& each) {
    for (Node& node : nodes_) {
      node.goes_evenly = node.presses;
      if (node.presses) each(size_t{node.place});
    }
  }
  /// Work of who touches on increments, with the forces that nodes lack [J].
  double work(const Vectors& increment) const;
  /// Ends a step: tells styluses and obstacles what they gave, and gives the nodes that they moved their velocities.
  /// @param before_m_per_s  velocity at its start
  void give(CpuLattice& lattice, const Vectors& increment, const Vectors& before_m_per_s, Vectors& velocity_m_per_s);

 private:
  struct Node {
    uint32_t node, slot, place;
    bool held;             ///< by a hand
    bool presses = false;  ///< prescribed or kept to a plane
    bool sticks = false;   ///< to the surface that it touches
    bool goes_evenly = false;
    uint32_t mask = 0;        ///< contacts that press
    Vector3f way{0, 0, 0};    ///< held: of the whole step [m]
    Vector3f lacks{0, 0, 0};  ///< what its balance lacks [N]
  };
  struct Kernel;
  Kernel kernelFor(CpuLattice& lattice);
  void hold(CpuLattice& lattice);
  bool isNear(const Vector3f& x) const;
  void find(const Vectors& increment);
  void outside(const Node& node, float* at, size_t places) const;
  bool pressNode(Node& node, const Vectors& increment, Vectors& lacks, const FineLevel& level);
  struct Half {
    Vector3f normal, way;
    float least, friction;
  };
  /// Contacts of a node as they are at the end of the stage. @return how many
  size_t contactsOf(uint32_t slot, std::array<Half, 3>& out) const;

  const FineLevel& level_;
  CpuLattice* lattice_ = nullptr;  ///< during a step
  Substep step_;
  const layout::ToolMotion* motions_ = nullptr;
  uint32_t rows_;                       ///< contacts that a node may have at once
  float deepest_m_ = 0;                 ///< surface depth of any node
  std::vector<glsl::vec4> contacts_;    ///< [3 * rows * slots], see shaders/solver/implicit/implicit_contact.glsl
  std::vector<Vector3f> rest_m_;        ///< [nodes]
  std::vector<uint8_t> known_, found_;  ///< [nodes] is in nodes_; has a contact
  std::vector<Node> nodes_;
  std::vector<uint32_t> pressed_;  ///< places, at the end of the last step
  std::vector<uint32_t> held_places_;
  std::vector<Plane> planes_;
  float share_ = 1;
};

}  // namespace viscera::multigrid
