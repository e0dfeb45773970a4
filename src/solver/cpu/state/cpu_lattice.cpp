// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_lattice.h"

#include <algorithm>
#include <string>

#include "math/archive.h"
#include "solver/tissue/restored_nodes.h"

namespace viscera {

namespace {

std::vector<layout::vec4> gathered(const AlignedVector<float>& planes, size_t slots) {
  std::vector<layout::vec4> out(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    const float* at = &planes[vectorAt(slot)];
    out[slot] = {at[0], at[64], at[128], 0};
  }
  return out;
}

void scatter(const std::vector<layout::vec4>& values, AlignedVector<float>& planes) {
  for (uint32_t slot = 0; slot < values.size(); ++slot) {
    float* at = &planes[vectorAt(slot)];
    at[0] = values[slot].x;
    at[64] = values[slot].y;
    at[128] = values[slot].z;
  }
}

template <class Values>
void clear(Values& values) {
  std::fill(values.begin(), values.end(), typename Values::value_type{});
}

}  // namespace

CpuState::CpuState(size_t slots) {
  for (int i = 0; i < 2; ++i) {
    displacement[i].resize(3 * slots);
    velocity[i].resize(3 * slots);
  }
}

CpuToolState::CpuToolState(const CpuStore& store, const FeatureSet& features) {
  if (features.obstacles > 0) {
    obstacle_impulses.resize(store.slotCount() * features.obstacles);
    met.resize(store.brickCount());
    obstacle_count = features.obstacles;
  }
  if (!features.tools) return;
  grab_offsets.resize(store.slotCount());
  impulses.resize(store.slotCount() * layout::kMaxStyluses);
  touched.resize(store.brickCount());
  held.resize(store.brickCount());
}

CpuLinks::CpuLinks(const Model& model)
    : network(joinNetworks(model)), spring_cut(network.springs.size()), whole_links_(network.links) {}

void CpuLinks::writeSpringCut(const std::vector<float>& cut) {
  if (network.springs.empty()) return;
  network.links = whole_links_;
  clear(spring_cut);
  std::copy(cut.begin(), cut.end(), spring_cut.begin());
  eraseSprings(cut, network.springs, network.links);
}

CpuLattice::CpuLattice(const Model& model, const std::vector<layout::BodyParams>& params, const FeatureSet& features)
    : store(model, params),
      links(model),
      strengths(model, store, features, links.network.masses_kg),
      state(store.slotCount()),
      tools(store, features),
      record(model, links.network, features),
      axial_cut(record.size()),
      cut_sides(record.size() / 3) {}

void CpuLattice::reset() {
  store.nodes = store.whole_nodes;
  visitState([](const StateField& field, auto& values) { setToRest(field, values); });
  state.current = 0;
  links.writeSpringCut({});
  strengths.refreshAll(store);
}

HostState CpuLattice::read() const {
  HostState out;
  out.displacement_m = gathered(state.displacement[state.current], slotCount());
  out.velocity_m_per_s = gathered(state.velocity[state.current], slotCount());
  readCuts(out);
  return out;
}

void CpuLattice::readCuts(CutSprings& out) const {
  out.nodes = store.nodes;
  out.spring_cut = links.spring_cut;
  out.axial_cut = axial_cut;
  record.addExplicit(out.spring_cut, out.axial_cut);
}

void CpuLattice::persist(Archive& archive) {
  archive.section("springs");
  archive.values(store.nodes);
  if (archive.reads()) requireNodesOf(store.whole_nodes, store.bodies, store.nodes, archive);
  std::vector<float> spring_cut = links.spring_cut;
  archive.values(spring_cut);
  std::string section;
  visitState([&](const StateField& field, auto& values) {
    if (section != field.section) archive.section(section = field.section);
    archive.values(values);
  });
  if (!archive.reads()) return;
  links.writeSpringCut(spring_cut);
  strengths.refreshAll(store);
}

void CpuLattice::write(const HostState& from) {
  scatter(from.displacement_m, state.displacement[state.current]);
  scatter(from.velocity_m_per_s, state.velocity[state.current]);
  store.nodes = from.nodes;
  clear(axial_cut);
  clear(cut_sides);
  std::copy_n(from.axial_cut.begin(), std::min(from.axial_cut.size(), axial_cut.size()), axial_cut.begin());
  links.writeSpringCut(from.spring_cut);
  setToRest(fields::kLeftByTearing, strengths.left);
  strengths.refreshAll(store);
}

}  // namespace viscera
