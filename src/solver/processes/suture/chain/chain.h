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
  double damping_s = 2e-4;  ///< of bending: stress of a rate of strain, over that of the strain
  double drag_per_s = 0;
};

/// A point of a chain that something holds: a clamp, a hand, tissue.
struct ChainHold {
  uint32_t node = 0;
  double share = 0;                  ///< of the next node in the point; the rest is of `node`
  Vector3d to_m = Vector3d::Zero();  ///< where the holder is at the end of the substep, if the chain lets it
  double mass_kg = kRigidMass_kg;    ///< that the holder shows
  double most_n = std::numeric_limits<double>::infinity();  ///< it slips at more
  Vector3d impulse_ns = Vector3d::Zero();                   ///< out: of the substep, on the holder
  double stiffness_kg = kRigidMass_kg;                      ///< kept from substep to substep
};

/// A half space that a node does not enter: what it may touch of an obstacle or of a skin, in this substep.
struct ChainTouch {
  uint32_t node = 0;
  uint32_t thing = 0;                   ///< by which the same touch is known again
  Vector3d at_m = Vector3d::Zero();     ///< on its border, at the end of the substep
  Vector3d normal = Vector3d::UnitZ();  ///< out of it
  Vector3d moved_m = Vector3d::Zero();  ///< by its border there, in the substep
  double friction = 0;
  double mass_kg = kRigidMass_kg;          ///< that it shows
  Vector3d impulse_ns = Vector3d::Zero();  ///< out: of the substep, on what is touched
  double rub_kg = 0;                       ///< kept from substep to substep: friction over what slid
  bool closed = false;                     ///< kept
};

struct ChainLoad {
  uint32_t node = 0;
  Vector3d force_n = Vector3d::Zero();
};

/// What acts on a chain in a substep.
struct ChainAround {
  Vector3d gravity_m_per_s2 = Vector3d::Zero();
  std::vector<ChainHold> holds;
  std::vector<ChainTouch> touches;
  std::vector<ChainLoad> loads;
  std::vector<ChainSlide> slides;  ///< ascending in s
  std::vector<ChainKnot> knots;    ///< kMostKnots at most
  std::array<bool, 2> swaged{};    ///< its first and last end: a needle is there, and no channel slides off
  /// Asked after each iteration: gives the tissue what slides' impulses have become, and moves their to_m. May be empty
  /// where to_m does not depend on them.
  std::function<void(std::vector<ChainSlide>& slides)> answer;
  /// Asked where all nodes would end: adds touches of those that came into something that they were not near. May be
  /// empty. @returns whether there were any
  std::function<bool(const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches)> entered;
};

/// A thread as a chain of nodes whose links keep their length, with bending and without twist (docs/thread.md 1).
class Chain {
 public:
  /// @param places_m  [>= 3] of the nodes at rest; links are as long as the first
  Chain(const ChainMaterial& material, std::vector<Vector3d> places_m);

  void step(double dt_s, ChainAround& around);
  /// Back to where it was made, and whole.
  void reset();
  /// Of a piece too, into the chain that it was made as.
  void persist(Archive& archive);
  /// Parted at a node, which both pieces have half of: this keeps what is before it. @param node  2 to nodes() - 3
  /// @returns what is behind it
  Chain part(size_t node);

  size_t nodes() const { return x_.size(); }
  double link_m() const { return link_m_; }
  const ChainMaterial& material() const { return material_; }
  const std::vector<Vector3d>& places_m() const { return x_; }
  const std::vector<Vector3d>& velocities_m_per_s() const { return v_; }
  void setVelocities(std::vector<Vector3d> v_m_per_s) { v_ = std::move(v_m_per_s); }
  /// Puts nodes elsewhere at once: as near to these places as their links, holds and knots let them, without tensions.
  /// @param places_m, v_m_per_s  [nodes]
  void put(std::vector<Vector3d> places_m, std::vector<Vector3d> v_m_per_s, ChainAround& around);
  /// All of it stands still; links feel nothing.
  void stop();
  double mass_kg(size_t node) const { return node == 0 || node + 1 == x_.size() ? mass_kg_ / 2 : mass_kg_; }
  double tension_n(size_t link) const { return dt_s_ > 0 ? mu_[link] / (dt_s_ * dt_s_) : 0; }
  int iterations() const { return iterations_; }    ///< of the last substep
  bool waited() const { return waits_ > 0; }        ///< it had no solution, and all of it stayed where it was
  double worstLink() const { return worst_link_; }  ///< largest relative error of a length after it

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
  bool heed(ChainHold& hold, bool frozen) const;
  bool heed(ChainTouch& touch, bool frozen) const;
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
  // of the substep under way
  ChainMatrix matrix_;
  ChainSlides slides_;
  ChainKnots knots_;
  std::vector<Vector3d> ahead_, next_, bent_;
  std::vector<ChainLink> links_;
  std::vector<ChainMatrix::Unknown> rest_;  ///< what is not balanced yet
  std::vector<ChainSlide> before_slides_;
  std::vector<ChainKnot> before_knots_;
  int iterations_ = 0;
  int waits_ = 0;  ///< kept: substeps without a solution, one after the other
  double worst_link_ = 0;
};

/// What acts on a chain that is parted at a node: keeps what acts before it. Knots that are cut from their loops are
/// gone. @returns what acts behind it, but for what is asked of others
ChainAround partAround(size_t node, ChainAround& around);

}  // namespace viscera
