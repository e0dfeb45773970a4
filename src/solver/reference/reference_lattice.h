// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <map>
#include <unordered_map>
#include <vector>

#include "solver/reference/law_cell.h"
#include "solver/tissue/fields.h"
#include "viscera/model/body/wall_cells.h"
#include "viscera/model/model.h"
#include "viscera/solver/material.h"

namespace viscera {

/// Forces, energies and stiffness of lattices and networks as functions of the displacement, in float64. The constants
/// are the float32 ones that the kernels take, so a difference to a kernel is its arithmetic and nothing else; geometry
/// is that of the model.
/// A spring is named by one of its ends and its place there: in an implicit lattice the 18 spring indices
/// (neighbors.h), whether or not a spring is there; with explicit connections (VR05 2.5.1, GW 4) the node's links.
class ReferenceLattice {
 public:
  /// Which second derivative: the true one, or its nearest that has no negative eigenvalue, term by term.
  enum class Curvature { kTrue, kPositive };

  /// @param model  must outlive the lattice
  explicit ReferenceLattice(const Model& model);

  std::vector<uint32_t> active;         ///< [active] slots
  std::vector<layout::NodeBits> nodes;  ///< [slots]; counts of heterogeneous bodies and of explicit lattices only say
                                        ///< alive or cut, those of networks how many links are whole
  std::vector<float> spring_cut;        ///< [springs] of all networks, as in CutSprings: 0 whole
  std::vector<double> axial_cut;        ///< [3 * slots] of lattices of either kind, as in CutSprings
  std::vector<Vector3d> cut_sides;  ///< [slots] unit normal of a cut towards the node, zero where there is none: see
                                    ///< shaders/solver/tools/cut_sides.glsl

  size_t slots() const { return nodes.size(); }
  Vector3d restPosition(uint32_t slot) const { return rest_m_[slot]; }
  double mass(uint32_t slot) const;  ///< [kg]
  /// surfaceDepths() [m]: for it tools and obstacles are as much larger.
  /// From a node outside of its tissue to the nearest point of the surface in a state, by the edges that lie that way
  /// [m]; 0 of all others. @param u_m  [slots]
  Vector3d wayToSurface(const Field& u_m, uint32_t slot) const;
  /// Where that tissue is [m].
  Vector3d tissueAt(const Field& u_m, uint32_t slot) const {
    return restPosition(slot) + u_m[slot] + wayToSurface(u_m, slot);
  }
  double surfaceDepth(uint32_t slot) const { return surface_depth_m_.empty() ? 0 : surface_depth_m_[slot]; }
  /// Places for springs at a node: 18 in an implicit lattice, else its links, cut ones too.
  uint32_t springsOf(uint32_t slot) const { return starts_[slot + 1] - starts_[slot]; }
  bool isWhole(uint32_t slot, uint32_t spring) const;  ///< a spring is there and not cut
  /// Is this the end from which the spring is looked at where each is looked at once? The lower one in an implicit
  /// lattice, else the one with the lower slot.
  bool isFirstEnd(uint32_t slot, uint32_t spring) const { return neighbor(slot, spring).first_end; }
  double stiffness(uint32_t slot, uint32_t spring) const;  ///< k [N/m], 0 where there is none
  double dashpot(uint32_t slot, uint32_t spring) const;    ///< c [N s/m]
  double drag_per_s(uint32_t slot) const { return body(slot).drag_per_s; }
  /// lambda_V h^3 [J] of the cell whose lowest corner is the node; 0 where there is none or it is cut.
  double bulk(uint32_t slot) const;
  bool isIsolated(uint32_t slot) const;
  bool isNetwork(uint32_t slot) const { return has_valences_[nodes[slot].hi >> layout::kBodyShift]; }
  bool isAgainstBending(uint32_t slot, uint32_t spring) const {
    return neighbor(slot, spring).lattice_spring == layout::kBendingSpring;
  }
  /// 0 free, else 1 + stylus.
  uint32_t heldBy(uint32_t slot) const { return (nodes[slot].lo & layout::kGrabMask) >> layout::kGrabShift; }

  /// (L - l0) / l0 of a spring; 0 where l0 is.
  double strain(const Field& u_m, uint32_t slot, uint32_t spring) const;
  /// Springs and cells, on one node and on all [N].
  Vector3d elasticForce(const Field& u_m, uint32_t slot) const;
  Field elasticForces(const Field& u_m) const;
  /// Axial dashpots, sum of c n (n . (v_far - v_near)) with n of u [N].
  Vector3d dashpotForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const;
  /// What leapfrog's dashpots do to a node: axial ones, but of a lattice whose springs are predicted that of mild
  /// springs is what they pull where their ends will be less what they pull now [N] (physics.md 2).
  Vector3d dampingForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const;
  /// Half the power that damping takes [W]: of springs the sum of c/2 (n . (v_far - v_near))^2, of nodes that obey a
  /// law that of -v . dampingForce() / 2.
  double dissipation(const Field& u_m, const Field& v_m_per_s) const;
  double elasticEnergy(const Field& u_m) const;  ///< [J]
  double springEnergy(const Field& u_m) const;   ///< [J]
  double cellEnergy(const Field& u_m) const;     ///< of cells that obey a law [J]
  /// Largest force of a spring, or of one strained by 1e-6 where all are less [N]: what residuals are held to.
  double forceScale(const Field& u_m) const;

  /// Row and column of a node's axis in stiffnessMatrix(): 3 * (place in `active`) + axis.
  int dof(uint32_t slot, int axis) const { return 3 * place_[slot] + axis; }
  int dofs() const { return 3 * static_cast<int>(active.size()); }
  /// d2 elasticEnergy / du2, [dofs x dofs] [N/m]; symmetric, both halves stored.
  /// @param dashpot_per_s  adds c n n^T times this: the derivative of an implicit dashpot
  Eigen::SparseMatrix<double> stiffnessMatrix(const Field& u_m, Curvature curvature = Curvature::kTrue,
                                              double dashpot_per_s = 0) const;

  /// Erases a spring from both ends, and with it the volume of every cell that it belongs to.
  /// @param fraction  where it was cut, in (0, 1] of the way from `slot`, of explicit connections from its end with the
  ///                  lower slot; or layout::kErasedShare
  void eraseSpring(uint32_t slot, uint32_t spring, double fraction = 1);
  uint32_t farEnd(uint32_t slot, uint32_t spring) const { return neighbor(slot, spring).slot; }

 protected:
  size_t bodies() const { return params_.size(); }
  const layout::BodyParams& body(uint32_t slot) const { return params_[nodes[slot].hi >> layout::kBodyShift]; }
  /// Do the cells around a node obey a hyperelastic law? Springs pull in those that have lost one alone.
  bool obeysLaw(uint32_t slot) const { return body(slot).law != layout::kLawSprings; }
  /// Where nodes are at which leapfrog takes the forces of such cells: displacements ahead by dashpot_s [m], which
  /// damps (physics.md 2); of other bodies as they are.
  Field lawPlaces(const Field& u_m, const Field& v_m_per_s) const;

 private:
  struct Neighbor {
    uint32_t slot = 0;
    Vector3d offset_m = Vector3d::Zero();  ///< rest offset
    double rest_m = 0;                     ///< rest length; of explicit connections not always that of the offset
    bool first_end = false;
    uint32_t lattice_spring = layout::kNoLatticeSpring;  ///< its index in the lattice, 0..17
    int64_t spring = -1;                                 ///< explicit connection: place in spring_cut
    double stiffness_n_per_m = 0;                        ///< of an explicit connection
  };
  struct Spring;  ///< direction, length and extension of one deformed spring
  struct Cell {
    std::array<uint32_t, 8> corners;  ///< slots; bit per axis, x lowest
    double spacing_m;
    LawCell law;  ///< while it is whole; without rigidity in bodies of springs

    bool isInWall() const { return law.wall.across > 0; }
  };
  /// What a node's displacement does to each of the sixteen vectors of a WallMotion [1/m].
  using WallShare = Eigen::Matrix<double, 16, 1>;
  struct WallNode {
    uint32_t slot;
    WallShare share;
  };
  using WallStencil = std::vector<WallNode>;  ///< of a cell: its corners, and nodes beside them along the axes
  using CornerForces = std::array<Vector3d, 8>;
  void addBody(const Model& model, size_t b, double dt_safe_s);
  void addLatticeSprings(const Lattice& lattice, uint32_t first);
  void addLinks(const SpringNetwork& network, uint32_t first);
  void addCell(const Body& body, size_t b, uint32_t local);
  void addWay(const Lattice& lattice, uint32_t first, uint32_t local);
  const Neighbor& neighbor(uint32_t slot, uint32_t spring) const { return neighbors_[starts_[slot] + spring]; }
  Spring springAt(const Field& u_m, uint32_t slot, uint32_t spring) const;
  Spring springOf(const Vector3d& w_m, const Cell& cell, uint32_t slot, uint32_t spring) const;
  static Spring springBetween(const Neighbor& link, const Vector3d& w_m);
  void loseSpring(uint32_t slot, uint32_t lattice_spring);
  void killCells(uint32_t slot, uint32_t other);
  CellMotion motionOf(const Field& u_m, const Cell& cell) const;
  void addWall(const WallCell& wall, Cell& cell);
  void linkWalls();
  bool isWithinRow(uint32_t slot, int axis) const;
  WallStencil stencilOf(const Cell& cell) const;
  LawCell wallLaw(const Cell& cell) const;
  static WallMotion motionOf(const Field& u_m, const WallStencil& stencil);
  template <class Visit>
  void wallForces(const Field& u_m, const Cell& cell, Visit visit) const;
  Vector3d wallForce(const Field& u_m, uint32_t slot) const;
  void addWallForces(const Field& u_m, Field& forces) const;
  double wallEnergy(const Field& u_m, const Cell& cell) const;
  void addWallStiffness(const Field& u_m, const Cell& cell, Curvature curvature,
                        std::vector<Eigen::Triplet<double>>& out) const;
  bool isWholeCell(const Cell& cell) const;
  bool isBroken(const Cell& cell) const;
  template <class Visit>
  void forEachSpringOf(const Cell& cell, Visit visit) const;
  CornerForces brokenForces(const Field& u_m, const Cell& cell) const;
  double brokenEnergy(const Field& u_m, const Cell& cell) const;
  void addBroken(const Field& u_m, Curvature curvature, std::vector<Eigen::Triplet<double>>& out) const;
  CornerForces cellForces(const Field& u_m, size_t cell) const;
  Vector3d springForce(const Field& u_m, uint32_t slot) const;
  template <class ForcesOf>
  Vector3d cellForce(ForcesOf forces_of, uint32_t slot) const;
  void addSprings(const Field& u_m, Curvature curvature, double dashpot_per_s,
                  std::vector<Eigen::Triplet<double>>& out) const;
  void addCells(const Field& u_m, Curvature curvature, std::vector<Eigen::Triplet<double>>& out) const;

  bool predicts_;  ///< predictsSprings()
  std::vector<layout::BodyParams> params_;
  std::vector<Strengths> strengths_;  ///< [bodies] empty where a body has one material; masses of networks
  CellMoments moments_;               ///< of the body that is being added
  std::unordered_map<uint32_t, LawLaminate> laminates_;           ///< likewise, by cell
  std::unordered_map<uint32_t, WallCell> walls_;                  ///< likewise
  std::unordered_map<uint32_t, std::vector<size_t>> walls_near_;  ///< cells in thin walls whose stencil has a node
  struct AxialOfWall {
    uint32_t slot, spring;
    size_t cell;
  };
  std::vector<AxialOfWall> axial_of_walls_;  ///< while bodies are added
  std::vector<uint32_t> first_;              ///< [bodies] slot offsets
  std::vector<bool> has_valences_;           ///< [bodies] NodeBits hold valences, not the counts of a lattice
  std::vector<uint32_t> starts_ = {0};       ///< [slots + 1] into neighbors_
  std::vector<Neighbor> neighbors_;          ///< node by node
  Field rest_m_;                             ///< [slots]
  std::vector<float> surface_depth_m_;       ///< [slots] or none
  struct Way {
    Vector3d way_m;  ///< at rest
    double spacing_m;
    std::array<int64_t, 3> to;  ///< slots of the neighbours along the axes at that side; -1 none
  };
  std::map<uint32_t, Way> ways_;            ///< of nodes outside of their tissue, by slot
  std::vector<int> place_;                  ///< [slots] place in `active`, or -1
  std::vector<Cell> cells_;                 ///< [cells]
  std::vector<std::array<int, 8>> around_;  ///< [slots] cell of which the node is corner c, or -1
};

}  // namespace viscera
