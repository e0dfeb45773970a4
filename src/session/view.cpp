// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/view.h"

#include <algorithm>

#include "session/host_view.h"
#include "session/inline_view.h"
#include "session/threaded_view.h"

namespace viscera {

size_t Wants::count() const {
  return static_cast<size_t>(surface) + static_cast<size_t>(std::count(cameras.begin(), cameras.end(), true));
}

std::unique_ptr<View> makeView(const Solver& solver, const Model& model, const Scene& scene, gpu::Context* context) {
  if (!context) return std::make_unique<HostView>(model);
  if (solver.onHost()) return std::make_unique<ThreadedView>(model, scene, *context);
  return std::make_unique<InlineView>(model, scene);
}

}  // namespace viscera
