// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "math/float_bits.h"

namespace viscera {

// Drivers of kernels are written once, as templates over the device that runs them. CpuDevice (solver/cpu/steps) has
// the kernels' text as C++, one class per choice of features, by the list in kernels.txt. GpuDevice (solver/gpu/steps)
// compiles them with OpenGL. A device has fields, which know their length, binds them by their numbers in
// layout/bindings.h, and runs passes over its nodes.

/// What a pass iterates over.
enum class Over { kNodes, kPairs };  ///< active nodes; at least those of them that may touch others

/// Options of a pass in addition to its uniforms, as bits.
constexpr uint32_t kInSubstep = 1;  ///< uses the substep, and probes and obstacles, compiled in if there may be any
constexpr uint32_t kWithPairs = 2;  ///< handles contacts between nodes
constexpr uint32_t kOfRates = 4;    ///< compiled with its feature RATE

/// A uniform's value, by its name.
struct Uniform {
  Uniform(gpu::UniformName of, uint32_t value) : name(of), word(value) {}
  Uniform(gpu::UniformName of, float value) : name(of), word(bitsOfFloat(value)), is_float(true) {}

  gpu::UniformName name;
  uint32_t word = 0;
  bool is_float = false;
};

}  // namespace viscera
