// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/good_states.h"

#include <algorithm>
#include <cstring>

#include "math/archive.h"

namespace viscera {

void CpuGoodStates::allocate(CpuLattice& lattice, Bytes& state) {
  if (!state.empty()) return;
  lattice.visitState([&](const StateField& field, auto& values) {
    if (field.roll_back == FieldRollBack::kUndo) state.emplace_back(values.size() * sizeof(values[0]));
  });
}

void CpuGoodStates::save(CpuLattice& lattice) {
  Bytes& to = ring_[static_cast<size_t>(next_)];
  allocate(lattice, to);
  size_t count = 0;
  lattice.visitState([&](const StateField& field, auto& values) {
    if (field.roll_back != FieldRollBack::kUndo) return;
    std::memcpy(to[count].data(), values.data(), to[count].size());
    ++count;
  });
  const auto depth = static_cast<int>(ring_.size());
  next_ = (next_ + 1) % depth;
  kept_ = std::min(kept_ + 1, depth);
}

void CpuGoodStates::restore(CpuLattice& lattice, int back) {
  const auto depth = static_cast<int>(ring_.size());
  const bool exhausted = back >= kept_;
  back = std::min(back, kept_ - 1);
  next_ = (next_ - back + depth) % depth;
  kept_ -= back;
  const Bytes& from = ring_[static_cast<size_t>((next_ - 1 + depth) % depth)];
  size_t count = 0;
  lattice.visitState([&](const StateField& field, auto& values) {
    if (field.roll_back != FieldRollBack::kUndo) return;
    std::memcpy(values.data(), from[count].data(), from[count].size());
    ++count;
    if (exhausted && &field == &fields::kVelocity) setToRest(field, values);
  });
}

void CpuGoodStates::persist(Archive& archive, CpuLattice& lattice) {
  int next = next_, kept = kept_;
  archive.value(next);
  archive.value(kept);
  const auto depth = static_cast<int>(ring_.size());
  archive.require(next >= 0 && next < std::max(1, depth) && kept >= 0 && kept <= depth,
                  "there is no state to roll back to at this index");
  next_ = next;
  kept_ = kept;
  for (Bytes& state : ring_) {
    allocate(lattice, state);
    for (std::vector<char>& bytes : state) archive.values(bytes);
  }
}

}  // namespace viscera
