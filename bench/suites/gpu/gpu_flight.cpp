// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/session_speed.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

struct Way {
  const char* name;
  Wanted wanted;
  bool waits;
};
constexpr Way kWays[] = {{"nothing", Wanted::kNothing, false},
                         {"skin and image, in flight", Wanted::kSurfaceAndImages, false},
                         {"nothing, every tick waited for", Wanted::kNothing, true},
                         {"skin and image, every tick waited for", Wanted::kSurfaceAndImages, true}};

/// A session whose skin and whose one picture may be asked for after every tick.
Scene viewedHeart(int nodes) {
  Scene scene = pigHeartScene(nodes, 0.2);
  scene.solver.backend = Backend::kGpu;
  scene.cameras[0].rate_hz = scene.solver.tick_hz;
  return scene;
}

}  // namespace

void measureFlight(Report& report) {
  const int nodes = report.isShort() ? 1500 : 42745;
  report.stage("read-back: building");
  Session session(viewedHeart(nodes), *report.context());
  const Pressing pressing(session);
  Table table(
      "read-back of a heart of " + std::to_string(nodes) + " nodes, 60 ticks/s of simulated time, as fast as it goes",
      {{"read back after each tick"}, {"tick", "ms", 3}, {"read back", "per tick", 3}, {"overtaken", "per tick", 3}});
  for (const Way& way : kWays) {
    report.stage(std::string("read-back: ") + way.name);
    const auto samples = [&] {
      if (way.waits) session.drain();
      return pressing.now();
    };
    const SessionSpeed speed = measureSession(session, way.wanted, report.isShort() ? 0.2 : 3, samples);
    const double ticks = speed.ticks;
    table.add({way.name, 1e3 * speed.tick_s, static_cast<double>(speed.work.readbacks) / ticks,
               static_cast<double>(speed.work.skipped) / ticks});
  }
  report.add(table, "flight");
}

void measureLive(Report& report) {
  constexpr int kMillion = 1000000, kFew = 3000, kOnSoftware = 10000;
  const int nodes = report.isShort() ? kFew : report.context()->isSoftware() ? kOnSoftware : kMillion;
  Scene scene = viewedHeart(nodes);
  scene.bodies[0].material.cells = Cells::kAuto;  // as scenes have it
  scene.solver.sleep_speed_m_per_s = 0;           // what comes to rest is measured like what moves
  report.stage("live: building");
  Session session(scene, *report.context());
  Table table("a heart of 10 cm, E " + Cell(1e-3 * scene.bodies[0].material.young_modulus_pa).text(3) +
                  " kPa, with its skin and 60 pictures of 640 x 480 a second",
              {{"nodes", "", 8},
               {"faces", "", 8},
               {"substeps", "per tick"},
               {"read back"},
               {"tick", "ms", 3},
               {"of real time", "", 3},
               {"overtaken", "per tick", 3}});
  for (const Wanted wanted : {Wanted::kNothing, Wanted::kSurfaceAndImages}) {
    report.stage("live: wanted: " + nameOf(wanted));
    const SessionSpeed speed =
        measureSession(session, wanted, report.isShort() ? 0.2 : 5, [] { return StylusSamples{}; });
    table.add({static_cast<double>(session.model().activeNodes()), static_cast<double>(session.model().skinTriangles()),
               static_cast<double>(session.solver().substeps()), nameOf(wanted), 1e3 * speed.tick_s,
               session.tick_s() / speed.tick_s, static_cast<double>(speed.work.skipped) / speed.ticks});
  }
  if (!report.isShort() && nodes != kMillion) report.note("The renderer is software: not a million nodes.\n");
  report.add(table, "live");
}

}  // namespace viscera::bench
