// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Of a session, what is between the jaws of its tools.
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

constexpr double kThinnest_rad = 0.03;  // what has one layer of nodes is pressed as if it were half a millimetre thick

}  // namespace

/// As heedFeeling(): how far tissue slides in jaws is of the state. What recovers pulls as it likes.
void Session::heedPulls(const Frame& frame) {
  if (frame.health.recovering) return;
  for (size_t s = 0; s < limiters_.size(); ++s) tools_.pulled(s, look_.motions[s], -xyz(stats_.impulse[s]) / tick_s());
}

/// Nodes are seen from the pivot: those that are within the reach of the jaws and their mouth are between them. Pressed
/// flat they would have a strain of 1, over the area that their volume has at its thickness.
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
  // Young's modulus times area times arm, where area is volume over thickness, and this the arm times the angle.
  return Between{most_rad - least_rad, stiff_nm / std::max(most_rad - least_rad, kThinnest_rad)};
}

/// What keeps the jaws open: what they hold, or the edge with which blades meet tissue.
double Session::jawMoment_nm(size_t stylus, const Reaction& raw) const {
  const StylusMotion& motion = look_.motions[stylus];
  const ToolKind& kind = kindOf(motion.mode);
  if (!motion.present || !kind.jaws) return 0;
  const StylusConfig& config = styluses()[stylus];
  if (!kind.closes) return tools_.fingers(stylus).moment_nm(kind.jaws(config));
  const double edge_n = raw.force_n.dot(motion.to.orientation * Vector3d::UnitZ());  // against the way to the tips
  return closingMoment_n_m(scissorsOf(config.scissors), motion.opens_to_rad, std::max(edge_n, 0.0));
}

}  // namespace viscera
