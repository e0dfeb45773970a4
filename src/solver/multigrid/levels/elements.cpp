// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/elements.h"

#include <cmath>
#include <cstring>
#include <map>

#include "viscera/model/body/bend_matrices.h"
#include "viscera/model/body/neighbors.h"

namespace viscera::multigrid {

namespace {

constexpr int kElementCorners = 8;
constexpr size_t kSpringsOfCell = 24;  // twelve edges, twelve diagonals of faces

int cornerOf(int x, int y, int z) {
  return x + 2 * y + 4 * z;
}

/// A spring between two corners of a cell: from corner `from`, which owns it as its pair, to corner `to`.
struct CellSpring {
  int from, to;
  size_t pair;
};

std::vector<CellSpring> springsOfCell() {
  std::vector<CellSpring> out;
  for (size_t pair = 0; pair < kPairs; ++pair) {
    const std::array<int, 3>& o = kNeighborOffsets[2 * pair];
    for (int c = 0; c < kElementCorners; ++c) {
      const int x = (c & 1) + o[0], y = (c >> 1 & 1) + o[1], z = (c >> 2) + o[2];
      if (x < 0 || x > 1 || y < 0 || y > 1 || z < 0 || z > 1) continue;
      out.push_back({c, cornerOf(x, y, z), pair});
    }
  }
  return out;
}

/// What an element is made of; those that are alike share a matrix.
struct Recipe {
  std::array<float, kSpringsOfCell> stiffness{};
  std::array<float, 8> diagonal{};
  std::array<float, 9> moments{};
  float bulk = 0, rigidity = 0, spacing_m = 0, damping = 0;
  uint32_t thin = 0;  ///< 1 + place of a cell with a bend: no two have the same

  bool operator<(const Recipe& other) const { return std::memcmp(this, &other, sizeof(Recipe)) < 0; }
};

using Motion = Eigen::Matrix<double, 21, 21>;
using Strain = Eigen::Matrix<double, 6, 21>;  // xx, yy, zz, 2 yz, 2 zx, 2 xy by the motion of a cell

/// d motion / d displacement of a corner is this times the axis: three mean edges, four hourglass motions, over h.
Eigen::Matrix<double, 7, 1> motionOfCorner(int corner, double spacing_m) {
  const double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1, z = corner & 4 ? 1 : -1;
  Eigen::Matrix<double, 7, 1> out;
  out << x / 4, y / 4, z / 4, y * z / 2, z * x / 2, x * y / 2, x * y * z / std::sqrt(8.0);
  return out / spacing_m;
}

int hourglass(int which, int axis) {
  return 9 + 3 * which + axis;
}

/// Gradient of strain along an axis; see physics.md 1.
Strain strainGradient(int n, double poisson) {
  const int a = (n + 1) % 3, b = (n + 2) % 3;
  Strain out = Strain::Zero();
  out(a, hourglass(b, a)) = 1;  // s_ab
  out(b, hourglass(a, b)) = 1;
  out.row(n) = -poisson * (out.row(a) + out.row(b));
  out(3 + n, hourglass(a, a)) = out(3 + n, hourglass(b, b)) = 1;
  return out;
}

/// d2 energy / d motion2 of a cell's moments at rest [J] (physics.md 1).
/// @param bend  FineLevel::bendAt() of it
Motion momentsAtRest(const Recipe& recipe, const float* bend) {
  constexpr double kAlternating = 5.0 / 18 - 0.5;
  const double rigidity = static_cast<double>(recipe.rigidity),
               lambda = 1 + static_cast<double>(recipe.bulk) / rigidity;
  const double poisson = lambda / (lambda + 2);  // nu / (1 - nu)
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  stiffness.topLeftCorner<3, 3>().setConstant(lambda);
  for (int i = 0; i < 3; ++i) {
    stiffness(i, i) += 2;
    stiffness(3 + i, 3 + i) = 1;
  }
  Strain mean = Strain::Zero(), gradient[3];
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    mean(n, 4 * n) = 1;
    mean(3 + n, 3 * a + b) = mean(3 + n, 3 * b + a) = 1;
    gradient[n] = strainGradient(n, poisson);
  }
  const double h2 = 2 * static_cast<double>(recipe.spacing_m);
  const auto m = [&](int i) { return static_cast<double>(recipe.moments[static_cast<size_t>(i)]); };
  Motion out = Motion::Zero();
  for (int n = 0; n < 3; ++n) {
    const Motion mixed = (m(n) / h2) * mean.transpose() * stiffness * gradient[n];
    out += mixed + mixed.transpose();
    for (int j = 0; j < 3; ++j)
      out += m(n == j ? 3 + n : 6 + 3 - n - j) * gradient[n].transpose() * stiffness * gradient[j];
  }
  if (bend != nullptr) {
    Eigen::Matrix<double, 9, 21> s = Eigen::Matrix<double, 9, 21>::Zero();
    for (int i = 0; i < 9; ++i) s(i, hourglass(i % 3, i / 3)) = 1;
    BendMatrix pairs = BendMatrix::Zero();
    Eigen::Matrix<double, 9, 6> strains;
    const auto next = [&] {
      const double number = static_cast<double>(*bend);
      bend += kBlock;
      return number;
    };
    for (int i = 0; i < 9; ++i) {
      for (int j = i; j < 9; ++j) pairs(i, j) = pairs(j, i) = next();
    }
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 6; ++j) strains(i, j) = next() / h2;
    }
    const Motion mixed = s.transpose() * strains * mean;
    out += s.transpose() * pairs * s + mixed + mixed.transpose();
  }
  Eigen::Matrix<double, 1, 21> trace = Eigen::Matrix<double, 1, 21>::Zero();
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3;
    trace(hourglass(n, n)) = 1;
    Eigen::Matrix<double, 1, 21> pair = Eigen::Matrix<double, 1, 21>::Zero();
    pair(hourglass(a, n)) = pair(hourglass(n, a)) = 1;
    out -= 0.25 * pair.transpose() * pair;
    for (int axis = 0; axis < 3; ++axis) out(hourglass(n, axis), hourglass(n, axis)) -= 0.25;
    out(hourglass(3, n), hourglass(3, n)) += kAlternating;
  }
  out -= 0.25 * trace.transpose() * trace;
  return rigidity * out;
}

/// @param bend  as of momentsAtRest()
ElementMatrix matrixOf(const Recipe& recipe, const std::vector<CellSpring>& springs, const float* bend) {
  Eigen::Matrix<double, 24, 24> out = Eigen::Matrix<double, 24, 24>::Zero();
  for (size_t s = 0; s < springs.size(); ++s) {
    const int a = 3 * springs[s].from, b = 3 * springs[s].to;
    const std::array<int, 3>& o = kNeighborOffsets[2 * springs[s].pair];
    const Vector3d n = Vector3d(o[0], o[1], o[2]).normalized();
    const Eigen::Matrix3d t =
        static_cast<double>(recipe.stiffness[s]) * (1 + static_cast<double>(recipe.damping)) * n * n.transpose();
    out.block<3, 3>(a, a) += t;
    out.block<3, 3>(b, b) += t;
    out.block<3, 3>(a, b) -= t;
    out.block<3, 3>(b, a) -= t;
  }
  for (int c = 0; c < kElementCorners; ++c)
    out.block<3, 3>(3 * c, 3 * c) +=
        static_cast<double>(recipe.diagonal[static_cast<size_t>(c)]) * Eigen::Matrix3d::Identity();
  const double spacing_m = static_cast<double>(recipe.spacing_m);
  Eigen::Matrix<double, 21, 24> motion = Eigen::Matrix<double, 21, 24>::Zero();
  for (int c = 0; c < kElementCorners; ++c) {
    const Eigen::Matrix<double, 7, 1> of_corner = motionOfCorner(c, spacing_m);
    for (int i = 0; i < 7; ++i)
      for (int axis = 0; axis < 3; ++axis) motion(3 * i + axis, 3 * c + axis) = of_corner[i];
  }
  const Eigen::Matrix<double, 1, 24> volume = motion.row(0) + motion.row(4) + motion.row(8);
  out += static_cast<double>(recipe.bulk) * volume.transpose() * volume;
  if (recipe.rigidity > 0) out += motion.transpose() * momentsAtRest(recipe, bend) * motion;
  return out.cast<float>();
}

/// Corners of a cell as its live springs join them: the lowest corner of each one's piece.
std::array<int, kElementCorners> piecesOf(const Recipe& recipe, const std::vector<CellSpring>& springs) {
  std::array<int, kElementCorners> piece{};
  for (int c = 0; c < kElementCorners; ++c) piece[static_cast<size_t>(c)] = c;
  for (int round = 0; round < kElementCorners; ++round) {
    for (size_t s = 0; s < springs.size(); ++s) {
      if (recipe.stiffness[s] == 0) continue;
      int &a = piece[static_cast<size_t>(springs[s].from)], &b = piece[static_cast<size_t>(springs[s].to)];
      a = b = std::min(a, b);
    }
  }
  return piece;
}

/// Cuts cells into elements.
class Cutter {
 public:
  explicit Cutter(const FineLevel& level)
      : level_(level),
        grid_(level.grid()),
        springs_(springsOfCell()),
        cells_(kPairs * level.places()),
        shares_(grid_.nodeCount()) {}

  Elements run() {
    out_.nodes.at = grid_.at;
    for (uint32_t node = 0; node < grid_.nodeCount(); ++node) {
      out_.nodes.body.push_back(grid_.bodyOf(node));
      out_.free.push_back(level_.free()[grid_.place_of[node]] > 0 ? 1 : 0);
      if (isCell(node)) cells_with_tissue_.push_back(node);
    }
    for (const uint32_t cell : cells_with_tissue_) countCell(cell);
    for (const uint32_t cell : cells_with_tissue_) addCell(cell);
    return std::move(out_);
  }

 private:
  /// Are all eight corners nodes? Springs are between corners of such cells only.
  bool isCell(uint32_t node) const {
    for (int c = 0; c < kElementCorners; ++c) {
      if (grid_.node_at[corner(node, c)] < 0) return false;
    }
    return true;
  }
  size_t corner(uint32_t node, int c) const {
    return grid_.beside(grid_.bodyOf(node), grid_.place_of[node], c & 1, c >> 1 & 1, c >> 2);
  }
  /// Springs whole, not yet shared between the cells around them.
  Recipe springsIn(uint32_t cell) const {
    Recipe out;
    for (size_t s = 0; s < springs_.size(); ++s)
      out.stiffness[s] = level_.stiffness(springs_[s].pair, corner(cell, springs_[s].from));
    return out;
  }
  void countCell(uint32_t cell) {
    const Recipe recipe = springsIn(cell);
    for (size_t s = 0; s < springs_.size(); ++s)
      ++cells_[springs_[s].pair * level_.places() + corner(cell, springs_[s].from)];
    const std::array<int, kElementCorners> piece = piecesOf(recipe, springs_);
    for (int c = 0; c < kElementCorners; ++c) {
      if (isShared(piece, c)) ++shares_[static_cast<size_t>(grid_.node_at[corner(cell, c)])];
    }
  }
  /// Is a corner joined to another one?
  static bool isShared(const std::array<int, kElementCorners>& piece, int c) {
    for (int other = 0; other < kElementCorners; ++other) {
      if (other != c && piece[static_cast<size_t>(other)] == piece[static_cast<size_t>(c)]) return true;
    }
    return false;
  }
  void addCell(uint32_t cell) {
    const Recipe whole = springsIn(cell);
    const std::array<int, kElementCorners> piece = piecesOf(whole, springs_);
    for (int first = 0; first < kElementCorners; ++first) {
      if (piece[static_cast<size_t>(first)] != first || !isShared(piece, first)) continue;
      addPiece(cell, whole, piece, first);
    }
  }
  void addPiece(uint32_t cell, const Recipe& whole, const std::array<int, kElementCorners>& piece, int first) {
    const uint32_t body = grid_.bodyOf(cell);
    const size_t place = grid_.place_of[cell];
    Element element;
    element.at = grid_.at[cell];
    element.body = body;
    Recipe recipe;
    recipe.spacing_m = level_.box(body).params.origin_spacing.w;
    recipe.damping = level_.box(body).params.dashpot_s * level_.box(body).damping_rate_per_s;
    for (int c = 0; c < kElementCorners; ++c) {
      const size_t at = corner(cell, c);
      const bool in = piece[static_cast<size_t>(c)] == first;
      element.nodes[static_cast<size_t>(c)] = in ? grid_.node_at[at] : -1;
      if (in)
        recipe.diagonal[static_cast<size_t>(c)] =
            level_.diagonal(at) / static_cast<float>(shares_[static_cast<size_t>(grid_.node_at[at])]);
    }
    for (size_t s = 0; s < springs_.size(); ++s) {
      if (piece[static_cast<size_t>(springs_[s].from)] != first) continue;
      const size_t of = springs_[s].pair * level_.places() + corner(cell, springs_[s].from);
      recipe.stiffness[s] = whole.stiffness[s] / static_cast<float>(cells_[of]);
    }
    recipe.bulk = level_.bulk(place);  // 0 of cells that lost a spring
    recipe.rigidity = level_.rigidity(place);
    if (recipe.rigidity > 0) {
      for (size_t i = 0; i < 9; ++i)
        recipe.moments[i] = level_.moments() ? level_.moments()[i * level_.places() + place]
                            : i > 2 && i < 6 ? 1.0f / 12
                                             : 0;
    }
    const float* bend = recipe.rigidity > 0 ? level_.bendAt(place) : nullptr;
    if (bend != nullptr) recipe.thin = 1 + static_cast<uint32_t>(place);
    const auto [known, is_new] = known_.emplace(recipe, static_cast<uint32_t>(out_.matrices.size()));
    if (is_new) out_.matrices.push_back(matrixOf(recipe, springs_, bend));
    element.matrix = known->second;
    out_.elements.push_back(element);
  }

  const FineLevel& level_;
  const Grid& grid_;
  const std::vector<CellSpring> springs_;
  std::vector<uint8_t> cells_;   ///< [kPairs * places] that a spring belongs to
  std::vector<uint8_t> shares_;  ///< [nodes] pieces that a node belongs to
  std::vector<uint32_t> cells_with_tissue_;
  std::map<Recipe, uint32_t> known_;
  Elements out_;
};

}  // namespace

Elements elementsOf(const FineLevel& level) {
  return Cutter(level).run();
}

}  // namespace viscera::multigrid
