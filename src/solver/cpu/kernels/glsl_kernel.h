// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/kernels/glsl.h"
#include "solver/cpu/kernels/glsl_features.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/obstacle_motion.h"

namespace viscera::glsl {

/// displacement or velocity of a CpuLattice as a shader's buffer of vec4 (w is 0).
class Planes {
 public:
  class Element {
   public:
    explicit Element(float* at) : at_(at) {}
    operator vec4() const { return {at_[0], at_[64], at_[128], 0}; }
    void operator=(const vec4& v) {
      at_[0] = v.x;
      at_[64] = v.y;
      at_[128] = v.z;
    }

   private:
    float* at_;
  };
  explicit Planes(AlignedVector<float>& values) : first_(values.data()) {}
  Element operator[](uint slot) const { return Element(first_ + vectorAt(slot)); }

 private:
  float* first_;
};

inline vec4 stateAt(const Planes& planes, int slot) {
  return planes[static_cast<uint>(slot)];
}
inline vec4 stateAt(const vec4* buffer, int index) {
  return buffer[index];
}
inline vec4 texelFetch(const vec4* buffer, int index) {
  return buffer[index];
}

/// layout::vec4 in memory as a shader's buffer of vec4.
class Vectors {
 public:
  class Element {
   public:
    explicit Element(layout::vec4& at) : at_(at) {}
    operator vec4() const { return xyzw(at_); }
    void operator=(const vec4& v) { at_ = {v.x, v.y, v.z, v.w}; }
    void operator+=(const vec4& v) { *this = xyzw(at_) + v; }

   private:
    layout::vec4& at_;
  };
  explicit Vectors(std::vector<layout::vec4>& values) : first_(values.data()) {}
  Element operator[](size_t index) const { return Element(first_[index]); }

 private:
  layout::vec4* first_;
};

/// Buffers and uniforms that kernels have on the GPU (shaders/solver/tissue/lattice.glsl, elastic.glsl, step.glsl,
/// contact.glsl), with the same names. A kernel is a class derived from this one with a shader's text as its body;
/// main() is one invocation, the one of `index`.
struct Kernel {
  explicit Kernel(CpuLattice& lattice)
      : active_nodes(lattice.store.active.data()),
        active_count(static_cast<uint>(lattice.store.active.size())),
        slot_count(static_cast<uint>(lattice.store.nodes.size())),
        nodes(lattice.store.nodes.data()),
        bodies(lattice.store.bodies.data()),
        cells(lattice.store.cells.data()),
        displacement(lattice.state.displacement[lattice.state.current]),
        velocity(lattice.state.velocity[lattice.state.current]),
        next_displacement(lattice.state.displacement[1 - lattice.state.current]),
        next_velocity(lattice.state.velocity[1 - lattice.state.current]),
        grab_offsets(lattice.tools.grab_offsets),
        impulses_(lattice.tools.impulses.data()),
        touched_(lattice.tools.touched.data()),
        obstacle_impulses_(lattice.tools.obstacle_impulses.data()),
        met_(lattice.tools.met.data()),
        bricks_(lattice.store.bricks.data()),
        stiffness_(lattice.strengths.stiffness.data()),
        mass_(lattice.strengths.mass.data()),
        depth_(lattice.strengths.surface_depth.empty() ? nullptr : lattice.strengths.surface_depth.data()),
        offsets_(lattice.strengths.surface_offsets.empty() ? nullptr : lattice.strengths.surface_offsets.data()),
        rest_(lattice.links.network.rest_m.data()),
        link_starts_(lattice.links.network.starts.data()),
        links_(lattice.links.network.links.data()) {}

  void tell(const Substep& step) {
    dt_s = step.dt_s;
    kick_s = step.kick_s;
    gravity = vec3(step.gravity.x(), step.gravity.y(), step.gravity.z());
    sleep_distance_m = step.sleep_distance_m;
    push_speed = step.push_speed_m_per_s;
    edge_reach = step.edge_reach_m;
    resting_speed = step.resting_speed_m_per_s;
    obstacles = step.obstacles;
    obstacle_count = step.obstacle_count;
  }

  uint index = 0;
  uint globalIndex() const { return index; }

  const uint* active_nodes;
  uint active_count, slot_count;
  NodeBits* nodes;
  const BodyParams* bodies;
  const uint* cells;
  Planes displacement, velocity, next_displacement, next_velocity;
  float dt_s = 0, kick_s = 0, sleep_distance_m = 0, push_speed = 0, edge_reach = 0, resting_speed = 0;
  vec3 gravity = vec3(0);
  const ToolMotion* tool_motions = nullptr;
  const ObstacleMotion* obstacles = nullptr;
  uint obstacle_count = 0;
  Vectors grab_offsets;

  uint neighborBrick(uint slot, uint direction) const { return bricks_[slot >> 6].neighbors[direction]; }
  ivec3 brickCoord(uint slot) const {
    const Brick& brick = bricks_[slot >> 6];
    return {brick.coord_x, brick.coord_y, brick.coord_z};
  }
  uint brickBody(uint slot) const { return bricks_[slot >> 6].body; }
  vec3 tabulatedRest(uint slot) const { return xyz(rest_[slot]); }
  uint linkStart(uint slot) const { return link_starts_[slot]; }
  const Link& linkAt(uint link) const { return links_[link]; }
  float nodeMass(uint slot, const NodeBits&, const BodyParams&) const { return mass_[slot]; }
  float surfaceDepth(uint slot) const { return depth_ ? depth_[slot] : 0; }
  uint surfaceOffset(uint slot) const { return offsets_ ? offsets_[slot] : 0; }
  float springStiffness(uint slot, uint far, uint spring, uint, const BodyParams&) const {
    return stiffness_[stiffnessAt((spring & 1u) == 0u ? slot : far, spring >> 1)];
  }
  void giveMomentum(uint stylus, uint slot, const vec3& impulse) {
    layout::vec4& sum = impulses_[stylus * slot_count + slot];
    sum = {sum.x + impulse.x, sum.y + impulse.y, sum.z + impulse.z, sum.w + 1};
    touched_[slot >> 6] = 1;
  }
  void giveObstacle(uint obstacle, uint slot, const vec3& impulse) {
    layout::vec4& sum = obstacle_impulses_[obstacle * slot_count + slot];
    sum = {sum.x + impulse.x, sum.y + impulse.y, sum.z + impulse.z, sum.w + 1};
    met_[slot >> 6] = 1;
  }

 private:
  layout::vec4* impulses_;
  uint8_t* touched_;
  layout::vec4* obstacle_impulses_;
  uint8_t* met_;
  const Brick* bricks_;
  const float *stiffness_, *mass_, *depth_;
  const uint* offsets_;
  const layout::vec4* rest_;
  const uint* link_starts_;
  const Link* links_;
};

}  // namespace viscera::glsl
