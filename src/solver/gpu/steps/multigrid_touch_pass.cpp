// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/multigrid_touch_pass.h"

#include "gpu/archive.h"
#include "layout/bindings.h"

namespace viscera {

MultigridTouchPass::MultigridTouchPass(const FeatureSet& features, const LatticeBuffers& buffers)
    : contacts_(size_t{3} * contactRows(features.tools, features.obstacles) * buffers.store.slot_count,
                "contacts of nodes"),
      group_size_(features.group_size),
      contact_rows_(contactRows(features.tools, features.obstacles)),
      obstacles_(features.obstacles > 0) {
  constexpr const char* kNames[kActs] = {"BEGIN", "PLACE", "PRESS", "GIVE"};
  contacts_.bindStorage(layout::kBindNodeContacts);  // what is too large for the driver is said now
  for (int tools = obstacles_ ? 0 : 1; tools < (features.tools ? 2 : 1); ++tools) {
    std::vector<std::string> defines = features.defines();
    defines.insert(defines.end(), {"INCREMENT", "NO_SWEEPS", "CONTACT", "HELD"});
    if (tools) defines.push_back("TOOLS");
    if (obstacles_) defines.push_back("OBSTACLES");
    for (int act = 0; act < kActs; ++act) {
      std::vector<std::string> known = defines;
      known.push_back(kNames[act]);
      programs_[tools][act] = gpu::Program::compute("multigrid_touch.comp", known);
    }
  }
}

void MultigridTouchPass::run(Act act, const LatticeBuffers& buffers, const Substep& step) const {
  const gpu::Program& program = programs_[step.tools][act];
  contacts_.bindStorage(layout::kBindNodeContacts);
  program.use();
  setSubstep(program, buffers, step);
  program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  program.set("push_speed", step.push_speed_m_per_s);
  program.set("contact_rows", contact_rows_);
  program.set("touch_share", share_);
  if (obstacles_) {
    program.set("obstacle_count", step.obstacle_count);
    program.set("resting_speed", step.resting_speed_m_per_s);
  }
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void MultigridTouchPass::persist(Archive& archive) {
  gpu::persist(archive, contacts_);
}

void MultigridTouchPass::begin(const LatticeBuffers& buffers, const Substep& step) const {
  run(kBegin, buffers, step);
}

void MultigridTouchPass::place(const LatticeBuffers& buffers, const Substep& step) const {
  run(kPlace, buffers, step);
}

void MultigridTouchPass::press(const LatticeBuffers& buffers, const Substep& step) const {
  run(kPress, buffers, step);
}

void MultigridTouchPass::give(const LatticeBuffers& buffers, const Substep& step) const {
  run(kGive, buffers, step);
}

}  // namespace viscera
