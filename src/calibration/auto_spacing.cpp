// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/calibration/auto_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "math/processors.h"
#include "model/scene/integrators.h"
#include "solver/make_solver.h"
#include "solver/ticks/stable_step.h"
#include "solver/tissue/substeps.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"
#include "viscera/solver/stability_monitor.h"

namespace viscera {
namespace {

/// Share of the clock that steps may take. Tools, measurements and hand-over of the surface take the rest of a tick.
constexpr double kShareOfSteps = 0.8;
// Load next to a software rasteriser, in processors:
constexpr double kPictures = 0.7;   ///< 10 pictures a second of kPixels (`viscera bench picture`)
constexpr double kViewer = 0.5;     ///< rviz, which draws its own images by the same rasteriser
constexpr double kPixels = 307200;  ///< 640 x 480
constexpr double kLeastShare = 0.25;
/// Nodes of the lattice from which the stable substep is taken; it is in proportion to the spacing.
constexpr size_t kRuleNodes = 4000;

/// Number of substeps that the solver will have, by spacing.
class SubstepRule {
 public:
  SubstepRule(const UndividedBodies& bodies, const Model& others, const Scene& scene, const gpu::Context* context)
      : config_(scene.solver), others_(safeTimeStep(others)) {
    spacing_m_ = bodies.spacingOf(kRuleNodes);
    sample_ = bodies.lattices(spacing_m_);
    per_m_ = Stable(safeTimeStep(sample_) / spacing_m_);
    config_.max_substeps = std::numeric_limits<int>::max();
    if (!measuresLimit(sample_, config_) || !measuresLimit(others, config_)) return;
    per_m_.limit_s = limitOf(sample_, scene, context) / spacing_m_;
    others_.limit_s = others.bodies.empty() ? others_.limit_s : limitOf(others, scene, context);
  }

  double sampleSpacing_m() const { return spacing_m_; }

  /// Returns substeps per second while the tissue is strained, as it is when a tool touches it. For measured substeps,
  /// of tissue with the stretch that they are planned for.
  double perSecond(double spacing_m) const {
    const double most = mostPerSecond(spacing_m);
    const double dt_safe_s = std::min(per_m_.safe_s * spacing_m, others_.safe_s);
    const double limit_s = std::min(per_m_.limit_s * spacing_m, others_.limit_s);
    if (!std::isfinite(limit_s)) return most;
    const double dt_s = measuredSubstep_s(config_, largestDashpot(sample_), dt_safe_s, limit_s, kStrainedStretch);
    return std::min(most, config_.tick_hz * std::ceil(1 / (config_.tick_hz * dt_s)));
  }

  /// Returns the finest spacing that the solver accepts, by max_substeps, or by given substeps that must be stable.
  double finest_m(const SolverConfig& asked) const {
    constexpr double kClear = 1 + 1e-6;
    if (asked.substeps == 0) {
      const double fine_m = 1e-2 * spacing_m_;  // with so many substeps, rounding up to whole ones is negligible
      return fine_m * mostPerSecond(fine_m) / (asked.tick_hz * asked.max_substeps);
    }
    const double xi = largestDashpot(sample_);
    return kClear / (asked.tick_hz * asked.substeps * stableFraction(asked.integrator, xi) * per_m_.safe_s);
  }

 private:
  /// Longest stable substeps: proven, and measured (infinite where not measured).
  struct Stable {
    explicit Stable(double safe) : safe_s(safe) {}
    double safe_s, limit_s = std::numeric_limits<double>::infinity();
  };

  double limitOf(const Model& model, Scene scene, const gpu::Context* context) const {
    scene.solver = config_;
    scene.solver.start = SolverStart::kRest;
    scene.attachments.clear();                                 // the model has not all of their bodies
    for (BodyConfig& body : scene.bodies) body.pressure = {};  // nor the surfaces of cavities
    return makeSolver(model, scene, context)->dtLimit_s();
  }
  double mostPerSecond(double spacing_m) const {
    const double dt_safe_s = std::min(per_m_.safe_s * spacing_m, others_.safe_s);
    const SubstepPlan plan = planSubsteps(sample_, config_, dt_safe_s, true);
    return config_.tick_hz * std::max(plan.calm, plan.strained);
  }

  SolverConfig config_;
  Stable others_, per_m_{0};
  double spacing_m_;
  Model sample_;
};

std::string reason(const SpacingChoice& choice) {
  switch (choice.bound) {
    case SpacingBound::kSpeed:
      return "the finest that leaves time for everything else";
    case SpacingBound::kNodes:
      return "more nodes would take too long to prepare, although the machine could step them";
    case SpacingBound::kSolver:
      return "the finest that solver.max_substeps or solver.substeps allows, although the machine could step more";
    case SpacingBound::kMemory:
      return "the finest that fits in memory, although the machine could step more";
    case SpacingBound::kTooSlow:
      return "as coarse as tissue can be, but this machine is still too slow for it";
    case SpacingBound::kWalls:
      return "as coarse as the thinnest wall allows without holes, but this machine is too slow for it; thicker walls "
             "(phantom_wall_scale) allow coarser ones";
  }
  return "";
}

std::string noteOf(const SpacingChoice& choice, const StepTime& step, const Scene& scene, double share) {
  const double nodes = static_cast<double>(choice.nodes);
  TextOut out;
  out.precision(3);
  out << "spacing_m: auto: " << choice.spacing_m << " m, " << choice.nodes << " nodes, at most "
      << std::lround(choice.substeps_per_s) << " substeps per second; this machine steps "
      << nodes / step.of(nodes) * 1e-6 << " M nodes/s in " << share * 100 << " % of its time, real-time factor "
      << scene.solver.real_time_factor / std::max(choice.load, 1e-9) << " of " << scene.solver.real_time_factor
      << " wanted: " << reason(choice);
  return out.str();
}

}  // namespace

double shareOfSteps(const Scene& scene, bool software, unsigned processors) {
  if (!software || scene.cameras.empty()) return kShareOfSteps;
  double pixels = 0;
  for (const CameraConfig& camera : scene.cameras) pixels += static_cast<double>(camera.width_px) * camera.height_px;
  const double others = kPictures * pixels / kPixels + kViewer;
  return std::clamp(1 - others / std::max(processors, 1U), kLeastShare, kShareOfSteps);
}

Scene withChosenSpacing(const Scene& asked, const gpu::Context* context, const Progress& progress,
                        const std::optional<StepTime>& known) {
  const std::vector<size_t> chosen = autoBodies(asked);
  if (chosen.empty()) return asked;
  Scene scene = asked;
  if (progress) progress("measure this machine", 0);
  const UndividedBodies bodies(scene);
  const Model others = bodies.others();
  const SubstepRule rule(bodies, others, scene, context);
  SpacingLimits limits;
  limits.step = known ? *known : measureStepTime(bodies, scene, context);
  if (progress) progress("measure this machine", 1);
  const double share =
      shareOfSteps(scene, context != nullptr && context->isSoftware(), static_cast<unsigned>(usableProcessors()));
  limits.stepping_share = share / scene.solver.real_time_factor;
  limits.substeps_per_s = [&rule](double spacing_m) { return rule.perSecond(spacing_m); };
  limits.other_nodes = others.activeNodes();
  limits.whole_m = bodies.wholeEdge_m();
  limits.finest_m = rule.finest_m(scene.solver);
  limits.coarsest_m = bodies.thinnestWall_m();
  const SpacingChoice choice =
      chooseSpacing([&](double h) { return bodies.nodes(h); }, rule.sampleSpacing_m(), limits, progress);
  Scene out = asked;
  for (const size_t b : chosen) {
    out.bodies[b].auto_spacing = false;
    out.bodies[b].spacing_m = choice.spacing_m;
  }
  out.bodies[chosen[0]].spacing_note = noteOf(choice, limits.step, scene, share);
  return out;
}

}  // namespace viscera
