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

/// Returns the velocity of the air with its gusts [m/s]. @param time_s  time since the start [s]
Vector3d windAt(const WindConfig& wind, double time_s);

/// External effects on the tissue in a scene. They decide which passes and buffers there are.
struct EnvironmentFeatures {
  bool wind = false;
  bool forces = false;  ///< some body has a force_n
  bool obstacles = false;
  bool collisions = false;
  bool any() const { return wind || forces || obstacles || collisions; }
};
EnvironmentFeatures environmentOf(const Model& model, const Scene& scene);

/// The environment in one substep.
struct SubstepEnvironment {
  Vector3f wind_m_per_s = Vector3f::Zero();           ///< velocity of the air in the middle of the substep
  const layout::ObstacleMotion* obstacles = nullptr;  ///< motions [kMaxObstacles]; the first obstacleCount() exist
};

/// External effects on the tissue: wind, forces on bodies, obstacles, contacts between nodes (physics.md 8). Host side,
/// the same for every backend: keeps the time and gives substeps the motions of obstacles.
class Environment {
 public:
  Environment(const Model& model, const Scene& scene);

  const EnvironmentFeatures& features() const { return features_; }
  /// Returns whether nodes at rest may be moved: then none may sleep.
  bool keepsAwake() const { return features_.any(); }
  /// Returns whether wind or forces act, as opposed to contacts.
  bool blows() const { return features_.wind || features_.forces; }
  size_t obstacleCount() const { return obstacles_.size(); }

  /// Advances by a tick: at() refers to its substeps.
  /// @param obstacles  motions over the tick, of all obstacles of the scene; empty: they stay where they were last,
  /// initially where they are at time 0
  void beginTick(double tick_s, int substeps, const ObstacleMotions& obstacles);
  SubstepEnvironment at(int substep) const;
  const std::vector<layout::ObstacleMotion>& obstacleMotions() const {
    return motions_;
  }                                               ///< [substeps * kMaxObstacles]
  bool obstaclesMoved() const { return moved_; }  ///< obstacleMotions() differ from those of the previous tick
  /// Returns [obstacles] positions at the end of the tick, tissue frame [m].
  const std::vector<Vector3f>& obstaclePositions() const { return positions_; }
  const ObstacleMotions& motions() const { return tick_motions_; }  ///< motions of the obstacles over the tick
  void reset();                                                     ///< back to time 0
  void persist(Archive& archive);

 private:
  EnvironmentFeatures features_;
  WindConfig wind_;
  std::vector<ObstacleConfig> obstacles_;
  ObstacleMotions at_start_, tick_motions_;  ///< motions at time 0; over the tick
  std::vector<layout::ObstacleMotion> motions_;
  std::vector<Vector3f> positions_;
  double time_s_ = 0, tick_s_ = 0;
  int substeps_ = 0;
  bool moved_ = true;
};

/// Returns the speed below which an impact on an obstacle or another node does not bounce, or gravity would keep it
/// bouncing [m/s].
float restingSpeed(const Substep& step);

/// Returns [bodies] xyz acceleration by force_n [m/s2]; w distance that the body's nodes keep from others [m].
std::vector<layout::vec4> bodyInfluences(const Model& model, const Scene& scene);

/// Ring triangles of every node with a surface, numbered over all bodies.
struct Rings {
  std::vector<uint32_t> starts;  ///< [slots + 1]
  std::vector<layout::WindTriangle> triangles;
};
Rings joinRings(const Model& model);

}  // namespace viscera
