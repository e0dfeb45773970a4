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
/// are the float32 ones of the kernels, so a difference to a kernel is due to its arithmetic alone. Geometry is that of
/// the model.
/// A spring is named by one of its ends and its index there. In an implicit lattice these are the 18 spring indices
/// (neighbors.h), whether or not the spring exists. With explicit connections (VR05 2.5.1, GW 4) they are the node's
/// links.
class ReferenceLattice {
 public:
  /// Which second derivative: the true one, or the nearest one without negative eigenvalues, term by term.
  enum class Curvature { kTrue, kPositive };

  /// @param model  must outlive the lattice
  explicit ReferenceLattice(const Model& model);

  std::vector<uint32_t> active;         ///< [active] slots
  std::vector<layout::NodeBits> nodes;  ///< [slots]; counts of heterogeneous bodies and of explicit lattices only say
                                        ///< alive or cut, those of networks how many links are whole
  std::vector<float> spring_cut;        ///< cuts of springs [springs] of all networks, as in CutSprings: 0 whole
  std::vector<double> axial_cut;    ///< cuts of axial springs [3 * slots] of lattices of either kind, as in CutSprings
  std::vector<Vector3d> cut_sides;  ///< [slots] unit normal of a cut towards the node, zero where there is none: see
                                    ///< shaders/solver/tools/cut_sides.glsl

  size_t slots() const { return nodes.size(); }
  Vector3d restPosition(uint32_t slot) const { return rest_m_[slot]; }
  double mass(uint32_t slot) const;  ///< [kg]
  /// Returns the displacement from a node outside its tissue to the nearest point of the surface in a state, by the
  /// edges in that direction [m]; 0 for all other nodes. @param u_m  [slots]
  Vector3d offsetToSurface(const Field& u_m, uint32_t slot) const;
  /// Returns the position of that surface point, or of the node itself [m].
  Vector3d tissueAt(const Field& u_m, uint32_t slot) const {
    return restPosition(slot) + u_m[slot] + offsetToSurface(u_m, slot);
  }
  /// Returns surfaceDepths() of a node [m]: tools and obstacles are enlarged by it.
  double surfaceDepth(uint32_t slot) const { return surface_depth_m_.empty() ? 0 : surface_depth_m_[slot]; }
  /// Returns the number of springs at a node: 18 in an implicit lattice, else its links, including cut ones.
  uint32_t springsOf(uint32_t slot) const { return starts_[slot + 1] - starts_[slot]; }
  bool isWhole(uint32_t slot, uint32_t spring) const;  ///< the spring exists and is not cut
  /// Returns whether this end is used where each spring is visited once: the lower one in an implicit lattice, else
  /// that with the lower slot.
  bool isFirstEnd(uint32_t slot, uint32_t spring) const { return neighbor(slot, spring).first_end; }
  double stiffness(uint32_t slot, uint32_t spring) const;  ///< k [N/m], 0 where there is none
  double dashpot(uint32_t slot, uint32_t spring) const;    ///< c [N s/m]
  double mass_damping_per_s(uint32_t slot) const { return body(slot).mass_damping_per_s; }
  /// Returns lambda_V h^3 [J] of the cell with the node as its lowest corner; 0 if there is none or it is cut.
  double bulk(uint32_t slot) const;
  bool isIsolated(uint32_t slot) const;
  bool isNetwork(uint32_t slot) const { return has_valences_[nodes[slot].hi >> layout::kBodyShift]; }
  bool isAgainstBending(uint32_t slot, uint32_t spring) const {
    return neighbor(slot, spring).lattice_spring == layout::kBendingSpring;
  }
  /// Returns 0 for a free node, else 1 + stylus.
  uint32_t heldBy(uint32_t slot) const { return (nodes[slot].lo & layout::kGrabMask) >> layout::kGrabShift; }

  /// Returns (L - l0) / l0 of a spring; 0 where l0 is 0.
  double strain(const Field& u_m, uint32_t slot, uint32_t spring) const;
  /// Returns the force of springs and cells on a node, or on all [N].
  Vector3d elasticForce(const Field& u_m, uint32_t slot) const;
  Field elasticForces(const Field& u_m) const;
  /// Returns the force of axial dashpots, sum of c n (n . (v_far - v_near)) with n of u [N].
  Vector3d dashpotForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const;
  /// Returns the damping force of leapfrog on a node [N]: axial dashpots. In a lattice with predicted springs, it is
  /// the force of mild springs at the predicted positions of their ends less that at the current ones (physics.md 2).
  Vector3d dampingForce(const Field& u_m, const Field& v_m_per_s, uint32_t slot) const;
  /// Returns half the power that damping dissipates [W]: of springs the sum of c/2 (n . (v_far - v_near))^2, of nodes
  /// that obey a law -v . dampingForce() / 2.
  double dissipation(const Field& u_m, const Field& v_m_per_s) const;
  double elasticEnergy(const Field& u_m) const;  ///< [J]
  double springEnergy(const Field& u_m) const;   ///< [J]
  double cellEnergy(const Field& u_m) const;     ///< energy of cells that obey a law [J]
  /// Returns the largest spring force, or that of a spring strained by 1e-6 if all are less [N]: the scale for
  /// residuals.
  double forceScale(const Field& u_m) const;

  /// Returns the row and column of a node's axis in stiffnessMatrix(): 3 * (place in `active`) + axis.
  int dof(uint32_t slot, int axis) const { return 3 * position_[slot] + axis; }
  int dofs() const { return 3 * static_cast<int>(active.size()); }
  /// Returns d2 elasticEnergy / du2, [dofs x dofs] [N/m]; symmetric, both halves stored.
  /// @param dashpot_per_s  adds c n n^T times this: the derivative of an implicit dashpot
  Eigen::SparseMatrix<double> stiffnessMatrix(const Field& u_m, Curvature curvature = Curvature::kTrue,
                                              double dashpot_per_s = 0) const;

  /// Erases a spring from both ends, and with it the volume of every cell that it belongs to.
  /// @param fraction  where it was cut, in (0, 1] from `slot`, of explicit connections from the end with the lower
  /// slot; or layout::kErasedShare
  void eraseSpring(uint32_t slot, uint32_t spring, double fraction = 1);
  uint32_t farEnd(uint32_t slot, uint32_t spring) const { return neighbor(slot, spring).slot; }

 protected:
  size_t bodies() const { return params_.size(); }
  const layout::BodyParams& body(uint32_t slot) const { return params_[nodes[slot].hi >> layout::kBodyShift]; }
  /// Returns whether the cells around a node obey a hyperelastic law. Springs act only in those that have lost a
  /// spring.
  bool obeysLaw(uint32_t slot) const { return body(slot).law != layout::kLawSprings; }
  /// Returns the positions at which leapfrog evaluates the forces of such cells: displacements ahead by dashpot_s [m],
  /// which damps (physics.md 2); of other bodies the current ones.
  Field lawPositions(const Field& u_m, const Field& v_m_per_s) const;

 private:
  struct Neighbor {
    uint32_t slot = 0;
    Vector3d offset_m = Vector3d::Zero();  ///< rest offset
    double rest_m = 0;                     ///< rest length; of explicit connections not always that of the offset
    bool first_end = false;
    uint32_t lattice_spring = layout::kNoLatticeSpring;  ///< spring index in the lattice, 0..17
    int64_t spring = -1;                                 ///< explicit connection: index in spring_cut
    double stiffness_n_per_m = 0;                        ///< stiffness of an explicit connection
  };
  struct Spring;  ///< direction, length and extension of one deformed spring
  struct Cell {
    std::array<uint32_t, 8> corners;  ///< slots; bit per axis, x lowest
    double spacing_m;
    LawCell law;  ///< valid while it is whole; no rigidity in bodies of springs

    bool isInWall() const { return law.wall.across > 0; }
  };
  /// Derivative of each of the sixteen vectors of a WallMotion by a node's displacement [1/m].
  using WallShare = Eigen::Matrix<double, 16, 1>;
  struct WallNode {
    uint32_t slot;
    WallShare share;
  };
  using WallStencil = std::vector<WallNode>;  ///< corners of a cell, and their neighbours along the axes
  using CornerForces = std::array<Vector3d, 8>;
  void addBody(const Model& model, size_t b, double dt_safe_s);
  void addLatticeSprings(const Lattice& lattice, uint32_t first);
  void addLinks(const SpringNetwork& network, uint32_t first);
  void addCell(const Body& body, size_t b, uint32_t local);
  void addOffset(const Lattice& lattice, uint32_t first, uint32_t local);
  const Neighbor& neighbor(uint32_t slot, uint32_t spring) const { return neighbors_[starts_[slot] + spring]; }
  Spring springAt(const Field& u_m, uint32_t slot, uint32_t spring) const;
  Spring springOf(const Vector3d& w_m, const Cell& cell, uint32_t slot, uint32_t spring) const;
  static Spring springBetween(const Neighbor& link, const Vector3d& w_m);
  void loseSpring(uint32_t slot, uint32_t lattice_spring);
  void killCells(uint32_t slot, uint32_t other);
  CellModes motionOf(const Field& u_m, const Cell& cell) const;
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
  std::vector<Strengths> strengths_;  ///< [bodies] empty for a body with one material; masses of networks
  CellMoments moments_;               ///< moments of the body that is being added
  std::unordered_map<uint32_t, LawLaminate> laminates_;           ///< laminates of the same body, by cell
  std::unordered_map<uint32_t, WallCell> walls_;                  ///< walls of the same body, by cell
  std::unordered_map<uint32_t, std::vector<size_t>> walls_near_;  ///< cells in thin walls, by node of their stencil
  struct AxialOfWall {
    uint32_t slot, spring;
    size_t cell;
  };
  std::vector<AxialOfWall> axial_of_walls_;  ///< used while bodies are added
  std::vector<uint32_t> first_;              ///< [bodies] slot offsets
  std::vector<bool> has_valences_;           ///< [bodies] NodeBits hold valences, not the counts of a lattice
  std::vector<uint32_t> starts_ = {0};       ///< [slots + 1] into neighbors_
  std::vector<Neighbor> neighbors_;          ///< ordered by node
  Field rest_m_;                             ///< [slots]
  std::vector<float> surface_depth_m_;       ///< [slots], or empty
  struct SurfaceOffset {
    Vector3d offset_m;  ///< vector to the surface at rest
    double spacing_m;
    std::array<int64_t, 3> to;  ///< slots of the neighbours along the axes in the direction of offset_m; -1 none
  };
  std::map<uint32_t, SurfaceOffset> offsets_;  ///< vectors of nodes outside their tissue, by slot
  std::vector<int> position_;                  ///< [slots] place in `active`, or -1
  std::vector<Cell> cells_;                    ///< [cells]
  std::vector<std::array<int, 8>> around_;     ///< [slots] cell that has the node as corner c, or -1
};

}  // namespace viscera
