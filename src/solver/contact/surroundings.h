// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "layout/wind.h"
#include "solver/tissue/substep.h"
#include "viscera/model/model.h"
#include "viscera/tools/obstacles.h"

namespace viscera {

struct Scene;

class Archive;

/// Velocity of the air with its gusts [m/s]. @param time_s  since the start
Vector3d windAt(const WindConfig& wind, double time_s);

/// What acts on the tissue from outside in a scene, and so which passes and buffers there are.
struct SurroundingsFeatures {
  bool wind = false;
  bool forces = false;  ///< some body has a force_n
  bool obstacles = false;
  bool collisions = false;
  bool any() const { return wind || forces || obstacles || collisions; }
};
SurroundingsFeatures surroundingsOf(const Model& model, const Scene& scene);

/// The surroundings in one substep.
struct SubstepSurroundings {
  Vector3f wind_m_per_s = Vector3f::Zero();           ///< in the middle of the substep
  const layout::ObstacleMotion* obstacles = nullptr;  ///< [kMaxObstacles] of which obstacleCount() are there
};

/// What acts on the tissue from outside: wind, forces on bodies, obstacles, contacts between nodes (physics.md 8).
/// Host side, the same for every backend: keeps the time, tells substeps where the obstacles are.
class Surroundings {
 public:
  Surroundings(const Model& model, const Scene& scene);

  const SurroundingsFeatures& features() const { return features_; }
  /// May nodes be moved that are at rest? Then none may sleep.
  bool keepsAwake() const { return features_.any(); }
  /// Does something blow or push at nodes, rather than meet them?
  bool blows() const { return features_.wind || features_.forces; }
  size_t obstacleCount() const { return obstacles_.size(); }

  /// Goes on by a tick: at() is about its substeps.
  /// @param obstacles  over the tick, all of the scene's; empty: they stand where they were last, at first where they
  /// are at time 0
  void beginTick(double tick_s, int substeps, const ObstacleMotions& obstacles);
  SubstepSurroundings at(int substep) const;
  const std::vector<layout::ObstacleMotion>& obstacleMotions() const {
    return motions_;
  }                                               ///< [substeps * kMaxObstacles]
  bool obstaclesMoved() const { return moved_; }  ///< obstacleMotions() is not that of the tick before
  /// [obstacles] at the end of the tick, tissue frame [m]
  const std::vector<Vector3f>& obstaclePlaces() const { return places_; }
  const ObstacleMotions& motions() const { return tick_motions_; }  ///< of the obstacles, over the tick
  void reset();                                                     ///< time 0
  void persist(Archive& archive);

 private:
  SurroundingsFeatures features_;
  WindConfig wind_;
  std::vector<ObstacleConfig> obstacles_;
  ObstacleMotions at_start_, tick_motions_;  ///< at time 0; over the tick
  std::vector<layout::ObstacleMotion> motions_;
  std::vector<Vector3f> places_;
  double time_s_ = 0, tick_s_ = 0;
  int substeps_ = 0;
  bool moved_ = true;
};

/// What comes slower than this at an obstacle or another node does not bounce, or gravity would keep it bouncing [m/s].
float restingSpeed(const Substep& step);

/// [bodies] xyz acceleration that force_n gives [m/s2]; w distance that its nodes keep from others [m].
std::vector<layout::vec4> bodyInfluences(const Model& model, const Scene& scene);

/// Ring triangles of every node with a surface, numbered over all bodies.
struct Rings {
  std::vector<uint32_t> starts;  ///< [slots + 1]
  std::vector<layout::WindTriangle> triangles;
};
Rings joinRings(const Model& model);

}  // namespace viscera
