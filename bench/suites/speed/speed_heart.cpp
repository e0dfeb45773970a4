// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bench/harness/rate.h"
#include "bench/harness/session_speed.h"
#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

constexpr int kNodes = 42745;  // number of nodes of VR05's pig heart
constexpr double kWanted_per_s = 7000;
constexpr double kTouchedApart = 0.1;  // relative to the GPU's: nodes at the rim of the contact come and go
constexpr double kDepth_m = 0.003;
constexpr int kSagTicks = 60, kPressTicks = 60;  // a second each

/// Returns a scene in which tissue never sleeps, as if it were being worked on.
Scene awakeScene(int nodes, double stiffness_damping_ratio) {
  Scene scene = pigHeartScene(nodes, stiffness_damping_ratio);
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

/// A sagging heart, and a probe that was pressed into it slowly.
struct PressedHeart {
  Specimen heart;  ///< initial state is pressed
  Vector3d tip_m;
};

/// Presses the probe in. @return position of its tip
Vector3d pressIn(TissueStepper& solver, const Specimen& heart) {
  for (int t = 0; t < kSagTicks; ++t) solver.step({});
  const Vector3d touching_m = farthestNode(heart.model, solver.readState(), Vector3d::UnitX()) +
                              heart.scene.styluses[0].probe.radius_m * Vector3d::UnitX();
  ToolMotions motions = probeAt(touching_m);
  for (int t = 1; t <= kPressTicks; ++t) {
    motions[0].from = motions[0].to;
    motions[0].to.position_m = touching_m - kDepth_m * t / kPressTicks * Vector3d::UnitX();
    solver.step(motions);
  }
  return motions[0].to.position_m;
}

PressedHeart pressedHeart(int nodes, double stiffness_damping_ratio) {
  Specimen heart{"heart", {}, awakeScene(nodes, stiffness_damping_ratio), {}};
  heart.model = buildModel(heart.scene);
  heart.start = restState(heart.model);
  const std::shared_ptr<TissueStepper> solver = onCpu(heart);
  const Vector3d tip_m = pressIn(*solver, heart);
  heart.start = solver->readState();
  return {std::move(heart), tip_m};
}

/// Ticks of a pressed heart, and the result of the last one.
struct Pressed {
  std::string name;
  std::shared_ptr<TissueStepper> solver;
  uint32_t touched = 0;

  Candidate candidateFor(const PressedHeart& pressed) {
    return {name, static_cast<double>(pressed.heart.nodes()), [this, motions = probeAt(pressed.tip_m)] {
              const uint64_t before = solver->substepsDone();
              layout::TickStats stats;
              solver->step(motions);
              while (solver->pollStats(stats, true)) touched = stats.touched[0];
              return static_cast<double>(solver->substepsDone() - before);
            }};
  }
};

Table pressedTable() {
  return Table(
      "hollow heart of VR05's size as a session has it (gravity, stability monitor, fixed top), all awake, simulation "
      "only, one probe pressed in; VR05: 188 steps/s",
      {{"nodes", "", 8},
       {"filled share of box", "", 2},
       {"dashpot"},
       {"way"},
       {"rate", "substeps/s"},
       {"real-time factor", "", 3},
       {"spread", "", 2},
       {"nodes touched"},
       {"stability monitor trips"}});
}

}  // namespace

void measurePressedHeart(Report& report) {
  Table table = pressedTable();
  for (double dashpot : {0.0, 0.2}) {
    report.stage("heart with a probe, dashpot " + Cell(dashpot).text(2));
    const PressedHeart pressed = pressedHeart(report.isShort() ? 5000 : kNodes, dashpot);
    const Specimen& heart = pressed.heart;
    Pressed variants[] = {{"cpu", onCpu(heart)}, {"gpu", onGpu(heart)}};
    const std::vector<Rate> rates = measureRates({variants[0].candidateFor(pressed), variants[1].candidateFor(pressed)},
                                                 report.isShort() ? 0.02 : 0.5);
    for (size_t w = 0; w < 2; ++w) {
      table.add({static_cast<double>(heart.nodes()), filledShare(heart.model), dashpot, variants[w].name,
                 rates[w].substeps_per_s, rates[w].substeps_per_s * variants[w].solver->dt_s(), rates[w].spread,
                 static_cast<double>(variants[w].touched), static_cast<double>(variants[w].solver->health().trips)});
    }
    if (dashpot > 0) continue;
    report.checkAtLeast("heart with a probe: substeps/s, cpu", rates[0].substeps_per_s, kWanted_per_s);
    report.checkAtMost("heart with a probe: nodes touched, cpu over gpu - 1",
                       static_cast<double>(variants[0].touched) / variants[1].touched - 1, kTouchedApart);
  }
  report.add(table, "heart");
}

void measureHeartSessions(Report& report) {
  Table table("the same heart in a session, a probe moving in it, pictures of 640 x 480 at 30 Hz",
              {{"backend"}, {"wanted"}, {"ticks"}, {"tick", "ms"}, {"real-time factor", "", 3}, {"images"}});
  for (Backend backend : {Backend::kCpu, Backend::kGpu}) {
    Scene scene = pigHeartScene(report.isShort() ? 3000 : kNodes, 0.2);
    scene.solver.backend = backend;
    report.stage("sessions, " + nameOf(backend));
    Session session(scene, *report.context());
    const Pressing pressing(session);
    for (Wanted wanted : {Wanted::kNothing, Wanted::kSurface, Wanted::kSurfaceAndImages}) {
      const SessionSpeed speed =
          measureSession(session, wanted, report.isShort() ? 0.2 : 3, [&] { return pressing.now(); });
      table.add({session.solver().backend(), nameOf(wanted), speed.ticks, speed.tick_s * 1e3,
                 session.tick_s() / speed.tick_s, static_cast<double>(speed.work.renders)});
    }
  }
  report.add(table, "sessions");
}

}  // namespace viscera::bench
