// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/environment_pass.h"

#include "layout/bindings.h"
#include "layout/wind.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

EnvironmentPass::EnvironmentPass(const Model& model, const Scene& scene, const FeatureSet& features,
                                 const LatticeBuffers& buffers)
    : kinds_(environmentOf(model, scene)),
      wind_(scene.environment.wind),
      influences_(layout::kMaxBodies),
      group_size_(features.group_size),
      tools_(features.tools) {
  const auto compile = [&](std::vector<const char*> kinds) {
    std::vector<std::string> defines = features.defines();
    defines.insert(defines.end(), kinds.begin(), kinds.end());
    if (features.tools) defines.push_back("TOOLS");
    return gpu::Program::compute("environment.comp", defines);
  };
  std::vector<const char*> all, blowing = {"BEFORE"};
  if (kinds_.wind) all.push_back("WIND");
  if (kinds_.forces) all.push_back("BODY_FORCES");
  blowing.insert(blowing.end(), all.begin(), all.end());
  if (kinds_.obstacles) all.push_back("OBSTACLES");
  if (kinds_.collisions) all.push_back("COLLISIONS");
  program_ = compile(all);
  if (blowing.size() > 1) blow_ = compile(blowing);
  if (kinds_.collisions) collide_ = compile({"COLLISIONS"});
  influences_.write(bodyInfluences(model, scene));
  if (kinds_.wind) {
    const Rings rings = joinRings(model);
    ring_starts_ = gpu::Buffer<uint32_t>(rings.starts, "ring starts");
    rings_ = gpu::Buffer<layout::WindTriangle>(rings.triangles, "rings");
  }
  if (kinds_.collisions) collisions_.emplace(model, scene, features, buffers);
}

void EnvironmentPass::beginTick(const Environment& environment) {
  influences_.bindUniform(layout::kBindBodyInfluences);
  if (kinds_.wind) {
    ring_starts_.bindStorage(layout::kBindWindStarts);
    rings_.bindStorage(layout::kBindWindTriangles);
  }
  if (collisions_) collisions_->bind();
  if (!kinds_.obstacles) return;
  const std::vector<layout::ObstacleMotion>& motions = environment.obstacleMotions();
  if (motions.size() > obstacles_.size()) {
    obstacles_ = gpu::Buffer<layout::ObstacleMotion>(motions, "obstacles");
  } else if (environment.obstaclesMoved()) {
    obstacles_.write(motions);
  }
}

void EnvironmentPass::bindObstacles(const Substep& step) const {
  if (!kinds_.obstacles) return;
  obstacles_.bindUniform(layout::kBindObstacles, static_cast<size_t>(step.index) * layout::kMaxObstacles,
                         layout::kMaxObstacles);
}

void EnvironmentPass::apply(const gpu::Program& program, LatticeBuffers& buffers, const Substep& step,
                            const Environment& environment) const {
  const SubstepEnvironment now = environment.at(step.index);
  program.use();
  program.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  program.set("dt_s", step.dt_s);
  program.set("push_speed", step.push_speed_m_per_s);
  program.set("sleep_distance_m", step.sleep_distance_m);
  program.set("resting_speed", step.resting_speed_m_per_s);
  program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  program.set("obstacle_count", step.obstacle_count);
  const float air = 0.5f * static_cast<float>(wind_.air_density_kg_per_m3 * wind_.drag_coefficient);
  program.set("air", {now.wind_m_per_s.x(), now.wind_m_per_s.y(), now.wind_m_per_s.z(), air});
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
  buffers.swap();
}

void EnvironmentPass::blow(LatticeBuffers& buffers, const Substep& step, const Environment& environment) const {
  apply(blow_, buffers, step, environment);
}

void EnvironmentPass::run(LatticeBuffers& buffers, const Substep& step, const Environment& environment) {
  if (collisions_) collisions_->run(buffers, step);
  bindObstacles(step);
  apply(step.implicit ? collide_ : program_, buffers, step, environment);
}

void EnvironmentPass::restart() {
  if (collisions_) collisions_->restart();
}

void EnvironmentPass::recordCrowded(const gpu::Buffer<layout::TickStats>& stats) const {
  if (collisions_) collisions_->recordCrowded(stats);
}

std::vector<CollisionPair> EnvironmentPass::findPairs(const LatticeBuffers& buffers) const {
  influences_.bindUniform(layout::kBindBodyInfluences);
  return collisions_->findPairs(buffers);
}

}  // namespace viscera
