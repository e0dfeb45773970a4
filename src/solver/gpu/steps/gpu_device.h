// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>

#include "layout/bindings.h"
#include "solver/device/device.h"
#include "solver/gpu/contact/node_pairs.h"
#include "solver/gpu/steps/stepper.h"

namespace viscera {

/// The GPU as a device (solver/device/device.h). Owner of shaders/solver/implicit/implicit_fold.comp.
class GpuDevice {
 public:
  using Stepper = viscera::Stepper;
  using Lattice = LatticeBuffers;
  using vec4 = layout::vec4;
  using Word = uint32_t;

  template <class T>
  struct Field : gpu::Buffer<T> {
    /// @param gathered  also readable through texel fetches
    explicit Field(size_t count, const char* name = "guard", bool gathered = false) : gpu::Buffer<T>(count, name) {
      if (gathered) texels = gpu::TexelView(this->raw(), gpu::TexelFormat::kRgba32f);
    }
    gpu::TexelView texels;
  };
  struct Pass {
    explicit operator bool() const { return static_cast<bool>(programs[0]); }
    gpu::Program programs[2];  ///< without and with tools
    uint32_t options = 0;
  };

  /// All arguments must outlive the device.
  /// @param contacts  between nodes, part of the solution; null: none
  GpuDevice(const FeatureSet& features, const LatticeBuffers& lattice, const NodePairs* contacts = nullptr);

  size_t slots() const { return lattice_.store.slot_count; }
  size_t sumSize() const;
  uint32_t contactRows() const { return viscera::contactRows(features_.tools, features_.obstacles); }

  Pass pass(const char* name, uint32_t options) const;
  void bindLattice() const { lattice_.bind(); }
  void begin(const Stepper&) const {}
  template <class T>
  void bind(uint32_t binding, const Field<T>& field) const {
    field.bindStorage(binding);
    if (binding == layout::kBindIncrement) field.texels.bind(layout::kUnitIncrement);
  }
  void run(const Pass& pass, const Substep& step, Over over, std::initializer_list<Uniform> uniforms = {}) const;
  /// Writes the best share found by implicit_guess.comp into the guard (implicit_fold.comp).
  void chooseShare(bool bound_energy) const;
  void findPairs(const Substep& step) const {
    if (pairs) pairs->find(lattice_, step);
  }
  bool mayHavePairs() const { return pairs != nullptr; }

  const NodePairs* pairs;

 private:
  FeatureSet features_;
  const LatticeBuffers& lattice_;
  gpu::Program fold_;
};

}  // namespace viscera
