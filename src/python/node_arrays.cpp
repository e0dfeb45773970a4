// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/node_arrays.h"

#include <cstring>
#include <limits>

namespace viscera::python {

std::vector<uint32_t> activeSlots(const Model& model) {
  std::vector<uint32_t> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) out.push_back(model.slotOffset(b) + slot);
  }
  return out;
}

std::vector<float> restPositions(const Model& model) {
  std::vector<float> out(3 * model.slots(), std::numeric_limits<float>::quiet_NaN());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3f rest = restPosition(model.bodies[b], slot).cast<float>();
      for (int c = 0; c < 3; ++c) out[3 * (size_t{model.slotOffset(b)} + slot) + static_cast<size_t>(c)] = rest[c];
    }
  }
  return out;
}

std::vector<float> positions(const Model& model, const HostState& state) {
  std::vector<float> out = restPositions(model);
  for (size_t slot = 0; slot < state.displacement_m.size(); ++slot) {
    float d[4];
    std::memcpy(d, &state.displacement_m[slot], sizeof d);
    for (size_t c = 0; c < 3; ++c) out[3 * slot + c] += d[c];
  }
  return out;
}

std::vector<double> wrenchesOf(const Frame& frame, size_t styluses) {
  std::vector<double> out;
  for (size_t s = 0; s < styluses; ++s) {
    const Reaction& reaction = frame.reactions[s];
    out.insert(out.end(), reaction.force_n.data(), reaction.force_n.data() + 3);
    out.insert(out.end(), reaction.torque_nm.data(), reaction.torque_nm.data() + 3);
  }
  return out;
}

}  // namespace viscera::python
