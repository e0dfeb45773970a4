// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/cell_laminates.h"

#include "model/body/mixed_cells.h"

namespace viscera {

namespace {

/// Distance between the centroids of two layers, in cells, below which their plane has no direction. Layers that meet
/// in a plane are half a cell apart, except for slivers.
constexpr double kLeastDistance = 0.02;

/// One material of a cell: its amount and position.
struct Layer {
  const Elasticity* material;
  uint16_t label;
  double share = 0;
  Vector3d first = Vector3d::Zero();

  double bulkOverMu() const { return 5.0 / 3 + material->bulk_j / material->rigidity_j; }  // K = lambda + 2/3 mu
};

}  // namespace

CellLaminates cellLaminates(const Body& body) {
  CellLaminates out;
  if (body.material.law != Law::kNeoHookean || body.lattice.shared.empty() || body.parts.empty()) return out;
  const std::vector<Elasticity> by_label = elasticityByLabel(body);
  forEachMixedCell(body.lattice, by_label, [&](size_t first, size_t last) {
    std::vector<Layer> layers;
    for (size_t i = first; i < last; ++i) {
      const PartFill& part = body.lattice.shared[i];
      const Elasticity& material = by_label[part.label];
      size_t at = 0;
      while (at < layers.size() && !isSame(*layers[at].material, material)) ++at;
      if (at == layers.size()) layers.push_back({&material, part.label});
      layers[at].share += part.fill.share;
      layers[at].first += part.fill.first;
    }
    const Vector3d offset = layers.size() == 2 ? layers[1].first / layers[1].share - layers[0].first / layers[0].share
                                               : Vector3d(Vector3d::Zero());
    if (!(offset.norm() >= kLeastDistance)) {
      ++out.others;
      return;
    }
    const double share_a = layers[0].share / (layers[0].share + layers[1].share);
    const double mu_a = layers[0].material->rigidity_j, mu_b = layers[1].material->rigidity_j;
    out.cells.push_back({static_cast<uint32_t>(body.lattice.shared[first].cell), offset.normalized(), share_a,
                         mu_a / (share_a * mu_a + (1 - share_a) * mu_b), layers[0].bulkOverMu(), layers[1].bulkOverMu(),
                         layers[0].label});
  });
  return out;
}

}  // namespace viscera
