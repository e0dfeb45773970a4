// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/attach/fibres.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "math/number_text.h"
#include "model/shape/mesh/triangle_tree.h"
#include "solver/processes/attach/surface_samples.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr double kPerSpacing = 2;     // fibres along an edge of a cell of the finer body
constexpr double kStiffest = 10;      // stiffness over Young's modulus per spacing: costs 1 % of compliance
constexpr double kMostReach = 2;      // finer spacings: an end is at most one spacing outside its cell
constexpr double kAhead = 0.7;        // cosine: largest angle between a surface's normal and the other surface
constexpr double kNearBorder = 1e-4;  // of a spacing: a fibre this near to a cell's border is moved onto it
constexpr double kOnBorder = 1e-6;    // of a spacing: a position this near to a cell's border is on it
constexpr double kInside = 1e-3;      // of a spacing: distance of a seat from the border of its cell
/// Stiffness of fibres on a node over its mass, in the squared frequency of safeTimeStep(), which is 2.6 times that of
/// the fastest mode of a block at nu = 0.45.
constexpr double kBudget = 1;

uint32_t indexOf(const Model& model, const std::string& name) {
  const auto found =
      std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return body.name == name; });
  return static_cast<uint32_t>(found - model.bodies.begin());
}

double softest_pa(const Body& body) {
  double out = body.material.young_modulus_pa;
  for (const PartConfig& part : body.parts) out = std::min(out, part.young_modulus_pa);
  return out;
}

/// Finds where the fibres of one attachment grow.
class Facing {
 public:
  Facing(const Model& model, const FibreCells& cells, uint32_t fine, uint32_t coarse, double reach_m)
      : cells_(cells),
        fine_(fine),
        coarse_(coarse),
        reach_m_(reach_m),
        spacing_m_(model.bodies[fine].lattice.spacing_m),
        origin_m_(model.bodies[fine].lattice.origin_m),
        surface_(model.bodies[fine].skin.mesh),
        other_(model.bodies[coarse].skin.mesh),
        tree_(other_) {}

  std::vector<Fibre> fibres() const {
    const auto wanted = [&](const Vector3d& middle, double radius_m) {
      return tree_.nearest(middle.cast<float>(), static_cast<float>(reach_m_ + radius_m)).found();
    };
    std::vector<Fibre> out;
    for (const SurfaceSample& sample : samplesOf(surface_, spacing_m_ / kPerSpacing, origin_m_, wanted)) {
      if (const std::optional<Fibre> fibre = at(sample)) out.push_back(*fibre);
    }
    return out;
  }

  double nearest_m() const {
    double out = std::numeric_limits<double>::infinity();
    for (const Vector3f& vertex : surface_.positions_m)
      out = std::min(out, static_cast<double>(tree_.nearest(vertex, static_cast<float>(out)).distance_m));
    return out;
  }

 private:
  std::optional<Fibre> at(const SurfaceSample& sample) const {
    const MeshPoint found = tree_.nearest(sample.at_m.cast<float>(), static_cast<float>(reach_m_));
    if (!found.found()) return std::nullopt;
    std::array<Vector3d, 3> corners;
    Vector3d there = Vector3d::Zero();
    for (size_t c = 0; c < 3; ++c) {
      corners[c] = other_.positions_m[other_.triangles[found.triangle][c]].cast<double>();
      there += static_cast<double>(found.weights[static_cast<Eigen::Index>(c)]) * corners[c];
    }
    const Vector3d facing = (corners[1] - corners[0]).cross(corners[2] - corners[0]), gap = there - sample.at_m;
    const bool close = gap.norm() < kNearBorder * spacing_m_;
    if (facing.dot(sample.normal) >= 0 || (!close && std::abs(gap.dot(sample.normal)) < kAhead * gap.norm()))
      return std::nullopt;
    Fibre out;
    out.rest_m = sample.at_m + 0.5 * gap;
    out.normal = sample.normal;
    out.area_m2 = sample.area_m2;
    const std::array<std::pair<uint32_t, Vector3d>, 2> sides = {{{fine_, sample.at_m}, {coarse_, there}}};
    for (size_t s = 0; s < 2; ++s) {
      const std::optional<Vector3d> seat = cells_.seatNear(sides[s].first, sides[s].second);
      if (!seat) return std::nullopt;
      out.seats_m[s] = *seat;
      out.rest_m = cells_.onBorder(sides[s].first, *seat, out.rest_m);
    }
    for (size_t s = 0; s < 2; ++s) {
      const std::optional<TissuePoint> end = cells_.carry(sides[s].first, out.seats_m[s], out.rest_m, {});
      if (!end) return std::nullopt;
      out.ends[s] = *end;
    }
    return out;
  }

  const FibreCells& cells_;
  uint32_t fine_, coarse_;
  double reach_m_, spacing_m_;
  Vector3d origin_m_;
  const TriangleMesh &surface_, &other_;
  TriangleTree tree_;
};

/// Sum over fibres of stiffness on each node: [slots] N/m.
class NodeStiffness {
 public:
  NodeStiffness(const Model& model, const std::vector<Fibre>& fibres) : n_per_m_(model.slots(), 0) {
    for (const Fibre& fibre : fibres) {
      double all = 0;
      forEach(fibre, [&](uint32_t, double weight) { all += weight; });
      forEach(fibre, [&](uint32_t slot, double weight) {
        n_per_m_[slot] += fibre.law.stiffness_n_per_m3 * fibre.area_m2 * weight * all;
      });
    }
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      if (!body.hasCells()) continue;
      const std::vector<float> mass_kg = strengths(body).mass_kg;
      for (const uint32_t slot : body.lattice.active_slots) {
        double& rate = n_per_m_[model.slotOffset(b) + slot];
        const double kg = static_cast<double>(mass_kg[slot]);
        rate = isFixed(body.lattice.nodes[slot]) || !(kg > 0) ? 0 : rate / kg;
      }
    }
  }
  double rate_per_s2(uint32_t slot) const { return n_per_m_[slot]; }

  /// Calls visit(slot, |weight|) for the nodes of a fibre.
  template <class Visit>
  static void forEach(const Fibre& fibre, const Visit& visit) {
    for (const TissuePoint& end : fibre.ends) {
      for (uint32_t c = 0; c < end.count; ++c) {
        if (end.weights[c] != 0) visit(end.slots[c], std::abs(static_cast<double>(end.weights[c])));
      }
    }
  }

 private:
  std::vector<double> n_per_m_;  ///< [slots], then over mass
};

/// Softens fibres on light nodes, which would shorten the substep.
void keepBudget(const Model& model, std::vector<Fibre>& fibres) {
  const double safe_s = safeTimeStep(model);
  if (!std::isfinite(safe_s)) return;
  const double most_per_s2 = kBudget * 4 / (safe_s * safe_s);
  const NodeStiffness on(model, fibres);
  for (Fibre& fibre : fibres) {
    double share = 1;
    NodeStiffness::forEach(fibre, [&](uint32_t slot, double) {
      if (on.rate_per_s2(slot) > most_per_s2) share = std::min(share, most_per_s2 / on.rate_per_s2(slot));
    });
    fibre.law.stiffness_n_per_m3 *= share;
  }
}

}  // namespace

FibreCells::FibreCells(const Model& model) : model_(model) {
  uint32_t first_spring = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    elements_.emplace_back(model, b, first_spring);
    const std::optional<SpringNetwork>& network = model.bodies[b].network;
    if (network) first_spring += static_cast<uint32_t>(network->springs.size());
  }
}

/// Returns a position in a cell's own coordinates, 0 to 1 within it.
Vector3d FibreCells::inCell(const TissuePoint& point, const Vector3d& at_m) const {
  const Body& body = model_.bodies[point.body];
  const Vector3d low_m = restPosition(body, point.slots[0] - model_.slotOffset(point.body));
  return (at_m - low_m) / body.lattice.spacing_m;
}

std::optional<TissuePoint> FibreCells::carry(uint32_t body, const Vector3d& seat_m, const Vector3d& rest_m,
                                             const CutSprings& cuts) const {
  std::optional<TissuePoint> out = elements_[body].embed(seat_m, cuts);
  if (!out || out->count != TissuePoint::kMost) return std::nullopt;
  if (std::count(out->weights.begin(), out->weights.end(), 0) == TissuePoint::kMost - 1) return std::nullopt;
  Vector3d t = inCell(*out, rest_m);
  for (double& x : t) {
    if (std::abs(x - std::round(x)) < kOnBorder) x = std::round(x);
  }
  for (uint32_t c = 0; c < out->count; ++c) {
    double weight = 1;
    for (uint32_t a = 0; a < 3; ++a) weight *= (c >> a & 1) ? t[a] : 1 - t[a];
    out->weights[c] = static_cast<float>(weight);
  }
  out->rest_m = rest_m;
  return out;
}

std::optional<Vector3d> FibreCells::seatNear(uint32_t body, const Vector3d& at_m) const {
  const std::optional<TissuePoint> found = elements_[body].nearest(at_m, {});
  if (!found || found->count != TissuePoint::kMost) return std::nullopt;
  const Vector3d t = inCell(*found, at_m).cwiseMax(kInside).cwiseMin(1 - kInside);
  return restPosition(model_.bodies[body], found->slots[0] - model_.slotOffset(body)) +
         model_.bodies[body].lattice.spacing_m * t;
}

Vector3d FibreCells::onBorder(uint32_t body, const Vector3d& seat_m, const Vector3d& at_m) const {
  const std::optional<TissuePoint> around = elements_[body].embed(seat_m, {});
  if (!around) return at_m;
  const Vector3d t = inCell(*around, at_m);
  Vector3d out = at_m;
  for (int a = 0; a < 3; ++a) {
    const double off = std::round(t[a]) - t[a];
    if (std::abs(off) < kNearBorder) out[a] += off * model_.bodies[body].lattice.spacing_m;
  }
  return out;
}

Eigen::Matrix<double, 8, 3> FibreCells::slopes(const TissuePoint& point) const {
  const Vector3d t = inCell(point, point.rest_m);
  Eigen::Matrix<double, 8, 3> out;
  for (uint32_t c = 0; c < 8; ++c) {
    for (uint32_t by = 0; by < 3; ++by) {
      double slope = 1 / model_.bodies[point.body].lattice.spacing_m;
      for (uint32_t a = 0; a < 3; ++a) {
        const bool high = c >> a & 1;
        slope *= a == by ? (high ? 1 : -1) : (high ? t[a] : 1 - t[a]);
      }
      out(c, by) = slope;
    }
  }
  return out;
}

std::vector<Fibre> growFibres(const Scene& scene, const Model& model, const FibreCells& cells) {
  std::vector<Fibre> out;
  for (uint32_t i = 0; i < scene.attachments.size(); ++i) {
    const AttachmentConfig& config = scene.attachments[i];
    const std::string where = "attachments[" + std::to_string(i) + "]: ";
    uint32_t fine = indexOf(model, config.body_a), coarse = indexOf(model, config.body_b);
    const auto spacing_m = [&](uint32_t body) { return model.bodies[body].lattice.spacing_m; };
    if (spacing_m(fine) > spacing_m(coarse)) std::swap(fine, coarse);
    if (config.reach_m > kMostReach * spacing_m(fine))
      throw SceneError(where + "reach_m is " + numberText(config.reach_m) + " m; with a spacing of " +
                       numberText(spacing_m(fine)) + " m of body '" + model.bodies[fine].name + "' at most " +
                       numberText(kMostReach * spacing_m(fine)) + " m is accepted");
    const Facing facing(model, cells, fine, coarse, config.reach_m);
    const double softest = std::min(softest_pa(model.bodies[fine]), softest_pa(model.bodies[coarse]));
    const double stiffness = std::min(config.modulus_pa / config.thickness_m, kStiffest * softest / spacing_m(fine));
    const size_t before = out.size();
    for (Fibre& fibre : facing.fibres()) {
      fibre.attachment = i;
      fibre.law.stiffness_n_per_m3 = stiffness;
      out.push_back(std::move(fibre));
    }
    if (out.size() == before)
      throw SceneError(where + "no surfaces of bodies '" + config.body_a + "' and '" + config.body_b +
                       "' face each other within reach_m = " + numberText(config.reach_m) +
                       " m at rest; the nearest point is " + numberText(facing.nearest_m(), 3) + " m away");
  }
  // Fibres between the same two cells follow each other: FibreForces handles them together.
  std::stable_sort(out.begin(), out.end(), [](const Fibre& a, const Fibre& b) {
    return std::make_tuple(a.attachment, a.ends[0].slots[0], a.ends[1].slots[0]) <
           std::make_tuple(b.attachment, b.ends[0].slots[0], b.ends[1].slots[0]);
  });
  keepBudget(model, out);
  for (Fibre& fibre : out) {
    const AttachmentConfig& config = scene.attachments[fibre.attachment];
    fibre.law = CohesiveLaw::of(fibre.law.stiffness_n_per_m3, config.strength_pa, config.toughness_j_per_m2);
  }
  return out;
}

double attachmentRate(const Scene& scene, const Model& model) {
  if (scene.attachments.empty()) return 0;
  const std::vector<Fibre> fibres = growFibres(scene, model, FibreCells(model));
  const NodeStiffness on(model, fibres);
  double out = 0;
  for (const Fibre& fibre : fibres)
    NodeStiffness::forEach(fibre, [&](uint32_t slot, double) { out = std::max(out, on.rate_per_s2(slot)); });
  return out;
}

}  // namespace viscera
