// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/carried_tissue.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>
#include <utility>

namespace viscera {

namespace {

constexpr int kReach = 2;        ///< largest distance at which an old node is searched around a position, in spacings
constexpr double kRidge = 1e-6;  ///< regularisation of a fit: damps undetermined gradients, in spacings
constexpr double kNearest_sq = 0.1;   ///< nearer nodes weigh no more than at this distance [spacings^2]
constexpr float kLeastShare = 0.02f;  ///< as in CutSprings
constexpr int kShareSteps = 32;       ///< resolution of the search for the position of a cut along a spring

uint32_t slotsOf(const Body& body) {
  return static_cast<uint32_t>(body.lattice.nodes.size());
}

bool isIsolated(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

struct Motion {
  Vector3d displacement_m = Vector3d::Zero(), velocity_m_per_s = Vector3d::Zero();
};

/// One lattice in its state.
class OldLattice {
 public:
  /// Nodes around a node that springs connect to it within a box.
  using Reached = std::unordered_set<uint32_t>;

  OldLattice(const Lattice& lattice, const HostState& state, uint32_t offset)
      : lattice_(lattice), state_(state), offset_(offset) {
    is_cut_ = std::any_of(lattice.active_slots.begin(), lattice.active_slots.end(),
                          [this](uint32_t slot) { return (bits(slot).lo & layout::kSeveredBit) != 0; });
  }

  bool isCut() const { return is_cut_; }  ///< some spring is cut

  /// Returns a rest position in spacings from node (0, 0, 0).
  Vector3d positionOf(const Vector3d& rest_m) const { return (rest_m - lattice_.origin_m) / lattice_.spacing_m; }

  /// Returns the node next to a position, on its side of cuts, or -1 if none is near.
  int64_t nearest(const Vector3d& position) const {
    const Vector3i middle = position.array().round().cast<int>();
    int64_t best = -1;
    double best_sq = 0;
    for (int reach = 0; reach <= kReach && best < 0; ++reach) {
      visitBox(middle.array() - reach, middle.array() + reach, [&](const Vector3i& node, uint32_t slot) {
        const double sq = (node.cast<double>() - position).squaredNorm();
        if (best < 0 || sq < best_sq) {
          best = slot;
          best_sq = sq;
        }
      });
    }
    return best < 0 ? best : acrossCut(static_cast<uint32_t>(best), position);
  }

  bool isLost(uint32_t slot) const { return isIsolated(bits(slot)) && !isIsolated(lattice_.nodes[slot]); }

  Motion motionAt(const Vector3d& position) const {
    const Vector3i lowest = position.array().floor().cast<int>();
    const int64_t cell = lattice_.slotAt(lowest);
    if (cell >= 0 && (bits(static_cast<uint32_t>(cell)).lo & layout::kCellBit))
      return within(static_cast<uint32_t>(cell), position - lowest.cast<double>());
    const int64_t next = nearest(position);
    if (next < 0) return {};
    return fitted(position,
                  reachedFrom(static_cast<uint32_t>(next), box(lattice_.nodeAt(static_cast<uint32_t>(next)))));
  }

  /// Returns where the line between two positions is cut, as a share of its length; 0: nowhere.
  float cutShare(const Vector3d& from, const Vector3d& to) const {
    const int64_t a = nearest(from), b = nearest(to);
    if (a < 0 || b < 0 || a == b) return 0;
    const Box around = box(lattice_.nodeAt(static_cast<uint32_t>(a)), lattice_.nodeAt(static_cast<uint32_t>(b)));
    if (!isCutIn(around)) return 0;
    const Reached side = reachedFrom(static_cast<uint32_t>(a), around);
    if (side.count(static_cast<uint32_t>(b)) > 0) return 0;
    if (reachedFrom(static_cast<uint32_t>(a), around, true).count(static_cast<uint32_t>(b)) == 0) return 0;
    for (int s = 1; s <= kShareSteps; ++s) {
      const double share = static_cast<double>(s) / kShareSteps;
      const int64_t at = nearest(from + share * (to - from));
      if (at < 0 || side.count(static_cast<uint32_t>(at)) > 0) continue;
      return std::clamp(static_cast<float>(share - 0.5 / kShareSteps), kLeastShare, 1 - kLeastShare);
    }
    return 0.5f;
  }

 private:
  struct Box {
    Vector3i low, high;
  };

  /// Returns the neighbour across a cut if the position is on that side; else the same node.
  int64_t acrossCut(uint32_t slot, const Vector3d& position) const {
    if (!(bits(slot).lo & layout::kSeveredBit) || state_.axial_cut.empty()) return slot;
    const Vector3d offset = position - lattice_.nodeAt(slot).cast<double>();
    int64_t out = slot;
    double furthest = 0;
    for (int c = 0; c < 3; ++c) {
      const uint32_t spring = 2 * static_cast<uint32_t>(c) + (offset[c] < 0);
      const int64_t there = lattice_.neighborSlot(slot, spring);
      if (there < 0 || springCount(bits(slot), spring) != 0) continue;
      const uint32_t lower = offset[c] < 0 ? static_cast<uint32_t>(there) : slot;
      const double cut = state_.axial_cut[3 * (offset_ + lower) + static_cast<uint32_t>(c)];
      if (cut == 0 || cut >= layout::kErasedShare) continue;
      const double beyond = std::abs(offset[c]) - (offset[c] < 0 ? 1 - cut : cut);
      if (beyond <= furthest) continue;
      furthest = beyond;
      out = there;
    }
    return out;
  }

  const layout::NodeBits& bits(uint32_t slot) const { return state_.nodes[offset_ + slot]; }

  template <class Visit>
  void visitBox(const Vector3i& low, const Vector3i& high, Visit visit) const {
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const int64_t slot = lattice_.slotAt({x, y, z});
          if (slot >= 0) visit(Vector3i(x, y, z), static_cast<uint32_t>(slot));
        }
  }

  static Box box(const Vector3i& a, const Vector3i& b) {
    return {a.cwiseMin(b).array() - 1, a.cwiseMax(b).array() + 1};
  }
  static Box box(const Vector3i& a) { return box(a, a); }

  bool isCutIn(const Box& around) const {
    bool found = false;
    visitBox(around.low, around.high, [&](const Vector3i& /*node*/, uint32_t slot) {
      found = found || (bits(slot).lo & layout::kSeveredBit) != 0;
    });
    return found;
  }

  Reached reachedFrom(uint32_t slot, const Box& around, bool at_rest = false) const {
    Reached out{slot};
    std::vector<uint32_t> front{slot};
    while (!front.empty()) {
      const uint32_t here = front.back();
      front.pop_back();
      for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
        if (springCount(at_rest ? lattice_.nodes[here] : bits(here), s) == 0) continue;
        const int64_t there = lattice_.neighborSlot(here, s);
        if (there < 0) continue;
        const Vector3i node = lattice_.nodeAt(static_cast<uint32_t>(there));
        if ((node.array() < around.low.array()).any() || (node.array() > around.high.array()).any()) continue;
        if (out.insert(static_cast<uint32_t>(there)).second) front.push_back(static_cast<uint32_t>(there));
      }
    }
    return out;
  }

  Motion of(uint32_t slot) const {
    const layout::vec4& u = state_.displacement_m[offset_ + slot];
    const layout::vec4& v = state_.velocity_m_per_s[offset_ + slot];
    return {{u.x, u.y, u.z}, {v.x, v.y, v.z}};
  }

  /// Interpolates trilinearly within a cell.
  Motion within(uint32_t cell, const Vector3d& share) const {
    Motion out;
    forEachCorner(lattice_, cell, [&](const Vector3i& corner, uint32_t slot) {
      double weight = 1;
      for (int c = 0; c < 3; ++c) weight *= corner[c] ? share[c] : 1 - share[c];
      const Motion motion = of(slot);
      out.displacement_m += weight * motion.displacement_m;
      out.velocity_m_per_s += weight * motion.velocity_m_per_s;
    });
    return out;
  }

  /// Fits the linear field closest to the values at some nodes, weighted towards those near the position.
  Motion fitted(const Vector3d& position, const Reached& nodes) const {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 6> right = Eigen::Matrix<double, 4, 6>::Zero();
    // ascending slots: the sums are the same in every run
    for (const uint32_t slot : sorted(nodes)) {
      const Vector3d offset = lattice_.nodeAt(slot).cast<double>() - position;
      const double weight = 1 / (offset.squaredNorm() + kNearest_sq);
      const Eigen::Vector4d basis(1, offset.x(), offset.y(), offset.z());
      const Motion motion = of(slot);
      Eigen::Matrix<double, 6, 1> value;
      value << motion.displacement_m, motion.velocity_m_per_s;
      normal += weight * basis * basis.transpose();
      right += weight * basis * value.transpose();
    }
    normal.diagonal().tail<3>().array() += kRidge;
    const Eigen::Matrix<double, 4, 6> fit = normal.ldlt().solve(right);
    return {fit.row(0).head<3>().transpose(), fit.row(0).tail<3>().transpose()};
  }

  static std::vector<uint32_t> sorted(const Reached& nodes) {
    std::vector<uint32_t> out(nodes.begin(), nodes.end());
    std::sort(out.begin(), out.end());
    return out;
  }

  const Lattice& lattice_;
  const HostState& state_;
  const uint32_t offset_;
  bool is_cut_ = false;
};

/// The lattice that receives the state.
class NewLattice {
 public:
  /// @param first_spring  index of the body's first spring in HostState::spring_cut
  NewLattice(const Body& body, HostState& state, uint32_t offset, size_t first_spring)
      : lattice_(body.lattice), state_(state), offset_(offset), first_spring_(first_spring) {
    if (!body.network) return;
    for (size_t i = 0; i < body.network->springs.size(); ++i) {
      const NetworkSpring& spring = body.network->springs[i];
      if (spring.lattice_spring != layout::kNoLatticeSpring) links_[{spring.a, spring.b}] = i;
    }
  }

  void take(const OldLattice& old) {
    std::vector<bool> lost(lattice_.nodes.size());
    for (const uint32_t slot : lattice_.active_slots) {
      const Vector3d position = old.positionOf(lattice_.restPosition(slot));
      const Motion motion = old.motionAt(position);
      const int64_t next = old.nearest(position);
      lost[slot] = next >= 0 && old.isLost(static_cast<uint32_t>(next));
      if (isFixed(state_.nodes[offset_ + slot]) || lost[slot]) continue;
      set(state_.displacement_m[offset_ + slot], motion.displacement_m);
      set(state_.velocity_m_per_s[offset_ + slot], motion.velocity_m_per_s);
    }
    if (!old.isCut()) return;
    for (const uint32_t slot : lattice_.active_slots) {
      const Vector3d position = old.positionOf(lattice_.restPosition(slot));
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; spring += 2) {
        const int64_t there = lattice_.neighborSlot(slot, spring);
        if (there < 0 || springCount(lattice_.nodes[slot], spring) == 0) continue;
        const bool end_lost = lost[slot] || lost[static_cast<size_t>(there)];
        const float share =
            end_lost ? layout::kErasedShare
                     : old.cutShare(position, old.positionOf(lattice_.restPosition(static_cast<uint32_t>(there))));
        if (share > 0) cut(slot, static_cast<uint32_t>(there), spring, share);
      }
    }
  }

 private:
  static void set(layout::vec4& at, const Vector3d& value) {
    at = {static_cast<float>(value.x()), static_cast<float>(value.y()), static_cast<float>(value.z()), 0};
  }

  /// Cuts a spring as a blade does: both ends lose it, and cells with both among their corners are no longer whole.
  void cut(uint32_t a, uint32_t b, uint32_t spring, float share) {
    layout::NodeBits &of_a = state_.nodes[offset_ + a], &of_b = state_.nodes[offset_ + b];
    setSpringCount(of_a, spring, 0);
    setSpringCount(of_b, oppositeSpring(spring), 0);
    of_a.lo |= layout::kSeveredBit;
    of_b.lo |= layout::kSeveredBit;
    const Vector3i offset(kNeighborOffsets[spring][0], kNeighborOffsets[spring][1], kNeighborOffsets[spring][2]);
    const Vector3i node = lattice_.nodeAt(a);
    for (int c = 0; c < 8; ++c) {
      const Vector3i corner(c & 1, (c >> 1) & 1, (c >> 2) & 1), other = corner + offset;
      if (other.minCoeff() < 0 || other.maxCoeff() > 1) continue;
      const int64_t cell = lattice_.slotAt(node - corner);
      if (cell >= 0) state_.nodes[offset_ + static_cast<uint32_t>(cell)].lo &= ~layout::kCellBit;
    }
    if (isAxial(spring) && !state_.axial_cut.empty()) state_.axial_cut[3 * (offset_ + a) + spring / 2] = share;
    const auto link = links_.find(std::minmax(a, b));
    if (link == links_.end()) return;
    state_.spring_cut[first_spring_ + link->second] = a < b || share >= layout::kErasedShare ? share : 1 - share;
  }

  const Lattice& lattice_;
  HostState& state_;
  const uint32_t offset_;
  const size_t first_spring_;
  std::map<std::pair<uint32_t, uint32_t>, size_t> links_;  ///< of explicit lattices
};

bool isSame(const Body& a, const Body& b) {
  return slotsOf(a) == slotsOf(b) && a.lattice.spacing_m == b.lattice.spacing_m &&
         a.lattice.active_slots == b.lattice.active_slots && a.network.has_value() == b.network.has_value() &&
         (!a.network || a.network->springs.size() == b.network->springs.size());
}

size_t springsOf(const Body& body) {
  return body.network ? body.network->springs.size() : 0;
}

template <class T>
void copyRange(const std::vector<T>& from, size_t at, size_t count, std::vector<T>& to, size_t to_at) {
  if (from.size() < at + count || to.size() < to_at + count) return;  // one of the two has no record of cuts
  std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), count, to.begin() + static_cast<std::ptrdiff_t>(to_at));
}

}  // namespace

HostState carriedState(const CarriedTissue& from, const Model& to, HostState rest) {
  size_t old_spring = 0, new_spring = 0;
  for (size_t b = 0; b < to.bodies.size(); ++b) {
    const Body &before = from.model->bodies[b], &body = to.bodies[b];
    const uint32_t old_slot = from.model->slotOffset(b), slot = to.slotOffset(b);
    if (isSame(before, body)) {
      const size_t slots = slotsOf(body);
      copyRange(from.state.displacement_m, old_slot, slots, rest.displacement_m, slot);
      copyRange(from.state.velocity_m_per_s, old_slot, slots, rest.velocity_m_per_s, slot);
      copyRange(from.state.nodes, old_slot, slots, rest.nodes, slot);
      copyRange(from.state.axial_cut, 3 * size_t{old_slot}, 3 * slots, rest.axial_cut, 3 * size_t{slot});
      copyRange(from.state.spring_cut, old_spring, springsOf(body), rest.spring_cut, new_spring);
      for (size_t i = 0; i < slots; ++i) rest.nodes[slot + i].lo &= ~layout::kGrabMask;
    } else {
      NewLattice(body, rest, slot, new_spring).take(OldLattice(before.lattice, from.state, old_slot));
    }
    old_spring += springsOf(before);
    new_spring += springsOf(body);
  }
  return rest;
}

}  // namespace viscera
