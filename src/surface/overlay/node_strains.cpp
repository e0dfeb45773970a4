// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/overlay/node_strains.h"

#include <string>
#include <vector>

#include "layout/bindings.h"
#include "solver/tissue/joined_network.h"
#include "surface/surface_kernels.h"

namespace viscera {

namespace {

/// Links of every slot, in the order in which overlay_nodes.comp visits them.
struct Links {
  std::vector<uint32_t> starts;
  std::vector<layout::OverlayLink> links;
};
Links linksOf(const JoinedNetwork& network, size_t slots) {
  Links out;
  out.starts.assign(slots + 1, 0);
  for (const layout::SpringEnds& spring : network.springs) {
    ++out.starts[spring.a + 1];
    ++out.starts[spring.b + 1];
  }
  for (size_t slot = 0; slot < slots; ++slot) out.starts[slot + 1] += out.starts[slot];
  std::vector<uint32_t> next(out.starts.begin(), out.starts.end() - 1);
  out.links.resize(2 * network.springs.size());
  for (uint32_t s = 0; s < network.springs.size(); ++s) {
    const layout::SpringEnds& spring = network.springs[s];
    const float length = network.links[spring.link_a].offset_length.w;
    out.links[next[spring.a]++] = {spring.b, s, length};
    out.links[next[spring.b]++] = {spring.a, s, length};
  }
  return out;
}

}  // namespace

NodeStrains::NodeStrains(const Model& model, Mean mean) : nodes_(model.slots(), "overlay nodes") {
  std::vector<std::string> features;
  if (mean == Mean::kSigned) features.emplace_back("SIGNED");
  if (model.hasNetwork()) {
    const Links links = linksOf(joinNetworks(model), model.slots());
    link_starts_ = gpu::Buffer<uint32_t>(links.starts, "overlay link starts");
    links_ = gpu::Buffer<layout::OverlayLink>(links.links, "overlay links");
    features.emplace_back("NETWORK");
  }
  position_ = surfaceKernel("overlay_nodes.comp", features);
}

void NodeStrains::follow(const StateView& state) {
  bindStorage(layout::kBindBricks, state.bricks);
  bindStorage(layout::kBindBodies, state.bodies);
  bindStorage(layout::kBindNodes, state.nodes);
  bindStorage(layout::kBindDisplacementIn, state.displacement);
  if (link_starts_.size() > 0) {
    bindStorage(layout::kBindRest, state.rest);
    bindStorage(layout::kBindSpringCut, state.spring_cut);
    link_starts_.bindStorage(layout::kBindOverlayLinkStarts);
    links_.bindStorage(layout::kBindOverlayLinks);
  }
  nodes_.bindStorage(layout::kBindOverlayNodes);
  runOver(position_, nodes_.size());
  gpu::Program::storageBarrier();
}

}  // namespace viscera
