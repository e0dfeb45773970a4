// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/environment.h"

#include <algorithm>
#include <optional>

#include "math/archive.h"
#include "solver/contact/node_pairs.h"
#include "solver/cpu/kernels/listed_kernel.h"
#include "solver/cpu/steps/cpu_device.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME MeetListed
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_meet.comp"
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME PushListed
#define VARIANT_BASE ListedKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_push.comp"
#define VARIANT_MEMBERS VISIT_LISTED
#include "solver/cpu/kernels/glsl_variant.inc"

struct EnvironmentKernel : Kernel {
  using Kernel::Kernel;
  vec4 air = vec4(0);
  const layout::vec4* body_influences = nullptr;
  const vec4* corrections = nullptr;
  const uint* ring_starts = nullptr;
  const WindTriangle* rings = nullptr;
  const float* spring_cut = nullptr;
};

// Features that a scene does not use have no effect here: forces, obstacles, rings, corrections.
#define VARIANT_NAME Surround
#define VARIANT_BASE EnvironmentKernel
#define VARIANT_TEXT "shaders/solver/collision/environment.comp"
#define VARIANT_FEATURES WITH_WIND | WITH_BODY_FORCES | WITH_OBSTACLES | WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME SurroundAndCollide
#define VARIANT_BASE EnvironmentKernel
#define VARIANT_TEXT "shaders/solver/collision/environment.comp"
#define VARIANT_FEATURES WITH_WIND | WITH_BODY_FORCES | WITH_OBSTACLES | WITH_COLLISIONS | WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME Blow
#define VARIANT_BASE EnvironmentKernel
#define VARIANT_TEXT "shaders/solver/collision/environment.comp"
#define VARIANT_FEATURES WITH_BEFORE | WITH_WIND | WITH_BODY_FORCES | WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME Collide
#define VARIANT_BASE EnvironmentKernel
#define VARIANT_TEXT "shaders/solver/collision/environment.comp"
#define VARIANT_FEATURES WITH_COLLISIONS | WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

struct CpuEnvironment::Work {
  CollisionConfig collision;
  WindConfig wind;
  float cell_m = 1, widened = 1;
  std::vector<layout::vec4> influences;  ///< bodyInfluences()
  Rings rings;
  std::vector<float> touch_depths;  ///< touchDepths()
  std::vector<glsl::vec4> contacts, corrections;
  std::optional<ContactLists> lists;  ///< null without collisions

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

CpuEnvironment::CpuEnvironment(const Model& model, const Scene& scene, const CpuLattice& lattice,
                               const Parallel& parallel, double list_margin, uint32_t most_in_bucket)
    : parallel_(parallel), kinds_(environmentOf(model, scene)), work_(std::make_unique<Work>()) {
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

CpuEnvironment::~CpuEnvironment() = default;

void CpuEnvironment::collide(CpuLattice& lattice, const Substep& step) {
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
void CpuEnvironment::apply(CpuLattice& lattice, const Substep& step, const Environment& environment) {
  const SubstepEnvironment now = environment.at(step.index);
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

void CpuEnvironment::blow(CpuLattice& lattice, const Substep& step, const Environment& environment) {
  apply<glsl::Blow>(lattice, step, environment);
  lattice.swap();
}

void CpuEnvironment::run(CpuLattice& lattice, const Substep& step, const Environment& environment) {
  if (kinds_.collisions) {
    collide(lattice, step);
    step.implicit ? apply<glsl::Collide>(lattice, step, environment)
                  : apply<glsl::SurroundAndCollide>(lattice, step, environment);
  } else {
    apply<glsl::Surround>(lattice, step, environment);
  }
  lattice.swap();
}

/// Lists of candidates are not saved: the contacts that they yield do not depend on when they were made.
void CpuEnvironment::persist(Archive& archive) {
  archive.values(work_->contacts);
  archive.values(work_->corrections);
}

void CpuEnvironment::restart() {
  std::fill(work_->contacts.begin(), work_->contacts.end(), glsl::vec4(0));
  std::fill(work_->corrections.begin(), work_->corrections.end(), glsl::vec4(0));
}

std::vector<CollisionPair> CpuEnvironment::findPairs(CpuLattice& lattice) {
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

size_t CpuEnvironment::searches() const {
  return work_->lists ? work_->lists->searches() : 0;
}

size_t CpuEnvironment::compared() const {
  return work_->lists ? work_->lists->compared() : 0;
}

uint32_t CpuEnvironment::crowded() const {
  return work_->lists ? work_->lists->crowded() : 0;
}

}  // namespace viscera
