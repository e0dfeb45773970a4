// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/environment.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <string>

#include "layout/wind.h"
#include "math/archive.h"
#include "math/number_text.h"
#include "solver/contact/collision.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr double kPi = 3.14159265358979323846;

bool isPushed(const Body& body) {
  return body.force_n != Vector3d::Zero();
}

bool hasSurface(const Body& body) {
  return body.network && !body.network->triangles.empty();
}

/// Springs of a body by their ends, the lower slot first.
using SpringIndex = std::map<std::array<uint32_t, 2>, uint32_t>;

SpringIndex springsByEnds(const SpringNetwork& network) {
  SpringIndex out;
  for (uint32_t s = 0; s < network.springs.size(); ++s) out.insert({{network.springs[s].a, network.springs[s].b}, s});
  return out;
}

/// Appends the rings of a body; slots and springs are numbered over all bodies.
void appendRings(const SpringNetwork& network, uint32_t first_slot, uint32_t first_spring, Rings& rings) {
  const SpringIndex index = springsByEnds(network);
  const auto springAt = [&](uint32_t a, uint32_t b) {
    const auto found = index.find({std::min(a, b), std::max(a, b)});
    return found == index.end() ? layout::kNoSpring : first_spring + found->second;
  };
  std::vector<std::vector<layout::WindTriangle>> around(network.positions_m.size());
  for (const std::array<uint32_t, 3>& t : network.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      around[a].push_back({first_slot + b, first_slot + c, {springAt(a, b), springAt(b, c), springAt(c, a)}, 0});
    }
  }
  for (const std::vector<layout::WindTriangle>& ring : around) {
    rings.triangles.insert(rings.triangles.end(), ring.begin(), ring.end());
    rings.starts.push_back(static_cast<uint32_t>(rings.triangles.size()));
  }
}

bool isSame(const Pose& a, const Pose& b) {
  return a.position_m == b.position_m && a.orientation.coeffs() == b.orientation.coeffs();
}
bool isSame(const RigidMotion& a, const RigidMotion& b) {
  return isSame(a.from, b.from) && isSame(a.to, b.to);
}

/// Returns the motion of an obstacle that stays where it was.
RigidMotion resting(const RigidMotion& before) {
  return {before.to, before.to};
}

}  // namespace

EnvironmentFeatures environmentOf(const Model& model, const Scene& scene) {
  const WindConfig& wind = scene.environment.wind;
  EnvironmentFeatures out;
  out.wind = wind.velocity_m_per_s != Vector3d::Zero() && wind.air_density_kg_per_m3 * wind.drag_coefficient > 0 &&
             std::any_of(model.bodies.begin(), model.bodies.end(), hasSurface);
  out.forces = std::any_of(model.bodies.begin(), model.bodies.end(), isPushed);
  out.obstacles = !scene.obstacles.empty();
  out.collisions = scene.collision.enabled;
  return out;
}

Environment::Environment(const Model& model, const Scene& scene)
    : features_(environmentOf(model, scene)),
      wind_(scene.environment.wind),
      obstacles_(scene.obstacles),
      at_start_(Obstacles(scene.obstacles).motions()),
      tick_motions_(at_start_),
      positions_(obstacles_.size(), Vector3f::Zero()) {}

void Environment::beginTick(double tick_s, int substeps, const ObstacleMotions& obstacles) {
  assert(obstacles.empty() || obstacles.size() == obstacles_.size());
  tick_s_ = tick_s;
  moved_ = false;
  for (size_t i = 0; i < obstacles_.size(); ++i) {
    const RigidMotion next = obstacles.empty() ? resting(tick_motions_[i]) : obstacles[i];
    moved_ |= !isSame(next, tick_motions_[i]);
    tick_motions_[i] = next;
    positions_[i] = next.to.position_m.cast<float>();
  }
  moved_ |= substeps != substeps_;
  substeps_ = substeps;
  if (features_.obstacles && moved_) interpolateObstacles(obstacles_, tick_motions_, substeps, tick_s, motions_);
  time_s_ += tick_s;
}

Vector3d windAt(const WindConfig& wind, double time_s) {
  return (1 + wind.gust_ratio * std::sin(2 * kPi * time_s / wind.gust_period_s)) * wind.velocity_m_per_s;
}

SubstepEnvironment Environment::at(int substep) const {
  SubstepEnvironment out;
  const double time_s = time_s_ - tick_s_ + (substep + 0.5) * tick_s_ / substeps_;
  out.wind_m_per_s = windAt(wind_, time_s).cast<float>();
  if (features_.obstacles) out.obstacles = &motions_[static_cast<size_t>(substep) * layout::kMaxObstacles];
  return out;
}

void Environment::persist(Archive& archive) {
  archive.value(time_s_);
  archive.values(tick_motions_);
  if (!archive.reads()) return;
  substeps_ = 0;  // the motions of substeps are recomputed
  if (!(time_s_ >= 0 && std::isfinite(time_s_)))
    throw Error("section 'ticks': the time is " + numberText(time_s_) + " s; accepted: 0 s or more");
  const auto lost = [](const Pose& pose) {
    return !pose.position_m.allFinite() || !pose.orientation.coeffs().allFinite();
  };
  for (size_t i = 0; i < tick_motions_.size(); ++i) {
    if (lost(tick_motions_[i].from) || lost(tick_motions_[i].to))
      throw Error("section 'ticks': obstacle " + std::to_string(i) + " has no finite pose; accepted: finite numbers");
  }
}

void Environment::reset() {
  time_s_ = 0;
  tick_motions_ = at_start_;
  substeps_ = 0;
}

float restingSpeed(const Substep& step) {
  constexpr float kSubsteps = 4;  // substeps of fall
  return kSubsteps * step.dt_s * step.gravity.norm();
}

std::vector<layout::vec4> bodyInfluences(const Model& model, const Scene& scene) {
  std::vector<layout::vec4> out;
  for (const Body& body : model.bodies) {
    const Vector3f a = isPushed(body) ? Vector3f((body.force_n / massOf_kg(body)).cast<float>()) : Vector3f::Zero();
    out.push_back({a.x(), a.y(), a.z(), static_cast<float>(collisionDistance(body, scene.collision))});
  }
  return out;
}

Rings joinRings(const Model& model) {
  Rings out;
  out.starts.push_back(0);
  uint32_t springs = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t first = model.slotOffset(b);
    if (hasSurface(body)) appendRings(*body.network, first, springs, out);
    if (body.network) springs += static_cast<uint32_t>(body.network->springs.size());
    out.starts.resize(first + body.lattice.nodes.size() + 1, static_cast<uint32_t>(out.triangles.size()));
  }
  return out;
}

}  // namespace viscera
