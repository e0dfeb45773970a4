// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/session_speed.h"
#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

constexpr double kSoonAtRest_per_s = 100;  // drag [1/s]
constexpr int kFallAsleepTicks = 30;       // half a second

/// Returns a heart without loads, so that it sleeps without a probe.
Scene viewedScene(Backend backend, bool short_form) {
  Scene scene = pigHeartScene(short_form ? 1500 : 10000, 0.2);
  scene.solver.backend = backend;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.bodies[0].material.mass_damping_per_s = kSoonAtRest_per_s;
  return scene;
}

Table viewTable(int nodes) {
  return Table("skin and pictures (640 x 480, 30 Hz) of a heart of " + std::to_string(nodes) + " nodes; work per tick",
               {{"backend"},
                {"tissue"},
                {"wanted"},
                {"tick", "ms"},
                {"mappings", "per tick", 3},
                {"images drawn", "per tick", 3},
                {"handed over", "per tick", 3},
                {"not drawn again", "per tick", 3},
                {"bricks brought over", "per tick", 3}});
}

void addRow(Table& table, const Session& session, const std::string& tissue, Wanted wanted, const SessionSpeed& speed) {
  const double ticks = speed.ticks;
  const auto per_tick = [ticks](uint64_t count) { return Cell(static_cast<double>(count) / ticks); };
  table.add({session.solver().backend(), tissue, nameOf(wanted), speed.tick_s * 1e3, per_tick(speed.work.mappings),
             per_tick(speed.work.renders), per_tick(speed.work.readbacks), per_tick(speed.work.repeats),
             per_tick(speed.work.moved_bricks)});
}

uint64_t work(const ViewCounters& done) {
  return done.mappings + done.renders + done.readbacks + done.moved_bricks;
}

/// Measures a backend. Unseen frames are those between two images at 30 Hz, which kEveryImage draws.
void measureBackend(Report& report, Backend backend, Table& table) {
  report.stage("views, " + nameOf(backend));
  const double seconds = report.isShort() ? 0.2 : 2;
  Session session(viewedScene(backend, report.isShort()), *report.context());
  const Pressing pressing(session);
  const auto moving = [&] { return pressing.now(); };
  for (Wanted wanted : {Wanted::kNothing, Wanted::kSurface, Wanted::kImages, Wanted::kEveryImage}) {
    const SessionSpeed speed = measureSession(session, wanted, seconds, moving);
    addRow(table, session, "probed", wanted, speed);
    if (wanted == Wanted::kNothing)
      report.checkAtMost("views: mappings, images and copies not wanted, " + nameOf(backend),
                         static_cast<double>(work(speed.work)), 0);
  }
  session.reset();
  const auto absent = [] { return StylusSamples{}; };
  for (int t = 0; t < kFallAsleepTicks; ++t) session.step({}, {});
  for (Wanted wanted : {Wanted::kNothing, Wanted::kSurface, Wanted::kEveryImage}) {
    const SessionSpeed speed = measureSession(session, wanted, seconds, absent);
    addRow(table, session, "at rest", wanted, speed);
    if (wanted == Wanted::kEveryImage && backend == Backend::kCpu)
      report.checkAtMost("views: images drawn again of tissue asleep", static_cast<double>(speed.work.renders), 0);
  }
}

}  // namespace

void measureViews(Report& report) {
  Table table = viewTable(report.isShort() ? 1500 : 10000);
  for (Backend backend : {Backend::kCpu, Backend::kGpu}) measureBackend(report, backend, table);
  report.add(table, "views");
}

}  // namespace viscera::bench
