// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/unfold.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "math/float_bits.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

constexpr double kAlone_s = 0.5;  // without a tool before a look: several periods of what swings back by itself
constexpr double kLong = 0.3;     // max |L - l0| / l0: what is folded has longer or shorter springs
constexpr int kMostRings = 8;     // of cells around folds
constexpr std::array<std::array<int, 2>, 12> kEdges = {
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

using Corners = std::array<uint32_t, 8>;  ///< slots of all bodies' nodes; x first

/// The whole cells of a body that is a lattice, of implicit connections or not.
std::vector<Corners> wholeCells(const Body& body, uint32_t offset, const HostState& state) {
  std::vector<Corners> out;
  if (!body.hasCells()) return out;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (!(state.nodes[offset + slot].lo & layout::kCellBit)) continue;
    Corners cell{};
    size_t c = 0;
    forEachCorner(body.lattice, slot, [&](const Vector3i&, uint32_t corner) { cell[c++] = offset + corner; });
    out.push_back(cell);
  }
  return out;
}

/// Where nodes of a body are over its spacing.
class Places {
 public:
  Places(const Body& body, uint32_t offset, const HostState& state) : body_(body), offset_(offset), state_(state) {}
  Vector3d operator()(uint32_t slot) const {
    const layout::vec4& u = state_.displacement_m[slot];
    return body_.lattice.nodeAt(slot - offset_).cast<double>() + Vector3d(u.x, u.y, u.z) / body_.lattice.spacing_m;
  }

 private:
  const Body& body_;
  uint32_t offset_;
  const HostState& state_;
};

/// Is a cell turned inside out at a corner: are its three edges there left-handed?
bool isFolded(const Corners& cell, const Places& at) {
  std::array<Vector3d, 8> x;
  for (size_t c = 0; c < 8; ++c) x[c] = at(cell[c]);
  for (size_t c = 0; c < 8; ++c) {
    const Vector3d along_x = x[c | 1] - x[c & ~size_t{1}], along_y = x[c | 2] - x[c & ~size_t{2}],
                   along_z = x[c | 4] - x[c & ~size_t{4}];
    if (along_x.cross(along_y).dot(along_z) < 0) return true;
  }
  return false;
}

size_t foldedOf(const std::vector<Corners>& cells, const Places& at) {
  return static_cast<size_t>(
      std::count_if(cells.begin(), cells.end(), [&](const Corners& cell) { return isFolded(cell, at); }));
}

void addNodes(const Corners& cell, std::set<uint32_t>& nodes) {
  nodes.insert(cell.begin(), cell.end());
}

/// [slots] 1 for those of a set: all cells ask.
std::vector<uint8_t> marksOf(const std::set<uint32_t>& nodes, const std::vector<Corners>& cells) {
  uint32_t last = 0;
  for (const Corners& cell : cells) last = std::max(last, *std::max_element(cell.begin(), cell.end()));
  std::vector<uint8_t> out(size_t{last} + 1);
  for (const uint32_t node : nodes) out[node] = 1;
  return out;
}

/// Those of a set and all of cells at which one of them is.
std::set<uint32_t> widened(const std::set<uint32_t>& nodes, const std::vector<Corners>& cells) {
  const std::vector<uint8_t> marks = marksOf(nodes, cells);
  std::set<uint32_t> out = nodes;
  for (const Corners& cell : cells) {
    if (std::any_of(cell.begin(), cell.end(), [&](uint32_t n) { return marks[n] != 0; })) addNodes(cell, out);
  }
  return out;
}

/// The edges of cells at nodes of a set, and how many cells have each.
std::map<std::pair<uint32_t, uint32_t>, int> edgesAt(const std::set<uint32_t>& nodes,
                                                     const std::vector<Corners>& cells) {
  const std::vector<uint8_t> marks = marksOf(nodes, cells);
  std::map<std::pair<uint32_t, uint32_t>, int> out;
  for (const Corners& cell : cells) {
    for (const auto& [a, b] : kEdges) {
      const uint32_t from = cell[static_cast<size_t>(a)], to = cell[static_cast<size_t>(b)];
      if (marks[from] != 0 || marks[to] != 0) ++out[{from, to}];
    }
  }
  return out;
}

using Edges = std::map<std::pair<uint32_t, uint32_t>, int>;

/// Of nodes those that hang, over one another, at one that is not among them.
std::map<uint32_t, int> hangingOf(const std::set<uint32_t>& nodes, const Edges& edges) {
  std::set<uint32_t> reached;
  for (size_t before = 1; before != reached.size();) {
    before = reached.size();
    for (const auto& [ends, count] : edges) {
      const bool a = nodes.count(ends.first) == 0 || reached.count(ends.first) != 0;
      const bool b = nodes.count(ends.second) == 0 || reached.count(ends.second) != 0;
      if (a != b) reached.insert(a ? ends.second : ends.first);
    }
  }
  std::map<uint32_t, int> out;
  for (const uint32_t node : reached) out.emplace(node, static_cast<int>(out.size()));
  return out;
}

using Fields = Eigen::Matrix<double, Eigen::Dynamic, 6>;  ///< displacement and velocity

Eigen::Matrix<double, 1, 6> fieldsAt(const HostState& state, uint32_t slot) {
  const layout::vec4 &u = state.displacement_m[slot], &v = state.velocity_m_per_s[slot];
  Eigen::Matrix<double, 1, 6> out;
  out << u.x, u.y, u.z, v.x, v.y, v.z;
  return out;
}

/// The affine motion that is nearest to how some nodes move; of the least where they lie in a plane or a line.
class Affine {
 public:
  Affine(const Body& body, uint32_t offset, const HostState& state, const std::set<uint32_t>& nodes)
      : body_(body), offset_(offset) {
    const auto size = static_cast<Eigen::Index>(nodes.size());
    Eigen::Matrix<double, Eigen::Dynamic, 4> places(size, 4);
    Fields fields(size, 6);
    Eigen::Index r = 0;
    for (const uint32_t slot : nodes) {
      places.row(r) = placeOf(slot);
      fields.row(r++) = fieldsAt(state, slot);
    }
    motion_ = places.completeOrthogonalDecomposition().solve(fields);
  }
  Eigen::Matrix<double, 1, 6> at(uint32_t slot) const { return placeOf(slot) * motion_; }

 private:
  Eigen::Matrix<double, 1, 4> placeOf(uint32_t slot) const {
    Eigen::Matrix<double, 1, 4> out;
    out << 1, body_.lattice.nodeAt(slot - offset_).cast<double>().transpose();
    return out;
  }
  const Body& body_;
  uint32_t offset_;
  Eigen::Matrix<double, 4, 6> motion_;
};

/// Puts nodes where the Laplace equation over the edges has them, of what is beyond the affine motion of those around
/// them: so tissue at a free surface goes on turning with the rest. @return how many
size_t smooth(const std::set<uint32_t>& nodes, const std::vector<Corners>& cells, const Body& body, uint32_t offset,
              HostState& state) {
  const Edges edges = edgesAt(nodes, cells);
  const std::map<uint32_t, int> row = hangingOf(nodes, edges);
  if (row.empty()) return 0;
  std::set<uint32_t> known;
  for (const auto& [ends, count] : edges) {
    for (const uint32_t end : {ends.first, ends.second}) {
      if (nodes.count(end) == 0) known.insert(end);
    }
  }
  const Affine affine(body, offset, state, known);
  const auto size = static_cast<Eigen::Index>(row.size());
  std::vector<Eigen::Triplet<double>> entries;
  Fields right = Fields::Zero(size, 6);
  for (const auto& [ends, count] : edges) {
    const auto a = row.find(ends.first), b = row.find(ends.second);
    for (const auto& [near, far, far_slot] : {std::make_tuple(a, b, ends.second), std::make_tuple(b, a, ends.first)}) {
      if (near == row.end()) continue;
      entries.emplace_back(near->second, near->second, count);
      if (far != row.end())
        entries.emplace_back(near->second, far->second, -count);
      else
        right.row(near->second) += count * (fieldsAt(state, far_slot) - affine.at(far_slot));
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Fields solved = solver.solve(right);
  for (const auto& [slot, r] : row) {
    const Eigen::Matrix<float, 1, 6> f = (solved.row(r) + affine.at(slot)).cast<float>();
    state.displacement_m[slot] = {f[0], f[1], f[2], 0};
    state.velocity_m_per_s[slot] = {f[3], f[4], f[5], 0};
  }
  return row.size();
}

size_t unfoldBody(const Body& body, uint32_t offset, HostState& state) {
  const std::vector<Corners> cells = wholeCells(body, offset, state);
  const Places now(body, offset, state);
  std::set<uint32_t> around;
  size_t folded = 0;
  for (const Corners& cell : cells) {
    if (!isFolded(cell, now)) continue;
    ++folded;
    addNodes(cell, around);
  }
  HostState best = state;
  size_t moved = 0;
  for (int ring = 0; folded > 0 && ring < kMostRings; ++ring) {
    around = widened(around, cells);
    std::set<uint32_t> free;
    for (const uint32_t slot : around) {
      if ((state.nodes[slot].lo & (layout::kFixedBit | layout::kGrabMask)) == 0) free.insert(slot);
    }
    HostState tried = state;
    const size_t count = smooth(free, cells, body, offset, tried);
    const size_t left = foldedOf(cells, Places(body, offset, tried));
    if (left >= folded) continue;
    folded = left;
    moved = count;
    best = std::move(tried);
  }
  if (moved > 0) state = std::move(best);
  return moved;
}

}  // namespace

size_t unfold(const Model& model, HostState& state) {
  size_t moved = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) moved += unfoldBody(model.bodies[b], model.slotOffset(b), state);
  return moved;
}

FoldWatch::FoldWatch(double tick_s) : wait_ticks_(std::max(1, static_cast<int>(std::lround(kAlone_s / tick_s)))) {}

bool FoldWatch::isDue(const layout::TickStats& stats) {
  if (stats.touched[0] + stats.touched[1] + stats.grabbed[0] + stats.grabbed[1] > 0) {
    looks_left_ = kLooks;
    ticks_left_ = wait_ticks_;
    return false;
  }
  if (looks_left_ == 0 || --ticks_left_ > 0) return false;
  const bool odd = stats.inverted > 0 || stats.collapsed > 0 || floatFromBits(stats.max_stretch_bits) > kLong;
  if (!odd) looks_left_ = 0;
  return odd;
}

void FoldWatch::found(size_t nodes) {
  looks_left_ = nodes > 0 ? looks_left_ - 1 : 0;
  ticks_left_ = wait_ticks_;
}

}  // namespace viscera
