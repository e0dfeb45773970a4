// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/node_window.h"

#include <string>

#include "layout/bindings.h"

namespace viscera {

NodeWindow::NodeWindow(const FeatureSet& features, size_t most, AwakeBricks* awake)
    : awake_(awake),
      group_size_(features.group_size),
      slots_(most, "slots of a window"),
      moves_(2 * most, "nodes of a window") {
  std::vector<std::string> defines = features.defines();
  if (awake) defines.push_back("ASLEEP");
  scatter_ = gpu::Program::compute("node_window.comp", defines);
  defines.push_back("GATHER");
  gather_ = gpu::Program::compute("node_window.comp", defines);
}

/// Uploads slots only if they have changed.
void NodeWindow::show(const std::vector<uint32_t>& slots) {
  slots_.bindStorage(layout::kBindWindowSlots);
  moves_.bindStorage(layout::kBindWindow);
  if (slots == shown_) return;
  slots_.write(slots);
  shown_ = slots;
  wakes_ = true;
}

void NodeWindow::run(const gpu::Program& program, size_t nodes) const {
  program.use();
  program.set("node_count", static_cast<uint32_t>(nodes));
  gpu::Program::dispatch(nodes, group_size_);
  gpu::Program::storageBarrier();
}

void NodeWindow::read(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                      std::vector<Vector3f>& v_m_per_s) {
  if (slots.empty()) return;
  show(slots);
  run(gather_, slots.size());
  host_.resize(2 * slots.size());
  moves_.raw().read(0, host_.size() * sizeof(layout::vec4), host_.data());
  wakes_ = false;
  for (size_t i = 0; i < slots.size(); ++i) {
    const layout::vec4 &u = host_[i], &v = host_[slots.size() + i];
    u_m[i] = {u.x, u.y, u.z};
    v_m_per_s[i] = {v.x, v.y, v.z};
    wakes_ |= u.w != 0;
  }
}

void NodeWindow::push(const LatticeBuffers& buffers, uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                      const std::vector<Vector3f>& dv_m_per_s) {
  if (slots.empty()) return;
  show(slots);
  host_.resize(slots.size());
  for (size_t i = 0; i < slots.size(); ++i) host_[i] = {dv_m_per_s[i].x(), dv_m_per_s[i].y(), dv_m_per_s[i].z(), 0};
  moves_.write(host_);
  scatter_.set("dt_s", dt_s);
  scatter_.set("giver", stylus);
  scatter_.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  run(scatter_, slots.size());
  if (awake_ && wakes_) awake_->wakeMarked();
}

}  // namespace viscera
