// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/integrator_choice.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "math/number_text.h"
#include "math/vec4.h"
#include "model/fracture/tearing.h"
#include "model/fracture/toughness.h"
#include "model/scene/integrators.h"
#include "model/scene/tool_kinds.h"
#include "solver/cpu/cpu_solver.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTicks = 8;              // of each: the first ones of a fall, in which multigrid has most to solve
constexpr double kLongEnough_s = 1.5;  // of wall time, when some ticks are done
constexpr int kUntouched = 3;          // ticks, before a probe is pressed in where the scene has styluses
constexpr size_t kFewest = 3;          // ticks of either kind, whatever they take
constexpr double kPress = 0.25;        // of the spacing, a tick
constexpr double kMustGain = 0.9;      // of leapfrog's time: at less gain its smaller error decides

/// Where a probe goes into the tissue: from above at the highest node that may move.
struct Press {
  uint32_t slot;
  Vector3d rest_m;
  double radius_m, spacing_m;
  Vector3d over(const Vector3d& u_m) const { return rest_m + u_m + Vector3d(0, 0, radius_m); }
};
std::optional<Press> pressOf(const Model& model, const Scene& scene) {
  std::optional<Press> out;
  if (scene.styluses.empty()) return out;
  const Lattice& lattice = model.bodies[0].lattice;
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d rest_m = lattice.restPosition(slot);
    if (!isFixed(lattice.nodes[slot]) && (!out || rest_m.z() > out->rest_m.z()))
      out = Press{slot, rest_m, scene.styluses[0].probe.radius_m, lattice.spacing_m};
  }
  return out;
}

/// A solver whose ticks are timed.
class Trial {
 public:
  Trial(const Model& model, Scene scene, Integrator integrator, const std::shared_ptr<ThreadPool>& threads) {
    scene.solver.integrator = integrator;
    if (scene.environment.gravity_m_per_s2.isZero()) scene.environment.gravity_m_per_s2 = {0, 0, -9.81};
    CpuSolverOptions options;
    options.threads = threads;
    solver_ = std::make_unique<CpuSolver>(model, scene, options);
  }
  /// @param press  a probe is pressed into the tissue, farther in every tick
  void step(const std::optional<Press>& press) {
    ToolMotions motions;
    if (press && !tip_m_) tip_m_ = press->over(xyz(solver_->readState().displacement_m[press->slot]));
    if (press) {
      motions[0].mode = ToolMode::kProbe;
      motions[0].present = true;
      motions[0].from.position_m = *tip_m_;
      tip_m_->z() -= kPress * press->spacing_m;
      motions[0].to.position_m = *tip_m_;
    }
    const Clock::time_point start = Clock::now();
    solver_->step(motions);
    (press ? touched_s_ : free_s_).push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  /// What a tick takes, half of them with a probe in the tissue where there are some.
  double tick_s() {
    const double free_s = middle(free_s_);
    return touched_s_.empty() ? free_s : (free_s + middle(touched_s_)) / 2;
  }
  size_t ticks() const { return free_s_.size() + touched_s_.size(); }

 private:
  static double middle(std::vector<double>& all) {
    std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
    return all[all.size() / 2];
  }
  std::unique_ptr<Ticks> solver_;
  std::optional<Vector3d> tip_m_;
  std::vector<double> free_s_, touched_s_;
};

/// Why multigrid has no steps for the scene; empty: it has.
std::string missing(const Model& model, const Scene& scene, Backend backend) {
  if (backend != Backend::kCpu) return "multigrid is chosen on the CPU backend alone";
  if (model.hasNetwork()) return "multigrid steps implicit lattices, not bodies with explicit connections";
  if (resistsBlades(scene)) return "multigrid knows no blades that tissue resists (material.cut)";
  if (tears(scene)) return "multigrid knows no tissue that tears (material.tear)";
  if (std::any_of(scene.threads.begin(), scene.threads.end(), [](const ThreadConfig& t) { return t.feelsTissue(); }))
    return "multigrid knows no threads through tissue (threads[].channels, threads[].needle)";
  if (mayClip(scene.styluses)) return "multigrid knows no clips";
  if (mayBurn(scene.styluses)) return "multigrid knows no cautery";
  if (scene.collision.enabled) return "multigrid knows no contacts between nodes";
  return "";
}

std::string compared(const char* chosen, double multigrid_s, double leapfrog_s) {
  constexpr double kMilli = 1e3;
  return std::string(chosen) + ", as a tick takes " + numberText(kMilli * multigrid_s, 3) + " ms with multigrid, " +
         numberText(kMilli * leapfrog_s, 3) + " ms with leapfrog";
}

}  // namespace

IntegratorChoice chooseIntegrator(const Model& model, const Scene& scene, Backend backend,
                                  const std::shared_ptr<ThreadPool>& threads) {
  const std::string why_not = missing(model, scene, backend);
  if (!why_not.empty()) return {Integrator::kLeapfrog, "leapfrog, as " + why_not};
  std::optional<Trial> leapfrog;
  try {
    leapfrog.emplace(model, scene, Integrator::kLeapfrog, threads);
  } catch (const SceneError& error) {  // too many substeps, or given ones that are too long
    return {Integrator::kMultigrid, std::string("multigrid, as leapfrog cannot step this: ") + error.what()};
  }
  Trial multigrid(model, scene, Integrator::kMultigrid, threads);
  const std::optional<Press> press = pressOf(model, scene);
  const size_t fewest = press ? 2 * kFewest : kFewest;
  const Clock::time_point start = Clock::now();
  while (leapfrog->ticks() < kTicks) {
    const bool touched = press && leapfrog->ticks() >= kUntouched;
    leapfrog->step(touched ? press : std::nullopt);
    multigrid.step(touched ? press : std::nullopt);
    const double so_far_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (leapfrog->ticks() >= fewest && so_far_s > kLongEnough_s) break;
  }
  const double implicit_s = multigrid.tick_s(), explicit_s = leapfrog->tick_s();
  if (implicit_s < kMustGain * explicit_s)
    return {Integrator::kMultigrid, compared("multigrid", implicit_s, explicit_s)};
  return {Integrator::kLeapfrog, compared("leapfrog", implicit_s, explicit_s)};
}

std::string thinProbeNote(const Model& model, const Scene& scene, Integrator integrator) {
  if (integrator == Integrator::kLeapfrog) return "";
  double spacing_m = 0;
  for (const Body& body : model.bodies)
    spacing_m = std::max(spacing_m, body.network ? body.network->meanLength() : body.lattice.spacing_m);
  for (const StylusConfig& stylus : scene.styluses) {
    if (!mayPush(stylus) || stylus.probe.radius_m >= spacing_m) continue;
    return std::string(traitsOf(integrator).name) + "'s probes meet nodes alone, and probe.radius_m of '" +
           stylus.name + "', " + numberText(stylus.probe.radius_m, 3) + " m, is less than a spacing, " +
           numberText(spacing_m, 3) + " m";
  }
  return "";
}

}  // namespace viscera
