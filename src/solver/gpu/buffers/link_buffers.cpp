// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "layout/bindings.h"
#include "solver/gpu/buffers/lattice_buffers.h"

namespace viscera {

LinkBuffers::LinkBuffers(const Model& model, const FeatureSet& features) : network(joinNetworks(model)) {
  if (!features.network) return;
  rest = gpu::Buffer<layout::vec4>(network.rest_m, "rest");
  link_starts = gpu::Buffer<uint32_t>(network.starts, "link starts");
  links = gpu::Buffer<layout::Link>(network.links, "links");
  springs = gpu::Buffer<layout::SpringEnds>(network.springs, "springs");
  spring_cut = gpu::Buffer<float>(network.springs.size(), "spring cut");
  rest_texels_ = gpu::TexelView(rest.raw(), gpu::TexelFormat::kRgba32f);
  start_texels_ = gpu::TexelView(link_starts.raw(), gpu::TexelFormat::kR32ui);
  link_texels_ = gpu::TexelView(links.raw(), gpu::TexelFormat::kRgba32ui);
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
}

}  // namespace viscera
