// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "viscera/gpu/context.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// The backend that a scene asks for. kAuto: the GPU if the context's renderer is a real one, else the CPU.
Backend chooseBackend(const SolverConfig& config, const gpu::Context& context);

/// One line for a person: which backend steps the tissue, and why.
std::string backendNote(const SolverConfig& config, const gpu::Context& context, const Solver& solver);

/// The solver on the backend that the scene asks for. @param model  must outlive it
std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context& context);

}  // namespace viscera
