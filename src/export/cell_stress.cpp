// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/cell_stress.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "layout/law.h"
#include "math/decompositions.h"
#include "solver/tissue/law_laminate.h"

namespace viscera {

namespace {

using Eigen::Matrix3d;

/// Deformation modes of a cell over h (docs/physics.md 1): its mean edges, and its hourglass modes by the axis that
/// they leave out.
struct Motion {
  Matrix3d edges = Matrix3d::Identity(), hourglass = Matrix3d::Zero();
};
Motion motionOf(const std::array<Vector3d, 8>& u_m, double spacing_m) {
  Motion out;
  for (size_t c = 0; c < 8; ++c) {
    const Vector3d s(c & 1 ? 1 : -1, c >> 1 & 1 ? 1 : -1, c >> 2 & 1 ? 1 : -1);
    out.edges += u_m[c] * s.transpose() / (4 * spacing_m);
    out.hourglass += u_m[c] * Vector3d(s.y() * s.z(), s.z() * s.x(), s.x() * s.y()).transpose() / (2 * spacing_m);
  }
  return out;
}

Matrix3d cofactors(const Matrix3d& f) {
  Matrix3d out;
  for (int a = 0; a < 3; ++a) out.col(a) = f.col((a + 1) % 3).cross(f.col((a + 2) % 3));
  return out;
}
double volumeOf(const Matrix3d& f) {
  return f.col(0).dot(f.col(1).cross(f.col(2)));
}

/// Returns F* = F (1 + G) at the centroid of the tissue.
Matrix3d gradientAt(const Motion& motion, const Vector3d& centroid, double poisson) {
  const double j = volumeOf(motion.edges);
  if (j <= static_cast<double>(layout::kLeastVolume)) return motion.edges;
  const Matrix3d s = cofactors(motion.edges).transpose() * motion.hourglass / j;
  Matrix3d g;
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    g.col(n) = centroid[a] * s.col(b) + centroid[b] * s.col(a);
    g(n, n) -= poisson * centroid[n] * (s(a, b) + s(b, a));
    g(a, n) -= centroid[n] * s(n, b);
    g(b, n) -= centroid[n] * s(n, a);
  }
  return motion.edges * (Matrix3d::Identity() + g);
}

CellStress stressOf(const Matrix3d& cauchy, double energy_j_per_m3) {
  const Matrix3d shear = cauchy - cauchy.trace() / 3 * Matrix3d::Identity();
  return {energy_j_per_m3, std::sqrt(1.5) * shear.norm(), principalValues(cauchy).reverse(), cauchy};
}

/// Returns sigma = mu exp(b x) J^(-5/3) (B - tr B / 3) + K/2 (J - 1/J) + F S F^T / J, B = F F^T, x = J^(-2/3) tr B - 3.
/// @param stiffening  b   @param prestress  S over mu
CellStress neoHookean(const Matrix3d& f, double lambda, double mu, double stiffening, const Matrix3d& prestress) {
  const double j = std::max(volumeOf(f), static_cast<double>(layout::kLeastVolume)), bulk = lambda + 2.0 / 3 * mu;
  const Matrix3d b = f * f.transpose(), even = Matrix3d::Identity();
  const double x = std::pow(j, -2.0 / 3) * b.trace() - 3, most = static_cast<double>(layout::kMostExponent);
  const double y = stiffening * x, least = std::min(y, most), stiffer = std::exp(least);
  const double shear = stiffening == 0 ? x : (std::expm1(least) + stiffer * (y - least)) / stiffening;
  const Matrix3d cauchy = mu * stiffer * std::pow(j, -5.0 / 3) * (b - b.trace() / 3 * even) +
                          bulk / 2 * (j - 1 / j) * even + mu / j * f * prestress * f.transpose();
  const double of_prestress = mu / 2 * prestress.cwiseProduct(f.transpose() * f - even).sum();
  return stressOf(cauchy, mu / 2 * shear + bulk / 4 * (j * j - 1 - 2 * std::log(j)) + of_prestress);
}

CellStress saintVenant(const Matrix3d& f, double lambda, double mu) {
  const Matrix3d strain = 0.5 * (f.transpose() * f - Matrix3d::Identity());
  const Matrix3d second = lambda * strain.trace() * Matrix3d::Identity() + 2 * mu * strain;
  return stressOf(f * second * f.transpose() / volumeOf(f), 0.5 * second.cwiseProduct(strain).sum());
}

}  // namespace

CellStresses::CellStresses(const Body& body) : body_(body) {
  const auto lameOf = [](double young_pa, double nu) {
    return Lame{young_pa * nu / ((1 + nu) * (1 - 2 * nu)), young_pa / (2 * (1 + nu))};
  };
  lames_.assign(body.lattice.part_names.size() + 1,
                lameOf(body.material.young_modulus_pa, body.material.poisson_ratio));
  for (const PartConfig& part : body.parts) {
    for (size_t p = 0; p < body.lattice.part_names.size(); ++p) {
      if (body.lattice.part_names[p] == part.part) lames_[p + 1] = lameOf(part.young_modulus_pa, part.poisson_ratio);
    }
  }
  if (body.material.law != Law::kNeoHookean) return;
  moments_ = cellMoments(body);
  laminates_ = cellLaminates(body).cells;
}

CellStress CellStresses::at(uint32_t cell, const std::array<Vector3d, 8>& u_m) const {
  const Lattice& lattice = body_.lattice;
  const size_t label = lattice.cell_labels.empty() ? 0 : lattice.cell_labels[cell];
  const Lame& lame = lames_[std::min(label, lames_.size() - 1)];
  const Motion motion = motionOf(u_m, lattice.spacing_m);
  if (body_.material.law != Law::kNeoHookean) return saintVenant(motion.edges, lame.lambda, lame.mu);
  const uint32_t which = moments_.of_cell.empty() ? 0 : moments_.of_cell[cell];
  const Vector3d centroid = which == 0 ? Vector3d(Vector3d::Zero())
                                       : Vector3d(moments_.fills[which - 1].first / moments_.fills[which - 1].share);
  Matrix3d prestress = Matrix3d::Zero();
  if (!body_.prestress.empty()) {
    const std::array<float, 6>& s = body_.prestress[cell];
    prestress << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  }
  Matrix3d f = gradientAt(motion, centroid, lame.lambda / (lame.lambda + 2 * lame.mu));
  const auto found = std::lower_bound(laminates_.begin(), laminates_.end(), cell,
                                      [](const CellLaminate& laminate, uint32_t of) { return laminate.cell < of; });
  if (found != laminates_.end() && found->cell == cell) {
    const LawLaminate laminate = lawLaminateOf(*found);
    const LawLayer& layer = laminate.layers[found->label_a == label ? 0 : 1];
    f += layer.jump * laminateJump(laminate, f, body_.material.stiffening) * laminate.normal.transpose();
  }
  return neoHookean(f, lame.lambda, lame.mu, body_.material.stiffening, prestress);
}

}  // namespace viscera
