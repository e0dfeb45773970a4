// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/prestress.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/number_text.h"
#include "model/scene/structure_rules.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

namespace {

using Eigen::Matrix3d;

// A spring at rest over the distance of its ends. Beyond, the linear balance says little of what springs do.
constexpr double kShortest = 0.3, kLongest = 1.5;
constexpr double kBalanced = 1e-9;   // forces that are left, of the largest tension: float32 rest lengths leave more
constexpr double kRemaining = 1e-6;  // the same: more is no balance
constexpr int kMostSteps = 20000;

Matrix3d strainOf(const PrestressConfig& c) {
  const Matrix3d turn = rotationFromDegrees(c.axes_deg).toRotationMatrix();
  return c.strain * Matrix3d::Identity() + turn * c.strains.asDiagonal() * turn.transpose();
}

/// Calls visit(slot of the owner, pair) for the 24 springs of the cell whose lowest corner is at `lowest`.
template <class Visit>
void forEachSpring(const Lattice& lattice, uint32_t lowest, Visit visit) {
  forEachCorner(lattice, lowest, [&](const Vector3i& a, uint32_t slot) {
    for (int c = 0; c < 8; ++c) {
      const int spring = springIndex(Vector3i(c & 1, (c >> 1) & 1, (c >> 2) & 1) - a);
      if (spring >= 0 && spring % 2 == 0) visit(slot, static_cast<uint32_t>(spring) / 2);
    }
  });
}

/// What a cell gives to one of its springs, of its own k.
double shareOf(uint32_t pair) {
  return isAxial(2 * pair) ? 0.25 : 0.5;
}

/// [9 * slots] which spring of the network is that pair of that node; those of cells are there.
std::vector<uint32_t> springsOfPairs(const SpringNetwork& network) {
  std::vector<uint32_t> out(network.positions_m.size() * kSpringPairs);
  for (uint32_t i = 0; i < network.springs.size(); ++i) {
    const NetworkSpring& spring = network.springs[i];
    if (spring.lattice_spring == layout::kNoLatticeSpring) continue;
    const uint32_t owner = spring.lattice_spring % 2 == 0 ? spring.a : spring.b;
    out[owner * kSpringPairs + spring.lattice_spring / 2] = i;
  }
  return out;
}

/// A cell of a lattice: its springs, what gives them their stress, and its volume.
struct Cell {
  std::array<uint32_t, 8> corners;   // slots, x first
  std::array<uint32_t, 24> springs;  // of the network
  std::array<uint32_t, 24> pairs;
  double spring_n_per_m;  // of a full spring
  double bulk_j;
  Matrix3d strain;  // of springs alone that give the stress asked for
};

/// Of springs, for which lambda = mu, that give `stress`. @param spring_n_per_m  mu h   @param stress  times h [N/m]
Matrix3d strainOfSprings(const Matrix3d& stress, double spring_n_per_m) {
  return (stress - stress.trace() / 5 * Matrix3d::Identity()) / (2 * spring_n_per_m);
}

class CellReader {
 public:
  explicit CellReader(const Body& body)
      : body_(body), elasticities_(elasticityByLabel(body)), springs_(springsOfPairs(*body.network)) {
    strains_.assign(elasticities_.size(), strainOf(body.material.prestress));
    const std::vector<std::string>& names = body.lattice.part_names;
    for (const PartConfig& part : body.parts) {
      const auto at = std::find(names.begin(), names.end(), part.part) - names.begin();
      strains_[static_cast<size_t>(at) + 1] = strainOf(part.prestress);
    }
  }

  std::vector<Cell> cells() {
    const Lattice& lattice = body_.lattice;
    std::vector<Cell> out;
    auto shared = lattice.shared.begin();
    for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
      if (lattice.cell_labels[slot] == 0) continue;
      const auto first = shared;
      while (shared != lattice.shared.end() && shared->cell == slot) ++shared;
      const double full = fillOf(lattice, slot).share;
      Sum sum;
      if (first == shared) {
        add(lattice.cell_labels[slot], full, sum);
      } else {
        double share = 0;
        for (auto part = first; part != shared; ++part) share += part->fill.share;
        for (auto part = first; part != shared; ++part) add(part->label, full / share * part->fill.share, sum);
      }
      out.push_back(cellOf(slot, sum));
    }
    return out;
  }

 private:
  struct Sum {
    double spring_n_per_m = 0, bulk_j = 0;
    Matrix3d stress = Matrix3d::Zero();  // times h [N/m]
  };

  void add(uint16_t label, double share, Sum& sum) const {
    const Elasticity& e = elasticities_[label];
    const double k = share * e.spring_n_per_m, bulk = share * e.bulk_j, h = body_.lattice.spacing_m;
    sum.spring_n_per_m += k;
    sum.bulk_j += bulk;
    const Matrix3d& strain = strains_[label];
    sum.stress += 2 * k * strain + (k + bulk / (h * h)) * strain.trace() * Matrix3d::Identity();
  }

  Cell cellOf(uint32_t slot, const Sum& sum) const {
    Cell cell{{}, {}, {}, sum.spring_n_per_m, sum.bulk_j, strainOfSprings(sum.stress, sum.spring_n_per_m)};
    size_t c = 0, s = 0;
    forEachCorner(body_.lattice, slot, [&](const Vector3i&, uint32_t corner) { cell.corners[c++] = corner; });
    forEachSpring(body_.lattice, slot, [&](uint32_t owner, uint32_t pair) {
      cell.springs[s] = springs_[owner * kSpringPairs + pair];
      cell.pairs[s++] = pair;
    });
    return cell;
  }

  const Body& body_;
  std::vector<Elasticity> elasticities_;
  std::vector<uint32_t> springs_;
  std::vector<Matrix3d> strains_;
};

using Field = std::vector<Vector3d>;

double dot(const Field& a, const Field& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Tensions of a body's springs that pull at no free node in the shape that it has: of those asked for what is left
/// when nodes go where they lead, to first order, and the shape is then called the one at rest.
class Balance {
 public:
  explicit Balance(const Body& body) : body_(body), network_(*body.network) {
    for (const NetworkSpring& spring : network_.springs) {
      const Vector3d way = network_.positions_m[spring.b] - network_.positions_m[spring.a];
      lengths_m_.push_back(way.norm());
      ways_.push_back(way.norm() > 0 ? Vector3d(way / way.norm()) : Vector3d::Zero());
    }
    if (network_.of_lattice) cells_ = CellReader(body).cells();
    ask();
    asked_ = energy();
  }

  void find() {
    const size_t slots = network_.positions_m.size();
    Field at(slots, Vector3d::Zero()), left = pullsOf(tensions_n_), product(slots);
    const std::vector<double> inverse = inverseDiagonal();
    Field scaled = scaledBy(inverse, left), way = scaled;
    double gain = dot(left, scaled);
    for (; steps_ < kMostSteps && worst(left) > kBalanced * largest(); ++steps_) {
      multiply(way, product);
      const double step = gain / dot(way, product);
      for (size_t i = 0; i < slots; ++i) {
        at[i] += step * way[i];
        left[i] -= step * product[i];
      }
      scaled = scaledBy(inverse, left);
      const double next = dot(left, scaled);
      for (size_t i = 0; i < slots; ++i) way[i] = scaled[i] + next / gain * way[i];
      gain = next;
    }
    take(at);
    remaining_ = worst(pullsOf(tensions_n_)) / largest();
  }

  double restLength_m(size_t i) const {
    const double k = network_.springs[i].stiffness_n_per_m;
    return k > 0 ? lengths_m_[i] - tensions_n_[i] / k : lengths_m_[i];
  }
  double length_m(size_t i) const { return lengths_m_[i]; }
  /// Of the strains asked for what is kept: root of the energy.
  double kept() const { return asked_ > 0 ? std::sqrt(energy() / asked_) : 0; }
  double remaining() const { return remaining_; }
  int steps() const { return steps_; }

 private:
  bool isHeld(uint32_t slot) const { return isFixed(body_.lattice.nodes[slot]); }

  void ask() {
    tensions_n_.assign(network_.springs.size(), 0);
    if (!network_.of_lattice) {
      const Matrix3d strain = strainOf(body_.material.prestress);
      for (size_t i = 0; i < tensions_n_.size(); ++i) {
        const NetworkSpring& spring = network_.springs[i];
        if (!spring.against_bending)
          tensions_n_[i] = spring.stiffness_n_per_m * lengths_m_[i] * ways_[i].dot(strain * ways_[i]);
      }
    } else {
      std::vector<double> given(tensions_n_.size());  // k of the cells around
      for (const Cell& cell : cells_) {
        for (size_t s = 0; s < cell.springs.size(); ++s) {
          const uint32_t i = cell.springs[s];
          const double k = shareOf(cell.pairs[s]) * cell.spring_n_per_m;
          given[i] += k;
          tensions_n_[i] += k * lengths_m_[i] * ways_[i].dot(cell.strain * ways_[i]);
        }
      }
      // As floats, or at full count with material.weights: paper.
      for (size_t i = 0; i < given.size(); ++i)
        if (given[i] > 0) tensions_n_[i] *= network_.springs[i].stiffness_n_per_m / given[i];
    }
    for (const double tension : tensions_n_) largest_n_ = std::max(largest_n_, std::abs(tension));
  }

  double largest() const { return largest_n_; }

  double energy() const {
    double sum = 0;
    for (size_t i = 0; i < tensions_n_.size(); ++i) {
      const double k = network_.springs[i].stiffness_n_per_m;
      if (k > 0) sum += tensions_n_[i] * tensions_n_[i] / k;
    }
    return sum;
  }

  /// What tensions do to nodes that are free [N].
  Field pullsOf(const std::vector<double>& tensions_n) const {
    Field out(network_.positions_m.size(), Vector3d::Zero());
    for (size_t i = 0; i < tensions_n.size(); ++i) {
      out[network_.springs[i].a] += tensions_n[i] * ways_[i];
      out[network_.springs[i].b] -= tensions_n[i] * ways_[i];
    }
    free(out);
    return out;
  }

  void free(Field& forces) const {
    for (uint32_t slot = 0; slot < forces.size(); ++slot)
      if (isHeld(slot)) forces[slot].setZero();
  }

  /// Strain of a cell's volume. @param c  corner, x first
  double slope(size_t c, int axis) const { return (c >> axis & 1 ? 0.25 : -0.25) / body_.lattice.spacing_m; }
  double dilation(const Cell& cell, const Field& at) const {
    double sum = 0;
    for (size_t c = 0; c < 8; ++c)
      for (int axis = 0; axis < 3; ++axis) sum += slope(c, axis) * at[cell.corners[c]][axis];
    return sum;
  }

  /// Stiffness of springs and volumes in the shape given, without tensions.
  void multiply(const Field& at, Field& out) const {
    std::fill(out.begin(), out.end(), Vector3d::Zero());
    for (size_t i = 0; i < ways_.size(); ++i) {
      const NetworkSpring& spring = network_.springs[i];
      if (spring.against_bending) continue;
      const Vector3d pull = spring.stiffness_n_per_m * ways_[i].dot(at[spring.b] - at[spring.a]) * ways_[i];
      out[spring.a] -= pull;
      out[spring.b] += pull;
    }
    for (const Cell& cell : cells_) {
      if (cell.bulk_j == 0) continue;
      const double pressure = cell.bulk_j * dilation(cell, at);
      for (size_t c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis) out[cell.corners[c]][axis] += pressure * slope(c, axis);
    }
    free(out);
  }

  std::vector<double> inverseDiagonal() const {
    std::vector<double> sums(network_.positions_m.size());
    for (const NetworkSpring& spring : network_.springs) {
      if (spring.against_bending) continue;
      sums[spring.a] += spring.stiffness_n_per_m;
      sums[spring.b] += spring.stiffness_n_per_m;
    }
    for (double& sum : sums) sum = sum > 0 ? 1 / sum : 0;
    return sums;
  }

  static Field scaledBy(const std::vector<double>& scale, const Field& field) {
    Field out = field;
    for (size_t i = 0; i < out.size(); ++i) out[i] *= scale[i];
    return out;
  }

  static double worst(const Field& forces) {
    double out = 0;
    for (const Vector3d& force : forces) out = std::max(out, force.norm());
    return out;
  }

  /// The stress of a cell's volume is one that its springs can have too, and pulls at the corners in the same way.
  void take(const Field& at) {
    const double h = body_.lattice.spacing_m;
    for (size_t i = 0; i < tensions_n_.size(); ++i) {
      const NetworkSpring& spring = network_.springs[i];
      if (!spring.against_bending)
        tensions_n_[i] += spring.stiffness_n_per_m * ways_[i].dot(at[spring.b] - at[spring.a]);
    }
    for (const Cell& cell : cells_) {
      if (cell.bulk_j == 0) continue;
      const double stress = cell.bulk_j / (h * h) * dilation(cell, at) / 5;
      for (size_t s = 0; s < cell.springs.size(); ++s)
        tensions_n_[cell.springs[s]] += shareOf(cell.pairs[s]) * lengths_m_[cell.springs[s]] * stress;
    }
  }

  const Body& body_;
  const SpringNetwork& network_;
  std::vector<double> lengths_m_, tensions_n_;
  Field ways_;
  std::vector<Cell> cells_;
  double asked_ = 0, largest_n_ = 0, remaining_ = 0;
  int steps_ = 0;
};

}  // namespace

void addPrestress(Body& body) {
  if (!isPrestressed(body.material, body.parts)) return;
  Balance balance(body);
  balance.find();
  const std::string name = "body '" + body.name + "': material.prestress ";
  if (!(balance.remaining() <= kRemaining)) {
    TextOut text;
    text << name << "finds no balance in the given shape: " << balance.remaining()
         << " of the largest tension is left after " << balance.steps() << " steps";
    throw SceneError(text.str());
  }
  std::vector<NetworkSpring>& springs = body.network->springs;
  for (size_t i = 0; i < springs.size(); ++i) {
    if (springs[i].against_bending) continue;
    const double share = balance.restLength_m(i) / balance.length_m(i);
    if (!(share >= kShortest && share <= kLongest)) {
      TextOut text;
      text << name << "would leave a spring " << share << " of its length at rest, where " << kShortest << " to "
           << kLongest << " is accepted: make it smaller";
      throw SceneError(text.str());
    }
    springs[i].rest_length_m = balance.restLength_m(i);
  }
  TextOut note;
  note << "prestress: " << std::lround(100 * balance.kept())
       << " % of the strain asked for balances in the given shape; forces left: " << balance.remaining()
       << " of the largest tension, after " << balance.steps() << " steps";
  body.notes.push_back(note.str());
}

std::vector<Eigen::Matrix3d> cellPrestresses(const Body& body) {
  if (!body.network || !body.network->of_lattice || !isPrestressed(body.material, body.parts)) return {};
  const Lattice& lattice = body.lattice;
  const std::vector<uint32_t> of_pair = springsOfPairs(*body.network);
  std::vector<Matrix3d> out(lattice.nodes.size(), Matrix3d::Zero());
  for (uint32_t slot = 0; slot < out.size(); ++slot) {
    if (lattice.cell_labels[slot] == 0) continue;
    forEachSpring(lattice, slot, [&](uint32_t owner, uint32_t pair) {
      const NetworkSpring& spring = body.network->springs[of_pair[owner * kSpringPairs + pair]];
      const Vector3d way =
          (body.network->positions_m[spring.b] - body.network->positions_m[spring.a]) / lattice.spacing_m;
      const double strain = 1 - spring.rest_length_m / (way.norm() * lattice.spacing_m);
      out[slot] += shareOf(pair) * strain * way * way.transpose();
    });
  }
  return out;
}

}  // namespace viscera
