// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/cut_record.h"

#include <algorithm>

namespace viscera {

CutRecord::CutRecord(const Model& model, const JoinedNetwork& network, const FeatureSet& features) {
  if (!features.cuts) return;
  for (uint32_t i = 0; i < network.springs.size(); ++i) {
    const layout::SpringEnds& ends = network.springs[i];
    const uint32_t from_a = network.links[ends.link_a].lattice_spring & layout::kLatticeSpringMask;
    if (from_a >= layout::kAxialSprings) continue;
    const bool forward = from_a % 2 == 0;
    entries_.push_back({i, 3 * (forward ? ends.a : ends.b) + from_a / 2, forward});
  }
  if (features.lattice || !entries_.empty()) size_ = 3 * model.slots();
}

void CutRecord::addExplicit(const std::vector<float>& spring_cut, std::vector<float>& axial_cut) const {
  for (const Entry& entry : entries_) {
    const float cut = spring_cut[entry.spring];
    axial_cut[entry.at] = entry.forward || cut == 0 || cut >= layout::kErasedShare ? cut : 1 - cut;
  }
}

}  // namespace viscera
