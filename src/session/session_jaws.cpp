// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tissue between the jaws of a session's tools.
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec4.h"
#include "model/body/body_nodes.h"
#include "model/scene/tool_kinds.h"
#include "tools/scissors_edge.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

// Tissue with one layer of nodes is pressed as if it were half a millimetre thick.
constexpr double kThinnest_rad = 0.03;

}  // namespace

/// Lets tissue slide in jaws, with a wait as in detectInside(): the slip is part of the state. Forces during a recovery
/// are ignored.
void Session::applyGripSlip(const Frame& frame) {
  if (frame.health.recovering) return;
  for (size_t s = 0; s < limiters_.size(); ++s)
    tools_.pulled(s, request_.motions[s], -xyz(stats_.impulse[s]) / tick_s());
}

/// Finds the nodes within the reach of the jaws and their opening, as seen from the pivot. Pressed flat they would have
/// a strain of 1, over the area given by their volume at its thickness.
std::optional<Between> Session::between(size_t stylus, const StylusMotion& motion, double mouth_rad) const {
  const ToolKind& kind = kindOf(motion.mode);
  const Jaws jaws = kind.jaws(styluses()[stylus]);
  const double reach_m = kind.reach_m(styluses()[stylus]);
  const HostState state = solver_->readState();
  const Pose to_jaws = motion.from.inverse();
  double least_rad = std::numeric_limits<double>::infinity(), most_rad = -least_rad;
  double stiff_nm = 0;
  for (uint32_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const double of_node_m3 = std::pow(body.lattice.spacing_m, 3);
    forEachNode(body, [&](uint32_t slot) {
      const Vector3d at =
          to_jaws * (restPosition(body, slot) + xyz(state.displacement_m[model_->slotOffset(b) + slot]));
      const double angle_rad = std::atan2(at.x(), jaws.length_m - at.z());
      if (at.norm() > reach_m || std::abs(angle_rad) > 0.5 * mouth_rad) return;
      least_rad = std::min(least_rad, angle_rad);
      most_rad = std::max(most_rad, angle_rad);
      stiff_nm += scene_.bodies[b].material.young_modulus_pa * of_node_m3;
    });
  }
  if (stiff_nm == 0) return std::nullopt;
  // Young's modulus times area times arm; area is volume over thickness, and thickness is the arm times the angle.
  return Between{most_rad - least_rad, stiff_nm / std::max(most_rad - least_rad, kThinnest_rad)};
}

/// Returns the moment that keeps the jaws open: of the tissue that they hold, or of the edge of blades in tissue.
double Session::jawMoment_nm(size_t stylus, const Reaction& raw) const {
  const StylusMotion& motion = request_.motions[stylus];
  const ToolKind& kind = kindOf(motion.mode);
  if (!motion.present || !kind.jaws) return 0;
  const StylusConfig& config = styluses()[stylus];
  if (!kind.closes) return tools_.fingers(stylus).moment_nm(kind.jaws(config));
  // Against the direction to the tips.
  const double edge_n = raw.force_n.dot(motion.to.orientation * Vector3d::UnitZ());
  return closingMoment_n_m(scissorsOf(config.scissors), motion.opens_to_rad, std::max(edge_n, 0.0));
}

}  // namespace viscera
