// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/touching.h"

#include <algorithm>

#include "math/archive.h"
#include "solver/cpu/steps/cpu_device.h"
#include "solver/tissue/features.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME TouchKernel
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/implicit/implicit_end.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace multigrid {

namespace {

constexpr float kAtPlane = 1e-4f;  // spacings: nearer than that a node touches
constexpr int kContactRounds = 6;  // over the contacts of a node, which share what it lacks
constexpr layout::ToolMotion kNoMotions[layout::kMaxStyluses] = {};

Vector3f vectorOf(const Vectors& x, size_t places, size_t place) {
  return {x[place], x[places + place], x[2 * places + place]};
}
void setVector(Vectors& x, size_t places, size_t place, const Vector3f& value) {
  for (size_t c = 0; c < 3; ++c) x[c * places + place] = value[static_cast<int>(c)];
}
glsl::vec3 toGlsl(const Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}
Vector3f fromGlsl(const glsl::vec3& v) {
  return {v.x, v.y, v.z};
}
Vector3f xyzOf(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

struct Touching::Kernel : glsl::TouchKernel {
  using glsl::TouchKernel::TouchKernel;
};

Touching::Touching(const FineLevel& level, const CpuLattice& lattice)
    : level_(level),
      rows_(std::min(3u, contactRows(!lattice.hands.impulses.empty(), lattice.hands.obstacle_count))),
      contacts_(3 * lattice.slotCount() * rows_, glsl::vec4(0)),
      known_(level.grid().nodeCount()),
      found_(known_.size()) {
  if (rows_ == 0) return;
  for (const float depth_m : lattice.strengths.surface_depth) deepest_m_ = std::max(deepest_m_, depth_m);
  const Grid& grid = level.grid();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const layout::vec4& origin = level.box(grid.bodyOf(node)).params.origin_spacing;
    rest_m_.push_back(xyzOf(origin) + origin.w * grid.at[node].cast<float>());
  }
}

Touching::Kernel Touching::kernelFor(CpuLattice& lattice) {
  Kernel out(lattice);
  out.tell(step_);
  out.tool_motions = motions_;
  out.node_contacts = contacts_.data();
  out.contact_rows = rows_;
  return out;
}

void Touching::persist(Archive& archive) {
  archive.list(pressed_);
  if (!archive.reads()) return;
  // Of the last step's nodes, as the next one begins.
  nodes_.clear();
  std::fill(known_.begin(), known_.end(), 0);
  std::fill(contacts_.begin(), contacts_.end(), glsl::vec4(0));
}

void Touching::begin(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  lattice_ = &lattice;
  step_ = step;
  motions_ = step.tools ? motions : kNoMotions;
  Kernel kernel = kernelFor(lattice);
  for (const Node& node : nodes_) {
    known_[node.node] = 0;
    if (rows_ > 0) kernel.clearContacts(node.slot);
  }
  nodes_.clear();
  share_ = 1;
  if (step.tools) hold(lattice);
}

void Touching::hold(CpuLattice& lattice) {
  Kernel kernel = kernelFor(lattice);
  const Grid& grid = level_.grid();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t slot = grid.slots[node],
                   by = (lattice.store.nodes[slot].lo & layout::kGrabMask) >> layout::kGrabShift;
    if (by == 0 || level_.movable()[grid.place_of[node]] == 0) continue;
    Node held{node, slot, grid.place_of[node], true};
    held.presses = true;
    held.way = fromGlsl(kernel.heldDisplacement(by - 1, slot)) -
               planesAt(lattice.state.displacement[lattice.state.current].data(), slot);
    nodes_.push_back(held);
    known_[node] = 1;
  }
}

/// May a probe touch a node that ends there?
bool Touching::isNear(const Vector3f& x) const {
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion& motion = motions_[s];
    if ((motion.info.y & layout::kToolPushes) == 0) continue;
    const Vector3f to = xyzOf(motion.to);
    const float reach = motion.from.w + deepest_m_ + (to - xyzOf(motion.from)).norm();
    if ((x - to).squaredNorm() <= reach * reach) return true;
  }
  return false;
}

/// Gives nodes contacts with everything in which the step would end if it went on like this.
void Touching::find(const Vectors& increment) {
  const Grid& grid = level_.grid();
  const size_t n = grid.places();
  const float* u = lattice_->state.displacement[lattice_->state.current].data();
  const bool obstacles = step_.obstacle_count > 0;
  constexpr size_t kPerJob = 1024;
  level_.parallel()((grid.nodeCount() + kPerJob - 1) / kPerJob, [&](size_t job) {
    Kernel kernel = kernelFor(*lattice_);
    for (size_t node = job * kPerJob; node < std::min(grid.nodeCount(), (job + 1) * kPerJob); ++node) {
      const uint32_t slot = grid.slots[node];
      const Vector3f at = planesAt(u, slot), du = vectorOf(increment, n, grid.place_of[node]) / share_;
      if ((!obstacles && !isNear(rest_m_[node] + at + du)) || level_.movable()[grid.place_of[node]] == 0) continue;
      kernel.findContacts(slot, toGlsl(at), toGlsl(du));
      found_[node] = kernel.contactCount(slot) > 0;
    }
  });
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    if (!found_[node]) continue;
    found_[node] = 0;
    if (known_[node]) continue;
    known_[node] = 1;
    nodes_.push_back({node, grid.slots[node], grid.place_of[node], false});
  }
}

size_t Touching::contactsOf(uint32_t slot, std::array<Half, 3>& out) const {
  size_t count = 0;
  for (; count < rows_; ++count) {
    const glsl::vec4* at = &contacts_[3 * (size_t{slot} * rows_ + count)];
    if (at[2].w == 0) break;
    Half& half = out[count];
    half = {{at[0].x, at[0].y, at[0].z}, {at[1].x, at[1].y, at[1].z}, at[0].w, at[1].w};
    if (share_ == 1) continue;
    const float way = half.way.dot(half.normal), inside = half.least - way;  // at the start of the step
    half.least = share_ * way + (inside > 0 ? share_ : 1) * inside;
    half.way *= share_;
  }
  return count;
}

/// The nearest increment that a node's contacts let be.
void Touching::outside(const Node& node, float* at, size_t places) const {
  std::array<Half, 3> contacts;
  const size_t count = contactsOf(node.slot, contacts);
  Vector3f du(at[0], at[places], at[2 * places]);
  if (node.sticks) {
    const Half& half = contacts[0];
    const Vector3f slip = du - half.way;
    du -= slip - slip.dot(half.normal) * half.normal;
  }
  for (size_t i = 0; i < kContactRounds * count; ++i) {
    const Half& half = contacts[i % count];
    du += std::max(0.0f, half.least - half.normal.dot(du)) * half.normal;
  }
  for (size_t c = 0; c < 3; ++c) at[c * places] = du[static_cast<int>(c)];
}

void Touching::place(Vectors& increment) {
  const size_t n = level_.places();
  if (rows_ > 0) find(increment);
  for (const Node& node : nodes_) {
    if (node.held)
      setVector(increment, n, node.place, share_ * node.way);
    else
      outside(node, &increment[node.place], n);
  }
}

/// @return its contacts press otherwise than before
bool Touching::pressNode(Node& node, const Vectors& increment, Vectors& lacks, const FineLevel& level) {
  const size_t n = level.places();
  const Vector3f du = vectorOf(increment, n, node.place);
  std::array<Half, 3> contacts;
  const size_t count = contactsOf(node.slot, contacts);
  const float near = kAtPlane * level.box(level.grid().bodyOf(node.node)).params.origin_spacing.w;
  float pressures[3] = {};
  Vector3f left = node.lacks;
  for (size_t i = 0; i < (count > 1 ? kContactRounds : 1) * count; ++i) {
    const Half& half = contacts[i % count];
    if (half.normal.dot(du) > half.least + near) continue;
    const float before = pressures[i % count];
    pressures[i % count] = std::max(0.0f, before + half.normal.dot(left));
    left -= (pressures[i % count] - before) * half.normal;
  }
  const uint32_t mask_before = node.mask;
  const bool stuck_before = node.sticks;
  node.mask = 0;
  node.sticks = false;
  std::array<Vector3f, 3> axes;
  size_t planes = 0;
  for (size_t row = 0; row < count; ++row) {
    if (pressures[row] <= 0) continue;
    node.mask |= 1u << row;
    Vector3f axis = contacts[row].normal;
    for (size_t other = 0; other < planes; ++other) axis -= axis.dot(axes[other]) * axes[other];
    if (axis.squaredNorm() > 1e-4f) axes[planes++] = axis.normalized();
  }
  node.presses = planes > 0;
  Vector3f drag = Vector3f::Zero();
  if (planes == 1 && count == 1 && contacts[0].friction > 0) {
    const Half& half = contacts[0];
    const Vector3f slip = du - half.way, along = slip - slip.dot(half.normal) * half.normal;
    const Vector3f wanted =
        left - left.dot(half.normal) * half.normal - along / std::max(level.give(node.place), 1e-30f);
    const float limit = half.friction * pressures[0], size = wanted.norm();
    node.sticks = size <= limit;
    if (!node.sticks) drag = limit / size * wanted;
  }
  if (node.sticks || planes == 3) {
    held_places_.push_back(node.place);
  } else {
    for (size_t i = 0; i < planes; ++i) planes_.push_back({node.place, axes[i]});
    for (size_t c = 0; c < 3; ++c) lacks[c * n + node.place] += drag[static_cast<int>(c)];
  }
  node.lacks = node.presses ? Vector3f(node.lacks - left + (node.sticks ? Vector3f(left) : drag)) : Vector3f::Zero();
  return mask_before != node.mask || stuck_before != node.sticks;
}

bool Touching::press(Vectors& lacks, const Vectors& increment, FineLevel& level) {
  const size_t n = level.places();
  held_places_.clear();
  planes_.clear();
  bool changed = false;
  for (Node& node : nodes_) {
    node.lacks = -vectorOf(lacks, n, node.place);
    if (node.held) {
      held_places_.push_back(node.place);
      continue;
    }
    changed |= pressNode(node, increment, lacks, level);
  }
  level.hold(held_places_, planes_);
  return changed;
}

double Touching::work(const Vectors& increment) const {
  double out = 0;
  for (const Node& node : nodes_)
    out += static_cast<double>(node.lacks.dot(vectorOf(increment, level_.places(), node.place)));
  return out;
}

void Touching::give(CpuLattice& lattice, const Vectors& increment, const Vectors& before_m_per_s, Vectors& velocity) {
  Kernel kernel = kernelFor(lattice);
  const size_t n = level_.places();
  const float* u = lattice.state.displacement[lattice.state.current].data();
  pressed_.clear();
  for (const Node& node : nodes_) {
    if (!node.presses) continue;
    pressed_.push_back(node.place);
    const float mass = level_.mass()[node.place];
    const Vector3f after = vectorOf(increment, n, node.place) / step_.dt_s,
                   before = vectorOf(before_m_per_s, n, node.place);
    const Vector3f inertia = (node.goes_evenly ? mass / step_.dt_s : 0) * (after - before);
    glsl::vec3 next = toGlsl(after);
    if (node.held) {
      const uint32_t by = (lattice.store.nodes[node.slot].lo & layout::kGrabMask) >> layout::kGrabShift;
      kernel.giveMomentum(by - 1, node.slot, step_.dt_s * toGlsl(node.lacks + inertia));
    } else {
      std::array<Half, 3> contacts;
      const size_t count = contactsOf(node.slot, contacts);
      Vector3f left = node.lacks;
      for (size_t i = 0; i < kContactRounds * count; ++i) {
        if (!(node.mask >> (i % count) & 1)) continue;
        const Vector3f& normal = contacts[i % count].normal;
        glsl::vec4& force = contacts_[3 * (size_t{node.slot} * rows_ + i % count) + 2];
        const float more = std::max(left.dot(normal), -normal.dot(Vector3f(force.x, force.y, force.z)));
        force = glsl::vec4(glsl::xyz(force) + more * toGlsl(normal), force.w);
        left -= more * normal;
      }
      if (count == 1 && node.mask != 0) {  // friction
        glsl::vec4& force = contacts_[3 * (size_t{node.slot} * rows_) + 2];
        const float stop = std::max(0.0f, inertia.dot(contacts[0].normal));
        force = glsl::vec4(glsl::xyz(force) + toGlsl(left + stop * contacts[0].normal), force.w);
      }
      kernel.giveContacts(node.slot, mass, next);
    }
    setVector(velocity, n, node.place, fromGlsl(next));
  }
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s) {
    if (!(motions_[s].info.y & layout::kToolFeels)) continue;
    for (uint32_t node = 0; node < known_.size(); ++node) {
      const uint32_t slot = level_.grid().slots[node];
      const Vector3f x = rest_m_[node] + planesAt(u, slot) + vectorOf(increment, n, level_.grid().place_of[node]);
      kernel.feel(slot, toGlsl(x));
    }
    break;
  }
}

}  // namespace multigrid

}  // namespace viscera
