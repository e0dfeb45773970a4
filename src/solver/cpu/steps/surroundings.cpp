// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/surroundings.h"

#include <algorithm>
#include <optional>

#include "math/archive.h"
#include "solver/contact/node_pairs.h"
#include "solver/cpu/steps/cpu_device.h"
#include "solver/cpu/text/listed_kernel.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME MeetListed
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_meet.comp"
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME PushListed
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_push.comp"
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/text/glsl_variant.inc"

struct SurroundingsKernel : Kernel {
  using Kernel::Kernel;
  vec4 air = vec4(0);
  const layout::vec4* body_influences = nullptr;
  const vec4* corrections = nullptr;
  const uint* ring_starts = nullptr;
  const WindTriangle* rings = nullptr;
  const float* spring_cut = nullptr;
};

// What a scene does not have does nothing here: no forces, no obstacles, no rings, no corrections.
#define VARIANT_NAME Surround
#define VARIANT_BASE SurroundingsKernel
#define VARIANT_TEXT "shaders/solver/collision/surroundings.comp"
#define VARIANT_FEATURES WITH_WIND | WITH_BODY_FORCES | WITH_OBSTACLES | WITH_TOOLS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME SurroundAndCollide
#define VARIANT_BASE SurroundingsKernel
#define VARIANT_TEXT "shaders/solver/collision/surroundings.comp"
#define VARIANT_FEATURES WITH_WIND | WITH_BODY_FORCES | WITH_OBSTACLES | WITH_COLLISIONS | WITH_TOOLS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Blow
#define VARIANT_BASE SurroundingsKernel
#define VARIANT_TEXT "shaders/solver/collision/surroundings.comp"
#define VARIANT_FEATURES WITH_BEFORE | WITH_WIND | WITH_BODY_FORCES | WITH_TOOLS
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Collide
#define VARIANT_BASE SurroundingsKernel
#define VARIANT_TEXT "shaders/solver/collision/surroundings.comp"
#define VARIANT_FEATURES WITH_COLLISIONS | WITH_TOOLS
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

struct CpuSurroundings::Work {
  CollisionConfig collision;
  WindConfig wind;
  float cell_m = 1, widened = 1;
  std::vector<layout::vec4> influences;  ///< bodyInfluences()
  Rings rings;
  std::vector<float> touch_depths;  ///< touchDepths()
  std::vector<glsl::vec4> contacts, corrections;
  std::optional<ContactLists> lists;  ///< where there are collisions

  template <class Kernel>
  Kernel kernel(CpuLattice& lattice, const Substep& step) {
    Kernel out(lattice);
    out.tell(step);
    out.cell_m = cell_m;
    out.widened = widened;
    out.friction = static_cast<float>(collision.friction);
    out.restitution = static_cast<float>(collision.restitution);
    out.touch_depths = touch_depths.data();
    out.body_influences = influences.data();
    out.contacts = contacts.data();
    out.corrections = corrections.data();
    if (lists) {
      out.entries = lists->entries();
      out.entries_before = lists->before();
    }
    return out;
  }
};

CpuSurroundings::CpuSurroundings(const Model& model, const Scene& scene, const CpuLattice& lattice,
                                 const Parallel& parallel, double list_margin, uint32_t most_in_bucket)
    : parallel_(parallel), kinds_(surroundingsOf(model, scene)), work_(std::make_unique<Work>()) {
  work_->collision = scene.collision;
  work_->wind = scene.environment.wind;
  work_->influences = bodyInfluences(model, scene);
  if (kinds_.wind) {
    work_->rings = joinRings(model);
  } else {
    work_->rings.starts.assign(lattice.slotCount() + 1, 0);
  }
  if (!kinds_.collisions) return;
  if (solvesContacts(scene)) work_->widened = kMissedReach;
  work_->cell_m = static_cast<float>(collisionCell(model, scene.collision));
  work_->touch_depths = touchDepths(model, scene.collision);
  work_->contacts.assign(lattice.slotCount(), glsl::vec4(0));
  work_->corrections.assign(2 * lattice.slotCount(), glsl::vec4(0));
  const double reach_m = collisionReach(model, scene.collision);
  work_->lists.emplace(lattice, reach_m, list_margin * reach_m, most_in_bucket);
}

CpuSurroundings::~CpuSurroundings() = default;

void CpuSurroundings::collide(CpuLattice& lattice, const Substep& step) {
  ContactLists& lists = *work_->lists;
  auto rules = work_->kernel<glsl::CollisionRules>(lattice, step);
  lists.update(rules, parallel_);
  const auto meet = work_->kernel<glsl::MeetListed>(lattice, step);
  parallel_(lists.jobs(), [&](size_t job) {
    lists.findContacts(job);
    glsl::visitListed(meet, lists, job);
  });
  const auto push = work_->kernel<glsl::PushListed>(lattice, step);
  parallel_(lists.jobs(), [&](size_t job) { glsl::visitListed(push, lists, job); });
}

template <class Kernel>
void CpuSurroundings::apply(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings) {
  const SubstepSurroundings now = surroundings.at(step.index);
  Kernel kernel(lattice);
  kernel.tell(step);
  const Vector3f& wind = now.wind_m_per_s;
  const float air = 0.5f * static_cast<float>(work_->wind.air_density_kg_per_m3 * work_->wind.drag_coefficient);
  kernel.air = glsl::vec4(wind.x(), wind.y(), wind.z(), air);
  kernel.body_influences = work_->influences.data();
  kernel.corrections = work_->corrections.data();
  kernel.ring_starts = work_->rings.starts.data();
  kernel.rings = work_->rings.triangles.data();
  kernel.spring_cut = lattice.links.spring_cut.data();
  runNodes(parallel_, lattice, kernel);
}

void CpuSurroundings::blow(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings) {
  apply<glsl::Blow>(lattice, step, surroundings);
  lattice.swap();
}

void CpuSurroundings::run(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings) {
  if (kinds_.collisions) {
    collide(lattice, step);
    step.implicit ? apply<glsl::Collide>(lattice, step, surroundings)
                  : apply<glsl::SurroundAndCollide>(lattice, step, surroundings);
  } else {
    apply<glsl::Surround>(lattice, step, surroundings);
  }
  lattice.swap();
}

/// Lists of candidates are made again: what is found with them does not depend on when they were made.
void CpuSurroundings::persist(Archive& archive) {
  archive.values(work_->contacts);
  archive.values(work_->corrections);
}

void CpuSurroundings::restart() {
  std::fill(work_->contacts.begin(), work_->contacts.end(), glsl::vec4(0));
  std::fill(work_->corrections.begin(), work_->corrections.end(), glsl::vec4(0));
}

std::vector<CollisionPair> CpuSurroundings::findPairs(CpuLattice& lattice) {
  std::vector<CollisionPair> out;
  ContactLists& lists = *work_->lists;
  auto rules = work_->kernel<glsl::CollisionRules>(lattice, {});
  lists.update(rules, parallel_);
  parallel_(lists.jobs(), [&lists](size_t job) { lists.findContacts(job); });
  for (uint32_t e = 0; e < lists.count(); ++e) {
    const auto slotOf = [&lists](uint32_t entry) { return lists.entries()[entry].w; };
    for (const ListedContact* c = lists.begin(e); c != lists.end(e); ++c) {
      if (e < c->other) out.push_back({slotOf(e), slotOf(c->other)});
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

size_t CpuSurroundings::searches() const {
  return work_->lists ? work_->lists->searches() : 0;
}

size_t CpuSurroundings::compared() const {
  return work_->lists ? work_->lists->compared() : 0;
}

uint32_t CpuSurroundings::crowded() const {
  return work_->lists ? work_->lists->crowded() : 0;
}

}  // namespace viscera
