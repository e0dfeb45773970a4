// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/processes/process.h"
#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// Makes the processes of a scene, in the order in which they act (registry.cpp).
/// @param model  must outlive them   @param tools  there are styluses   @throws SceneError  a process cannot be made
TissueProcesses makeProcesses(const Scene& scene, const Model& model, bool tools);

/// When a process reads or pushes nodes.
enum class ProcessActs { kNever, kWithTools, kAlways };

/// Returns the most that any process of a scene does. With kAlways the tissue cannot sleep as a whole; with any but
/// kNever a GPU keeps the data that TissuePort needs.
ProcessActs processesAct(const Scene& scene, const Model& model, bool tools);

}  // namespace viscera
