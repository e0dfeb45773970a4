// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout/bindings.h"
#include "layout/edge_forces.h"
#include "solver/gpu/buffers/lattice_buffers.h"

namespace viscera {

LinkBuffers::LinkBuffers(const Model& model, const FeatureSet& features)
    : network(joinNetworks(model)), edge_forces(features.edge_forces ? orderByOwner(network) : EdgeForces{}) {
  if (!features.network) return;
  rest = gpu::Buffer<layout::vec4>(network.rest_m, "rest");
  link_starts = gpu::Buffer<uint32_t>(network.starts, "link starts");
  links = gpu::Buffer<layout::Link>(network.links, "links");
  springs = gpu::Buffer<layout::SpringEnds>(network.springs, "springs");
  spring_cut = gpu::Buffer<float>(network.springs.size(), "spring cut");
  rest_texels_ = gpu::TexelView(rest.raw(), gpu::TexelFormat::kRgba32f);
  start_texels_ = gpu::TexelView(link_starts.raw(), gpu::TexelFormat::kR32ui);
  link_texels_ = gpu::TexelView(links.raw(), gpu::TexelFormat::kRgba32ui);
  if (features.edge_forces) allocateEdgeForces();
}

void LinkBuffers::allocateEdgeForces() {
  link_runs = gpu::Buffer<layout::uvec4>(edge_forces.links, "link runs");
  start_texels_ = gpu::TexelView(link_runs.raw(), gpu::TexelFormat::kRgba32ui);
  spring_owners = gpu::Buffer<layout::SpringOwner>(edge_forces.owners, "spring owners");
  force_starts = gpu::Buffer<uint32_t>(edge_forces.starts, "force starts");
  link_forces = gpu::Buffer<layout::vec4>(edge_forces.places(), "link forces");
  owner_texels_ = gpu::TexelView(spring_owners.raw(), gpu::TexelFormat::kRgba32ui);
  force_start_texels_ = gpu::TexelView(force_starts.raw(), gpu::TexelFormat::kR32ui);
  link_force_texels_ = gpu::TexelView(link_forces.raw(), gpu::TexelFormat::kRgba32f);
}

void LinkBuffers::writeSpringCut(const std::vector<float>& cut) {
  if (network.springs.empty()) return;
  std::vector<layout::Link> now = network.links;
  eraseSprings(cut, network.springs, now);
  links.write(now);
  spring_cut.clear();
  spring_cut.write(cut);
}

void LinkBuffers::bind() const {
  if (!rest.size()) return;
  links.bindStorage(layout::kBindLinks);
  springs.bindStorage(layout::kBindSprings);
  spring_cut.bindStorage(layout::kBindSpringCut);
  rest.bindStorage(layout::kBindRest);
  rest_texels_.bind(layout::kUnitRest);
  start_texels_.bind(layout::kUnitLinkStarts);
  link_texels_.bind(layout::kUnitLinks);
  if (!force_starts.size()) return;
  owner_texels_.bind(layout::kUnitSpringOwners);
  force_start_texels_.bind(layout::kUnitForceStarts);
  link_forces.bindStorage(layout::kBindLinkForces);
  link_force_texels_.bind(layout::kUnitLinkForces);
}

}  // namespace viscera
