// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/gpu_device.h"

#include <optional>

#include "gpu/stage_clock.h"
#include "solver/gpu/buffers/sum_tree.h"

namespace viscera {

GpuDevice::GpuDevice(const FeatureSet& features, const LatticeBuffers& lattice, const NodePairs* contacts)
    : pairs(contacts),
      features_(features),
      lattice_(lattice),
      fold_(gpu::Program::compute("implicit_fold.comp", features.defines())) {}

size_t GpuDevice::sumSize() const {
  return lattice_.store.active_count + sumTreeSize(lattice_.store.active_count);
}

GpuDevice::Pass GpuDevice::pass(const char* name, uint32_t options) const {
  const bool in_substep = options & kInSubstep;
  Pass out;
  out.options = pairs ? options : options & ~kWithPairs;
  for (int tools = 0; tools < (in_substep && features_.tools ? 2 : 1); ++tools) {
    std::vector<std::string> defines = features_.defines();
    defines.push_back("INCREMENT");
    if (tools) defines.push_back("TOOLS");
    if (in_substep && features_.obstacles > 0) defines.push_back("OBSTACLES");
    if (tools || (in_substep && features_.obstacles > 0)) defines.push_back("CONTACT");
    if (out.options & kWithPairs) defines.push_back("PAIRS");
    if (options & kOfRates) defines.push_back("RATE");
    out.programs[tools] = gpu::Program::compute(name, defines);
  }
  return out;
}

void GpuDevice::run(const Pass& pass, const Substep& step, Over /*over*/,
                    std::initializer_list<Uniform> uniforms) const {
  const gpu::Program& program = pass.programs[step.tools && pass.programs[1]];
  const size_t count = lattice_.store.active_count;
  program.use();
  if (pass.options & kInSubstep) setSubstep(program, lattice_, step);
  program.set("active_count", static_cast<uint32_t>(count));
  if (pass.options & kInSubstep && (step.tools || features_.obstacles > 0)) {
    program.set("slot_count", static_cast<uint32_t>(lattice_.store.slot_count));
    program.set("push_speed", step.push_speed_m_per_s);
    program.set("contact_rows", contactRows());
  }
  if (pass.options & kInSubstep && features_.obstacles > 0) {
    program.set("obstacle_count", step.obstacle_count);
    program.set("resting_speed", step.resting_speed_m_per_s);
  }
  if (pass.options & kWithPairs) pairs->tell(program, step);
  for (const Uniform& uniform : uniforms) {
    uniform.is_float ? program.set(uniform.name, floatFromBits(uniform.word)) : program.set(uniform.name, uniform.word);
  }
  gpu::Program::dispatch(count, features_.group_size);
  gpu::Program::storageBarrier();
}

void GpuDevice::chooseShare(bool bound_energy) const {
  fold_.use();
  forEachSumLevel(lattice_.store.active_count, [&](size_t inputs, size_t input_first, size_t output_first, bool last) {
    fold_.set("count", static_cast<uint32_t>(inputs));
    fold_.set("input_first", static_cast<uint32_t>(input_first));
    fold_.set("output_first", static_cast<uint32_t>(output_first));
    fold_.set("last_level", last ? 1u : 0u);
    fold_.set("bound_energy", bound_energy ? 1u : 0u);
    gpu::Program::dispatch(sumRuns(inputs), features_.group_size);
    gpu::Program::storageBarrier();
  });
}

}  // namespace viscera
