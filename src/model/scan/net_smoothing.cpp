// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/net_smoothing.h"

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

constexpr double kBending = 0.4;  ///< step against the bilaplacian; stable up to 1/2
constexpr int kReturnEvery = 4;   ///< in rounds
constexpr double kRings = 10;  ///< rings over which movement is averaged, times the largest spacing over the smallest
constexpr int kLabels = 256;

/// Vertex at the other end of a quad's edge, and the labels of that quad.
struct Spoke {
  uint32_t to;
  std::array<uint8_t, 2> sides;
};

/// All spokes of one edge.
struct EdgeSpokes {
  const Spoke *first, *end;

  bool isJunction() const {  // three labels or more meet
    const auto [a, b] = first->sides;
    return std::any_of(first + 1, end, [a = a, b = b](const Spoke& s) {
      return (s.sides[0] != a && s.sides[0] != b) || (s.sides[1] != a && s.sides[1] != b);
    });
  }

  /// Returns whether some label has four faces here.
  bool touches() const {
    if (end - first < 4) return false;
    const auto facesOf = [&](uint8_t label) {
      return std::count_if(first, end, [&](const Spoke& s) { return s.sides[0] == label || s.sides[1] == label; });
    };
    return std::any_of(first, end, [&](const Spoke& s) {
      return (s.sides[0] != 0 && facesOf(s.sides[0]) >= 4) || (s.sides[1] != 0 && facesOf(s.sides[1]) >= 4);
    });
  }
};

/// Vertices that pull on a vertex: those along its edges, or, where three labels meet, only those along that line.
class Neighbors {
 public:
  explicit Neighbors(const NetCells& net) {
    const size_t vertices = net.positions_m.size();
    std::vector<size_t> first(vertices + 1, 0);
    for (const auto& quad : net.quads) {
      for (const uint32_t v : quad) first[v + 1] += 2;
    }
    for (size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<Spoke> spokes(first.back());
    std::vector<size_t> next(first.begin(), first.end() - 1);
    for (size_t q = 0; q < net.quads.size(); ++q) {
      for (int c = 0; c < 4; ++c) {
        const uint32_t a = net.quads[q][c], b = net.quads[q][(c + 1) % 4];
        spokes[next[a]++] = {b, net.sides[q]};
        spokes[next[b]++] = {a, net.sides[q]};
      }
    }
    start_.assign(1, 0);
    start_.reserve(vertices + 1);
    for (size_t v = 0; v < vertices; ++v) addVertex(v, spokes.data() + first[v], spokes.data() + first[v + 1]);
  }

  /// Returns the mean of the neighbours' values, less the vertex's own.
  Vector3d laplacian(const std::vector<Vector3d>& of, size_t v) const {
    Vector3d sum = Vector3d::Zero();
    for (size_t n = start_[v]; n < start_[v + 1]; ++n) sum += of[to_[n]];
    return sum / static_cast<double>(start_[v + 1] - start_[v]) - of[v];
  }

  size_t touchingEdges() const { return touching_; }

 private:
  void addVertex(size_t v, Spoke* first, Spoke* end) {
    std::sort(first, end, [](const Spoke& a, const Spoke& b) { return a.to < b.to; });
    const size_t begin = to_.size();
    std::vector<uint32_t>& along = along_;
    along.clear();
    for (Spoke* at = first; at != end;) {
      const EdgeSpokes edge{at, std::find_if(at, end, [&](const Spoke& s) { return s.to != at->to; })};
      to_.push_back(at->to);
      if (edge.isJunction()) along.push_back(at->to);
      if (v < at->to && edge.touches()) ++touching_;
      at = const_cast<Spoke*>(edge.end);
    }
    if (along.size() >= 2) {
      to_.resize(begin);
      to_.insert(to_.end(), along.begin(), along.end());
    }
    start_.push_back(static_cast<uint32_t>(to_.size()));
  }

  std::vector<uint32_t> start_, to_;
  std::vector<uint32_t> along_;  ///< vertices along the line of the vertex that is being added
  size_t touching_ = 0;
};

Vector3d areaOf(const std::vector<Vector3d>& x, const std::array<uint32_t, 4>& q) {
  return 0.5 * (x[q[2]] - x[q[0]]).cross(x[q[3]] - x[q[1]]);
}

/// Returns the volume between the origin and a quad, the mean of its two divisions into triangles.
double volumeBelow(const std::vector<Vector3d>& x, const std::array<uint32_t, 4>& q, const Vector3d& area) {
  return (x[q[0]] + x[q[1]] + x[q[2]] + x[q[3]]).dot(area) / 12;
}

class Smoother {
 public:
  Smoother(NetCells& net, const Vector3d& spacing_m, const SmoothingRule& rule)
      : net_(net),
        x_(net.positions_m),
        start_(net.positions_m),
        step_(x_.size()),
        reach_m_(rule.box * spacing_m),
        neighbors_(net) {}

  void bendLess() {
    scratch_.resize(x_.size());
    for (size_t v = 0; v < x_.size(); ++v) scratch_[v] = neighbors_.laplacian(x_, v);
    for (size_t v = 0; v < x_.size(); ++v) step_[v] = -kBending * neighbors_.laplacian(scratch_, v);
    move();
  }

  /// Reverts the average movement over some rings of neighbours: it would draw rims in and thicken their wall.
  void giveBack(int rings) {
    scratch_.resize(x_.size());
    for (size_t v = 0; v < x_.size(); ++v) step_[v] = x_[v] - start_[v];
    for (int r = 0; r < rings; ++r) {
      for (size_t v = 0; v < x_.size(); ++v) scratch_[v] = step_[v] + 0.5 * neighbors_.laplacian(step_, v);
      step_.swap(scratch_);
    }
    for (Vector3d& s : step_) s = -s;
    move();
  }

  /// Moves borders along their normals by the missing volume of each label per area; between two labels by the mean of
  /// both.
  void keepVolumes(const std::vector<double>& wanted_m3) {
    std::vector<double> lacks = wanted_m3, area(kLabels, 0);
    for (size_t q = 0; q < net_.quads.size(); ++q) {
      const Vector3d n = areaOf(x_, net_.quads[q]);
      const double below = volumeBelow(x_, net_.quads[q], n), size = n.norm();
      const auto [behind, before] = net_.sides[q];
      lacks[behind] -= below;
      lacks[before] += below;
      area[behind] += size;
      area[before] += size;
    }
    lacks[0] = 0;
    for (int l = 1; l < kLabels; ++l) lacks[l] = area[l] > 0 ? lacks[l] / area[l] : 0;
    std::fill(step_.begin(), step_.end(), Vector3d::Zero());
    weights_.assign(x_.size(), 0);
    for (size_t q = 0; q < net_.quads.size(); ++q) {
      const Vector3d n = areaOf(x_, net_.quads[q]);
      const auto [behind, before] = net_.sides[q];
      const double by = (lacks[behind] - lacks[before]) / (behind != 0 && before != 0 ? 2 : 1);
      for (const uint32_t v : net_.quads[q]) {
        step_[v] += by * n;
        weights_[v] += n.norm();
      }
    }
    for (size_t v = 0; v < x_.size(); ++v) {
      if (weights_[v] > 0) step_[v] /= weights_[v];
    }
    move();
  }

  size_t touchingEdges() const { return neighbors_.touchingEdges(); }

 private:
  void move() {
    for (size_t v = 0; v < x_.size(); ++v) {
      x_[v] = (x_[v] + step_[v]).cwiseMax(start_[v] - reach_m_).cwiseMin(start_[v] + reach_m_);
    }
  }

  NetCells& net_;
  std::vector<Vector3d>& x_;
  const std::vector<Vector3d> start_;
  std::vector<Vector3d> step_, scratch_;
  std::vector<double> weights_;
  const Vector3d reach_m_;
  const Neighbors neighbors_;
};

}  // namespace

size_t smooth(NetCells& net, const Vector3d& spacing_m, const SmoothingRule& rule,
              const std::vector<double>& volumes_m3) {
  Smoother smoother(net, spacing_m, rule);
  const int rings = static_cast<int>(std::lround(kRings * spacing_m.maxCoeff() / spacing_m.minCoeff()));
  for (int round = 1; round <= rule.rounds; ++round) {
    smoother.bendLess();
    if (round % kReturnEvery == 0) smoother.giveBack(rings);
    smoother.keepVolumes(volumes_m3);
  }
  return smoother.touchingEdges();
}

}  // namespace viscera
