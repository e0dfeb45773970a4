// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "solver/cpu/store/cpu_lattice.h"
#include "solver/cpu/store/parallel.h"
#include "solver/multigrid/levels/grid.h"

namespace viscera::multigrid {

/// A vector per place of a Grid: [3 * places], component by component; 0 where no node is.
using Vectors = AlignedVector<float>;

/// What a stage of a time integrator solves for a change s of displacement (physics.md 2):
///   (m (inertia + gamma rate) + K + c rate n n^T) s = r.
struct Stage {
  double inertia_per_s2 = 0;  ///< a0
  double rate_per_s = 0;      ///< d velocity / d displacement
};

/// A node that keeps to a plane: only what is across the normal is solved for.
struct Plane {
  uint32_t place;
  Vector3f normal;
};

/// Some nodes of the finest level, and what their forces hang on.
struct Region {
  std::vector<Block> blocks, cell_blocks;
};

/// How often the finest level was worked through.
struct FineWork {
  double forces =
      0;  ///< evaluations of all forces with their tangents or without; those of regions count by their share
  double products = 0;  ///< with the tangent
};

/// The finest level: nodes and springs of the lattice itself, its forces, and their tangent as a product that needs no
/// matrix. Springs are made positive, k (n n^T + max(0, 1 - l0/L)(1 - n n^T)); volumes count as B g g^T, moments at
/// constant directions of the cell's edges.
class FineLevel {
 public:
  /// @param lattice, parallel  must outlive it
  FineLevel(const Model& model, const CpuLattice& lattice, const Parallel& parallel);

  /// A copy of another one as it is, which works on threads of its own. The lattice is no longer looked at.
  FineLevel(const FineLevel& other, const Parallel& parallel) : FineLevel(other) { parallel_ = &parallel; }

  const Grid& grid() const { return grid_; }
  /// [slots] of the lattice when it was looked at last.
  using Nodes = std::shared_ptr<const std::vector<layout::NodeBits>>;
  const Nodes& nodes() const { return nodes_; }
  size_t places() const { return grid_.places(); }
  /// Takes springs, cells, masses and which nodes are free from the lattice: after cuts, and where nodes are let go.
  void refresh();
  /// Nodes that are prescribed beside those that never move, and nodes that keep to planes, until the next call.
  /// @param held  places   @param planes  those of a node at right angles
  void hold(const std::vector<uint32_t>& held, const std::vector<Plane>& planes = {});
  /// Takes what is along the normals of planes out of a vector.
  void project(Vectors& x) const;
  void begin(const Stage& stage);

  /// Forces, energy and tangent at a state. @return elastic energy [J]
  double linearise(const Vectors& displacement_m, const Vectors& velocity_m_per_s);
  /// Forces and energy alone: the tangent stays where it is.
  double evaluate(const Vectors& displacement_m, const Vectors& velocity_m_per_s);
  /// linearise() where only a region's nodes matter: forces of others are not what they should be.
  void lineariseIn(const Region& region, const Vectors& displacement_m, const Vectors& velocity_m_per_s);
  Region around(const std::vector<uint32_t>& nodes) const;
  const Vectors& force() const { return force_; }  ///< [N] of springs, dashpots and cells, on all nodes
  /// y = A x; or y -= A x. 0 where not free. @param x  0 where not free
  void apply(const Vectors& x, Vectors& y, bool subtract = false) const;
  /// copy = r, d = by D^-1 r.
  void precondition(const Vectors& r, float by, Vectors& copy, Vectors& d) const;
  /// r -= A x; d = again x + by D^-1 r; z += carried x + d. @return with . z
  double smooth(const Vectors& x, float again, float by, float carried, Vectors& r, Vectors& d, Vectors& z,
                const Vectors* with = nullptr) const;
  /// The same with z = x + d.
  void smoothFresh(const Vectors& x, float again, float by, Vectors& r, Vectors& d, Vectors& z) const;
  /// s += alpha p, r -= alpha q. @return r . r
  double advance(float alpha, const Vectors& p, const Vectors& q, Vectors& s, Vectors& r) const;
  /// p = z + beta p
  void turn(float beta, const Vectors& z, Vectors& p) const;

  double dot(const Vectors& a, const Vectors& b) const;  ///< summed in float64, always in the same order
  /// Calls each(place, count, constants of their body) for runs of places, side by side.
  template <class Each>
  void forPlaces(const Each& each) const {
    parallel()(jobs(), [&](size_t job) {
      for (size_t b = job * kBlocksPerJob; b < std::min(grid_.blocks.size(), (job + 1) * kBlocksPerJob); ++b)
        each(size_t{grid_.blocks[b].at}, kBlock, boxes_[grid_.blocks[b].body].params);
    });
  }
  /// Sum over nodes of what each(place) returns, always in the same order.
  template <class Each>
  double sum(const Each& each) const {
    parallel()(jobs(), [&](size_t job) {
      double out = 0;
      for (size_t b = job * kBlocksPerJob; b < std::min(grid_.blocks.size(), (job + 1) * kBlocksPerJob); ++b) {
        for (size_t i = grid_.blocks[b].at; i < grid_.blocks[b].at + kBlock; ++i) out += each(i);
      }
      sums_[job] = out;
    });
    double out = 0;
    for (const double each_job : sums_) out += each_job;
    return out;
  }

  const float* mass() const { return mass_.data(); }        ///< [places] kg, 0 where no node is
  const float* free() const { return free_.data(); }        ///< [places] 1 of nodes that are solved for, else 0
  const float* movable() const { return movable_.data(); }  ///< the same with those that are held
  /// How a node gives under a force while others stay [m/N], the least of three directions. After linearise().
  float give(size_t place) const {
    return std::min({inverse_[place], inverse_[3 * places() + place], inverse_[5 * places() + place]});
  }
  /// Solution of a node's own block of the tangent, as smooth() uses it. After linearise().
  Vector3f solveBlock(size_t place, const Vector3f& r) const;
  const Parallel& parallel() const { return *parallel_; }
  const FineWork& work() const { return done_; }

  // What coarse levels are made of, at rest.
  float stiffness(size_t pair, size_t place) const { return stiffness_[pair * places() + place]; }
  double stiffest() const;  ///< largest sum of a node's springs, each counted by its owner and twice [N/m]
  const float* stiffnessesOf(size_t pair) const { return &stiffness_[pair * places()]; }  ///< [places] N/m
  float bulk(size_t place) const { return bulk_.empty() ? 0 : bulk_[place]; }
  float rigidity(size_t place) const { return rigidity_.empty() ? 0 : rigidity_[place]; }
  const float* moments() const { return moments_.empty() ? nullptr : moments_.data(); }
  /// [kBendNumbers] of the cell at a place, kBlock apart; null: it has no bend.
  const float* bendAt(size_t place) const;
  float diagonal(size_t place) const { return diagonal_[place]; }
  const Box& box(uint32_t body) const { return boxes_[body]; }

 private:
  FineLevel(const FineLevel&) = default;
  static constexpr size_t kBlocksPerJob = 32;
  size_t jobs() const { return sums_.size(); }
  FineArrays arrays() const;
  void loadCells();
  void loadBends();
  double smooth(const Smoothing& smoothing) const;
  void projectAt(const Plane& plane, float* x) const;
  double smoothHeld(const Smoothing& smoothing) const;
  template <class Kernel>
  double sumBlocks(const Kernel& kernel) const;
  template <class Kernel>
  void runBlocks(const std::vector<Block>& blocks, const Kernel& kernel) const;
  double run(EvaluateCells cells, EvaluateNodes nodes, const std::vector<Block>& blocks,
             const std::vector<Block>& cell_blocks, const Vectors& u, const Vectors& v);

  const CpuLattice& lattice_;
  const Parallel* parallel_;
  Grid grid_;
  FineKernels kernels_;
  CellKind cells_;
  std::vector<Box> boxes_;
  std::vector<Block> cell_blocks_;
  std::vector<uint32_t> cell_nodes_;  ///< nodes above which a cell is, whole
  std::vector<uint32_t> held_;        ///< places
  Nodes nodes_;
  std::vector<Plane> planes_;
  const float *displacement_ = nullptr, *velocity_ = nullptr;
  mutable std::vector<double> sums_;  ///< [jobs]
  mutable FineWork done_;
  AlignedVector<float> stiffness_, mass_, free_, movable_, diagonal_, bulk_, rigidity_, moments_, bends_;
  std::vector<uint32_t> bend_block_;  ///< as in FineArrays: places, not addresses, as levels are copied
  mutable AlignedVector<uint16_t> tangent_;
  mutable AlignedVector<float> edges_, resists_, corners_, inverse_;
  mutable Vectors force_;
};

}  // namespace viscera::multigrid
