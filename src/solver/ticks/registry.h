// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/processes/process.h"
#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// Makes the processes that a scene has, in the order in which they act (registry.cpp).
/// @param model  must outlive them   @param tools  whether there are styluses   @throws SceneError  one cannot be made
TissueProcesses makeProcesses(const Scene& scene, const Model& model, bool tools);

/// When a process reads or pushes nodes after substeps.
enum class ProcessActs { kNever, kWithTools, kAlways };

/// @returns  the most that any process of a scene does: with kAlways the tissue cannot sleep as a whole, and with any
/// but kNever a GPU keeps what TissuePort needs
ProcessActs processesAct(const Scene& scene, const Model& model, bool tools);

}  // namespace viscera
