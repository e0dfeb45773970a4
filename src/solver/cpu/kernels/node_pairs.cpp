// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/node_pairs.h"

#include <algorithm>

#include "math/archive.h"
#include "solver/contact/collision.h"
#include "solver/contact/environment.h"
#include "solver/cpu/kernels/listed_kernel.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME MeetAhead
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_meet.comp"
#define VARIANT_FEATURES WITH_AHEAD
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME Record
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_record.comp"
#define VARIANT_FEATURES WITH_AHEAD
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

constexpr double kListMargin = 0.4;  // as CpuEnvironment::kListMargin

}  // namespace

CpuNodePairs::CpuNodePairs(const Model& model, const Scene& scene, const CpuLattice& lattice, const Parallel& parallel)
    : parallel_(parallel),
      config_(scene.collision),
      cell_m_(static_cast<float>(static_cast<double>(kPairReach) * collisionCell(model, config_))),
      influences_(bodyInfluences(model, scene)),
      touch_depths_(touchDepths(model, scene.collision)),
      contacts_(lattice.slotCount(), glsl::vec4(0)),
      words_(1 + 2 * lattice.slotCount() + mostPairEnds(lattice.store.active.size())),
      rows_(2 * mostPairEnds(lattice.store.active.size()), glsl::vec4(0)),
      node_pairs_(3 * lattice.slotCount(), glsl::vec4(0)),
      lists_(lattice, static_cast<double>(kPairReach) * collisionReach(model, scene.collision),
             kListMargin * collisionReach(model, scene.collision)) {
  paired_.reserve(lattice.store.active.size());
}

void CpuNodePairs::tell(glsl::PairBuffers& kernel, const Substep& step) {
  kernel.pair_words = words_.data();
  kernel.pair_rows = rows_.data();
  kernel.node_pairs = node_pairs_.data();
  kernel.most_pairs = static_cast<uint32_t>(rows_.size() / 2);
  kernel.pair_slots = static_cast<uint32_t>(node_pairs_.size() / 3);
  kernel.pair_friction = static_cast<float>(config_.friction);
  kernel.pair_bounces_from = step.resting_speed_m_per_s;
  kernel.pair_restitution = static_cast<float>(config_.restitution);
}

void CpuNodePairs::persist(Archive& archive) {
  archive.values(contacts_);
  archive.values(node_pairs_);
}

void CpuNodePairs::restart() {
  std::fill(node_pairs_.begin(), node_pairs_.end(), glsl::vec4(0));
}

template <class Kernel>
Kernel CpuNodePairs::kernel(CpuLattice& lattice, const Substep& step, glsl::vec4* increments) {
  Kernel out(lattice);
  out.tell(step);
  tell(out, step);
  out.widened = kPairReach;
  out.cell_m = cell_m_;
  out.touch_depths = touch_depths_.data();
  out.body_influences = influences_.data();
  out.contacts = contacts_.data();
  out.increments = increments;
  out.increment = increments;
  out.entries = lists_.entries();
  out.entries_before = lists_.before();
  return out;
}

void CpuNodePairs::find(CpuLattice& lattice, const Substep& step, glsl::vec4* increments) {
  for (const uint32_t slot : paired_) words_[2 + 2 * slot] = 0;
  paired_.clear();
  words_[0] = 0;
  auto rules = kernel<glsl::CollisionRules>(lattice, step, increments);
  lists_.update(rules, parallel_);
  parallel_(lists_.jobs(), [&](size_t job) { lists_.findContacts(job); });
  // Sequential: the ends of pairs claim space in order.
  const auto meet = kernel<glsl::MeetAhead>(lattice, step, increments);
  for (size_t job = 0; job < lists_.jobs(); ++job) glsl::visitListed(meet, lists_, job);
  const auto note = kernel<glsl::Record>(lattice, step, increments);
  parallel_(lists_.jobs(), [&](size_t job) { glsl::visitListed(note, lists_, job); });
  for (size_t e = 0; e < lists_.count(); ++e) {
    const uint32_t slot = lists_.entries()[e].w;
    if (words_[0] <= rows_.size() / 2 && words_[2 + 2 * slot] > 0) paired_.push_back(slot);
  }
}

}  // namespace viscera
