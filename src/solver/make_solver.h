// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "viscera/model/scene/solver_kinds.h"
#include "viscera/solver/solver.h"
#include "viscera/solver/threads.h"

namespace viscera {

struct Scene;

namespace gpu {
class Context;
}

// A context argument may be null: then there is none, and only the CPU can be used.

/// Returns the backend that a scene requests. kAuto: the GPU if the context has a hardware renderer and the GPU backend
/// supports all features of the scene, else the CPU.
Backend chooseBackend(const Scene& scene, const gpu::Context* context);

/// Returns one line for the user: which backend steps the tissue, and why.
/// @param note  from makeSolver()
std::string backendNote(const Scene& scene, const gpu::Context* context, const Solver& solver,
                        const std::string& note = {});

/// Makes the solver on the backend that the scene requests. @param model  must outlive it
/// @throws GpuError  the scene requests the GPU, and there is no context
/// @param threads  of the CPU backend, shared with others; null: its own, as many as solver.threads
/// @param note     set to what the user should know of the integrator; empty: nothing
std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context* context,
                                   const std::shared_ptr<ThreadPool>& threads = nullptr, std::string* note = nullptr);

}  // namespace viscera
