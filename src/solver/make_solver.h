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

// Where a context is asked for, null means that there is none: then only the CPU is left.

/// The backend that a scene asks for. kAuto: the GPU if the context's renderer is a real one and the GPU backend has
/// all that the scene needs, else the CPU.
Backend chooseBackend(const Scene& scene, const gpu::Context* context);

/// One line for a person: which backend steps the tissue, and why.
/// @param note  that makeSolver() gave
std::string backendNote(const Scene& scene, const gpu::Context* context, const Solver& solver,
                        const std::string& note = {});

/// The solver on the backend that the scene asks for. @param model  must outlive it
/// @throws GpuError  the scene asks for the GPU, and there is no context
/// @param threads  of the CPU backend, shared with others; null: solver.threads of its own
/// @param note     set to what a person should know of the integrator; empty: nothing
std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context* context,
                                   const std::shared_ptr<ThreadPool>& threads = nullptr, std::string* note = nullptr);

}  // namespace viscera
