// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "solver/processes/suture/chain/chain_matrix.h"
#include "solver/processes/suture/chain/chain_slides.h"
#include "viscera/math/types.h"

namespace viscera {

class Archive;

struct ChainMaterial {
  double radius_m = 1e-4;
  double density_kg_per_m3 = 1150;
  double bending_nm2 = 0;   ///< moment over curvature
  double damping_s = 2e-4;  ///< damping of bending: stress per rate of strain, over that per strain
  double mass_damping_per_s = 0;
};

/// A point of a chain that is held by a clamp, a stylus or tissue.
struct ChainHold {
  uint32_t node = 0;
  double share = 0;                  ///< weight of the next node in the point; the rest is that of `node`
  Vector3d to_m = Vector3d::Zero();  ///< target at the end of the substep, if the chain permits it
  double mass_kg = kRigidMass_kg;    ///< effective mass of the holder
  double most_n = std::numeric_limits<double>::infinity();  ///< force at which it slips
  Vector3d impulse_ns = Vector3d::Zero();                   ///< out: impulse of the substep on the holder
  double stiffness_kg = kRigidMass_kg;                      ///< kept from substep to substep
};

/// A half space that a node must not enter, of an obstacle or a surface, in this substep.
struct ChainTouch {
  uint32_t node = 0;
  uint32_t thing = 0;                   ///< identifies the same contact in the next substep
  Vector3d at_m = Vector3d::Zero();     ///< point on its border, at the end of the substep
  Vector3d normal = Vector3d::UnitZ();  ///< outward normal
  Vector3d moved_m = Vector3d::Zero();  ///< displacement of the border there in the substep
  double friction = 0;
  double mass_kg = kRigidMass_kg;          ///< effective mass of the touched object
  Vector3d impulse_ns = Vector3d::Zero();  ///< out: impulse of the substep on the touched object
  double rub_kg = 0;                       ///< kept from substep to substep: friction over the slip
  bool closed = false;                     ///< kept from substep to substep
};

struct ChainLoad {
  uint32_t node = 0;
  Vector3d force_n = Vector3d::Zero();
};

/// Everything that acts on a chain in a substep.
struct ChainAround {
  Vector3d gravity_m_per_s2 = Vector3d::Zero();
  std::vector<ChainHold> holds;
  std::vector<ChainTouch> touches;
  std::vector<ChainLoad> loads;
  std::vector<ChainSlide> slides;  ///< ascending in s
  std::vector<ChainKnot> knots;    ///< knots, at most kMostKnots
  std::array<bool, 2> swaged{};    ///< a needle is on its first, or last, end: no channel slides off there
  /// Applies the new impulses of slides to the tissue and updates their to_m. Called after each iteration. May be empty
  /// if to_m does not depend on them.
  std::function<void(std::vector<ChainSlide>& slides)> answer;
  /// Adds touches of nodes that entered something they were not near. Called with the predicted end positions of all
  /// nodes. May be empty. @returns whether there were any
  std::function<bool(const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches)> entered;
};

/// A suture as a chain of nodes with inextensible links, with bending and without twist (docs/physics.md 13).
class Chain {
 public:
  /// @param positions_m  [>= 3] positions of the nodes at rest; all links are as long as the first
  Chain(const ChainMaterial& material, std::vector<Vector3d> positions_m);

  void step(double dt_s, ChainAround& around);
  /// Resets it to its initial positions, and whole.
  void reset();
  /// Saves or restores it; a piece is restored into the chain as it was made.
  void persist(Archive& archive);
  /// Cuts it at a node, of which both pieces get half: this keeps what is before it. @param node  2 to nodes() - 3
  /// @returns what is behind it
  Chain part(size_t node);

  size_t nodes() const { return x_.size(); }
  double link_m() const { return link_m_; }
  const ChainMaterial& material() const { return material_; }
  const std::vector<Vector3d>& positions_m() const { return x_; }
  const std::vector<Vector3d>& velocities_m_per_s() const { return v_; }
  void setVelocities(std::vector<Vector3d> v_m_per_s) { v_ = std::move(v_m_per_s); }
  /// Moves nodes at once: as near to these positions as their links, holds and knots permit, without tensions.
  /// @param positions_m, v_m_per_s  [nodes]
  void put(std::vector<Vector3d> positions_m, std::vector<Vector3d> v_m_per_s, ChainAround& around);
  /// Sets all velocities and tensions to zero.
  void stop();
  double mass_kg(size_t node) const { return node == 0 || node + 1 == x_.size() ? mass_kg_ / 2 : mass_kg_; }
  double tension_n(size_t link) const { return dt_s_ > 0 ? mu_[link] / (dt_s_ * dt_s_) : 0; }
  int iterations() const { return iterations_; }    ///< number in the last substep
  bool waited() const { return waits_ > 0; }        ///< there was no solution, and it did not move
  double worstLink() const { return worst_link_; }  ///< largest relative error of a length after the last substep

 private:
  Vector3d point(uint32_t node, double share) const;
  void begin(const ChainAround& around);
  void setBending();
  void measureLinks();
  void setLinks();
  void setAround(const ChainAround& around);
  ChainShape shape() const { return {next_, links_, link_m_, dt_s_}; }
  bool solved(const ChainAround& around) const;
  bool advance(ChainAround& around);
  bool update(ChainHold& hold, bool frozen) const;
  bool update(ChainTouch& touch, bool frozen) const;
  Vector3d slid(const ChainTouch& touch) const;
  double depth_m(const ChainTouch& touch) const;
  void finish();
  void wait(ChainAround& around);
  void keep(size_t first, size_t last);
  void fit();

  ChainMaterial material_;
  double link_m_, mass_kg_, bend_n_per_m_;
  std::vector<Vector3d> start_, x_, v_;
  std::vector<double> mu_;  ///< [links] tension times dt^2
  double dt_s_ = 0;
  // data of the current substep
  ChainMatrix matrix_;
  ChainSlides slides_;
  ChainKnots knots_;
  std::vector<Vector3d> ahead_, next_, bent_;
  std::vector<ChainLink> links_;
  std::vector<ChainMatrix::Unknown> rest_;  ///< residual
  std::vector<ChainSlide> before_slides_;
  std::vector<ChainKnot> before_knots_;
  int iterations_ = 0;
  int waits_ = 0;  ///< kept: consecutive substeps without a solution
  double worst_link_ = 0;
};

/// Splits what acts on a chain that is cut at a node: `around` keeps what acts before it. Knots that are cut from their
/// loops are dropped. @returns what acts behind it, without the callbacks
ChainAround partAround(size_t node, ChainAround& around);

}  // namespace viscera
