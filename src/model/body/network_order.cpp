// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_order.h"

#include <algorithm>

namespace viscera {
namespace {

constexpr int kBitsPerAxis = 20;

/// Returns the interleaved bits of the three coordinates.
uint64_t mortonKey(const Vector3d& fraction) {
  uint64_t key = 0;
  for (int bit = kBitsPerAxis - 1; bit >= 0; --bit) {
    for (int axis = 2; axis >= 0; --axis) {
      const auto whole = static_cast<uint64_t>(fraction[axis] * ((1 << kBitsPerAxis) - 1));
      key = key << 1 | (whole >> bit & 1);
    }
  }
  return key;
}

}  // namespace

std::vector<uint32_t> mortonOrder(const SpringNetwork& network) {
  struct Keyed {
    uint64_t key;
    uint32_t node;
  };
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < network.positions_m.size(); ++i) {
    if (network.masses_kg[i] > 0) box.extend(network.positions_m[i]);
  }
  std::vector<Keyed> keyed;
  const double size_m = box.isEmpty() ? 0 : box.sizes().maxCoeff();  // one scale, so that the curve's cells are cubes
  for (uint32_t i = 0; i < network.positions_m.size(); ++i) {
    if (!(network.masses_kg[i] > 0)) continue;
    const Vector3d fraction = size_m > 0 ? Vector3d((network.positions_m[i] - box.min()) / size_m) : Vector3d::Zero();
    keyed.push_back({mortonKey(fraction), i});
  }
  std::stable_sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  std::vector<uint32_t> order;
  for (const Keyed& k : keyed) order.push_back(k.node);
  return order;
}

}  // namespace viscera
