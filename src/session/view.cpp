// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/view.h"

#include <algorithm>
#include <utility>

#include "session/host_view.h"
#include "session/inline_view.h"
#include "session/threaded_view.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

const std::vector<bool>& FrameRequest::of(PictureKind kind) const {
  const std::vector<bool>* const all[kPictureKinds] = {&cameras, &right, &depth, &labels};
  return *all[static_cast<size_t>(kind)];
}

std::vector<bool>& FrameRequest::of(PictureKind kind) {
  return const_cast<std::vector<bool>&>(std::as_const(*this).of(kind));
}

size_t FrameRequest::count() const {
  size_t out = surface;
  for (size_t kind = 0; kind < kPictureKinds; ++kind) {
    const std::vector<bool>& wanted = of(static_cast<PictureKind>(kind));
    out += static_cast<size_t>(std::count(wanted.begin(), wanted.end(), true));
  }
  return out;
}

std::unique_ptr<View> makeView(const Solver& solver, const Model& model, const Scene& scene, gpu::Context* context) {
  if (!context) return std::make_unique<HostView>(model);
  if (solver.onHost()) return std::make_unique<ThreadedView>(model, scene, *context);
  return std::make_unique<InlineView>(model, scene);
}

}  // namespace viscera
