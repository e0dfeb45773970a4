// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/haptic_options.h"

#include <algorithm>

#include "viscera/model/scene/scene.h"

namespace viscera::nodes {
namespace {

/// Returns constants that are valid for every body, since the body that a stylus will touch is not known.
TissueConstants tissueOf(const Scene& scene, const StylusConfig& stylus) {
  std::vector<double> moduli_pa;
  for (const BodyConfig& body : scene.bodies) {
    moduli_pa.push_back(body.material.young_modulus_pa);
    for (const PartConfig& part : body.parts) moduli_pa.push_back(part.young_modulus_pa);
  }
  TissueConstants out;
  out.tip_radius_m = stylus.probe.radius_m;
  if (moduli_pa.empty()) return out;
  out.softest_pa = *std::min_element(moduli_pa.begin(), moduli_pa.end());
  out.stiffest_pa = *std::max_element(moduli_pa.begin(), moduli_pa.end());
  out.poisson_ratio = scene.bodies[0].material.poisson_ratio;
  return out;
}

}  // namespace

std::vector<ForceLoop::Stylus> forceStyluses(const HapticOptions& options, const Scene& scene,
                                             const std::vector<const StylusMailbox*>& mailboxes) {
  std::vector<ForceLoop::Stylus> out;
  for (const StylusMailbox* mailbox : mailboxes) {
    const DeviceProfile& device = mailbox->device();
    ForceLoop::Stylus stylus{ForceLimits::of(mailbox->config()), {}};
    if (options.rate_hz > 0) stylus.servo.period_s = 1 / options.rate_hz;
    stylus.servo.tick_s = 1 / scene.solver.tick_hz;
    stylus.servo.round_trip_s = device.delay_s > 0 ? device.delay_s : options.delay_s;
    stylus.servo.motion_scale = device.scale;
    stylus.servo.force_scale = device.force.scale;
    stylus.servo.tissue = tissueOf(scene, mailbox->config());
    out.push_back(stylus);
  }
  return out;
}

}  // namespace viscera::nodes
