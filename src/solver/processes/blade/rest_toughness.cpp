// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/rest_toughness.h"

#include <algorithm>

#include "model/shape/mesh/triangle_tree.h"

namespace viscera {

namespace {

/// Calls visit in the order of RestGrid::at().
template <class Visit>
void forEachLayer(const RestGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.count.z(); ++z) {
    for (int y = 0; y < grid.count.y(); ++y) {
      for (int x = 0; x < grid.count.x(); ++x) visit(Vector3i(x, y, z));
    }
  }
}

}  // namespace

RestToughness::RestToughness(const Body& body, const RestGrid& nodes)
    : cells_(nodes), by_layer_(toughnesses(body)), spacing_m_(toughnessOf(body).spacing_m) {
  const double radius_m = kernelOf(by_layer_);
  for (const std::vector<Toughness>& of_label : by_layer_) {
    carried_.emplace_back();
    for (const Toughness& t : of_label)
      carried_.back().push_back({t.carried_j_per_m2(), t.carriedAtSurface_j_per_m2(radius_m)});
  }
  if (!body.parts.empty()) findLabels(body.lattice);
  bool any = false;
  for (const LayerConfig& layer : body.layers) {
    layers_m_.push_back(layer.depth_m);
    any |= layer.toughness_j_per_m2 > 0;
  }
  if (any) findDepths(body.skin);
}

/// Finds the labels of cells. Cells without tissue get the label of a neighbour: an edge that leaves the tissue still
/// has some tissue in them.
void RestToughness::findLabels(const Lattice& lattice) {
  labels_.assign(cells_.positions(), 0);
  for (const uint32_t slot : lattice.active_slots) labels_[cells_.at(lattice.nodeAt(slot))] = lattice.cell_labels[slot];
  for (const Vector3i& along : {Vector3i(1, 0, 0), Vector3i(0, 1, 0), Vector3i(0, 0, 1)}) {
    const std::vector<uint16_t> before = labels_;
    forEachLayer(cells_, [&](const Vector3i& cell) {
      uint16_t& label = labels_[cells_.at(cell)];
      for (const Vector3i& beside : {Vector3i(cell - along), Vector3i(cell + along)}) {
        if (label == 0 && cells_.has(beside)) label = before[cells_.at(beside)];
      }
    });
  }
}

void RestToughness::findDepths(const Skin& skin) {
  const TriangleTree tree(skin.mesh);
  depths_m_.reserve(cells_.positions());
  forEachLayer(cells_, [&](const Vector3i& position) {
    const Vector3f node = (cells_.origin_m + cells_.spacing_m * position.cast<double>()).cast<float>();
    const MeshPoint nearest = tree.nearest(node);
    const auto& c = skin.mesh.triangles[nearest.triangle];
    const Vector3f a = skin.mesh.positions_m[c[0]];
    const Vector3f front = (skin.mesh.positions_m[c[1]] - a).cross(skin.mesh.positions_m[c[2]] - a);
    depths_m_.push_back(front.dot(node - a) > 0 ? -nearest.distance_m : nearest.distance_m);
  });
}

double RestToughness::carriedFriction_n_per_m(double friction_n_per_m) const {
  for (const std::vector<Toughness>& of_label : by_layer_) {
    for (Toughness toughness : of_label) {
      toughness.asked_j_per_m2 = friction_n_per_m;
      friction_n_per_m = toughness.carried_j_per_m2();
    }
  }
  return friction_n_per_m;
}

double RestToughness::depthAt(const Vector3d& at_m) const {
  const Vector3d most = cells_.count.cast<double>() - Vector3d::Constant(1);
  const Vector3d at = ((at_m - cells_.origin_m) / cells_.spacing_m).cwiseMax(0).cwiseMin(most);
  const Vector3i cell = at.cast<int>().cwiseMin(cells_.count - Vector3i::Constant(2));
  const Vector3d within = at - cell.cast<double>();
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, c >> 1 & 1, c >> 2 & 1);
    double weight = depths_m_[cells_.at(cell + corner)];
    for (int a = 0; a < 3; ++a) weight *= corner[a] ? within[a] : 1 - within[a];
    sum += weight;
  }
  return sum;
}

RestToughness::Layer RestToughness::layerOf(const Vector3d& at_m) const {
  size_t label = 0, layer = layers_m_.size();
  if (!labels_.empty()) {
    const Vector3i cell = ((at_m - cells_.origin_m) / cells_.spacing_m).array().floor().cast<int>();
    label = labels_[cells_.at(cell.cwiseMax(0).cwiseMin(cells_.count - Vector3i::Ones()))];
  }
  if (!depths_m_.empty()) {
    const double depth_m = depthAt(at_m);
    layer = static_cast<size_t>(
        std::find_if(layers_m_.begin(), layers_m_.end(), [depth_m](double ends_m) { return depth_m < ends_m; }) -
        layers_m_.begin());
  }
  return {label, layer};
}

const RestToughness::Carried& RestToughness::at(const Vector3d& at_m) const {
  const Layer position = layerOf(at_m);
  return carried_[position.label][position.layer];
}

double RestToughness::ofPoint_n(const Vector3d& at_m, double width_m, double kernel_m) const {
  const Layer position = layerOf(at_m);
  return by_layer_[position.label][position.layer].ofPoint_n(width_m, kernel_m);
}

double RestToughness::pointKernel_m(double width_m) const {
  double most_m = 0;
  for (const std::vector<Toughness>& of_label : by_layer_) {
    for (const Toughness& toughness : of_label) most_m = std::max(most_m, toughness.pointKernel_m(width_m));
  }
  return most_m;
}

}  // namespace viscera
