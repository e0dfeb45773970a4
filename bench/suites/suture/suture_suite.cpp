// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suture/suture_suite.h"

#include <cmath>

#include "bench/suites/suture/suture_trials.h"
#include "bench/suites/suture/tearing_trial.h"
#include "bench/suites/suture/track_trials.h"

namespace viscera::bench {

namespace {

constexpr double kBent = 0.02, kSag = 0.005, kCapstan = 0.05, kRipple = 0.03;
constexpr double kHeldLinks = 0.01;  // residual of the iterations
constexpr double kLink = 1e-3, kMomentum = 1e-6;
constexpr double kFrequency = 0.03;  // half-implicit: 2 % low if a period has 14 substeps
constexpr double kDamping = 0.02;    // relative to the ratio
constexpr double kDeep_m = 1e-4;     // depth in an obstacle: a radius
constexpr double kSlip = 1.06;       // relative to the force at which the grip slips: its iterations end 5 % above
constexpr double kRest_m_per_s = 1e-3;
constexpr double kSeldom = 1e-3;  // share of substeps: when a channel lets go; the following substeps correct it
constexpr double kPercent = 100, kMilli = 1e-3;

void bending(Report& report) {
  struct Known {
    double load, across;
  };
  Table tips("A suture clamped at one end, a force across its tip",
             {{"P L2 / EI"}, {"nodes"}, {"tip across / L"}, {"elastica"}, {"off", "%", 2}});
  for (const Known known : {Known{1, 0.30172}, {2, 0.49346}, {3, 0.60325}, {5, 0.71379}, {10, 0.81061}}) {
    for (const size_t nodes : {20, 40, 100}) {
      const double off = bentByForce(known.load, nodes).across / known.across - 1;
      tips.add({known.load, static_cast<double>(nodes), known.across * (1 + off), known.across, kPercent * off});
      report.checkAtMost("elastica " + Cell(known.load).text(3) + ", " + std::to_string(nodes) + " nodes",
                         std::abs(off), kBent);
    }
  }
  report.add(tips, "elastica");
  Table moments("A moment at its tip, 60 nodes", {{"turns asked"}, {"turned"}, {"off", "%", 2}});
  for (const double turns : {0.25, 0.5, 1.0}) {
    const double turned = bentByMoment(turns, 60);
    moments.add({turns, turned, kPercent * (turned / turns - 1)});
    report.checkAtMost("moment " + Cell(turns).text(3), std::abs(turned / turns - 1), kBent);
  }
  report.add(moments, "moment");
}

void hanging(Report& report) {
  Table table(
      "0.2 m of limp suture between two points",
      {{"apart", "mm"}, {"nodes"}, {"sag", "mm"}, {"catenary", "mm"}, {"off", "%", 2}, {"tension off", "%", 2}});
  for (const double width_m : {0.06, 0.12, 0.18}) {
    const size_t nodes = report.isShort() ? 101 : 301;
    const CatenaryTrial r = hungUp(width_m, nodes);
    const double off = r.sag / r.exact_sag - 1;
    table.add({width_m / kMilli, static_cast<double>(nodes), r.sag / kMilli, r.exact_sag / kMilli, kPercent * off,
               kPercent * (r.tension / r.exact_tension - 1)});
    report.checkAtMost("catenary " + Cell(width_m / kMilli).text(3) + " mm", std::abs(off), kSag);
  }
  report.add(table, "catenary");
}

void sliding(Report& report) {
  Table table("Drawn over a cylinder, friction 0.3: ratio of tensions over exp(friction x angle)",
              {{"angle", "deg"}, {"ratio / law"}});
  for (const double angle_deg : {90.0, 180.0, 360.0}) {
    const double ratio = drawnOverCylinder(angle_deg);
    table.add({angle_deg, ratio});
    report.checkAtMost("capstan " + Cell(angle_deg).text(3) + " deg", std::abs(ratio - 1), kCapstan);
  }
  report.add(table, "capstan");
}

void channels(Report& report) {
  Table table("Drawn through channels that turn it by 90 degrees in all, friction 0.3, held back by 0.1 N",
              {{"share of EI"}, {"channels"}, {"ratio / law"}, {"ripple", "%", 2}, {"iterations", "", 3}});
  for (const double share : {1e-3, 1.0}) {
    for (const size_t count : {1, 2, 4}) {
      const TrackTrial r = drawnThroughTracks(count, share, 0.1);
      table.add({share, static_cast<double>(count), r.ratio, kPercent * r.ripple, r.iterations});
      const std::string name = std::to_string(count) + " channels, " + Cell(share).text(3) + " of EI";
      report.checkAtMost("capstan through " + name, std::abs(r.ratio - 1), kCapstan);
      report.checkAtMost("ripple through " + name, r.ripple, kRipple);
    }
  }
  report.add(table, "channels");
  const TissueTrial thrown = thrownThroughTissue();
  report.note("Half a second of flight through three free masses that tear: momentum of both changed by " +
              Cell(thrown.momentum).text(2) + " of the sum of m |v|, " + Cell(thrown.exchanged).text(2) +
              " of the impulses between them; at most " + Cell(thrown.off_m / kMilli).text(2) + " mm off a channel\n");
  report.checkAtMost("momentum of suture and tissue", thrown.momentum, kMomentum);
}

void knots(Report& report) {
  const KnotTrial r = pulledKnot();
  report.note("A knot that holds 0.2 N: pulled by 0.18 N, " + Cell(r.moved).text(2) +
              " links come through; it slips at " + Cell(r.slips).text(4) + " of what it holds, its points at most " +
              Cell(r.off_m / kMilli).text(2) + " mm apart\n");
  report.checkAtMost("links through a knot that holds", r.moved, kHeldLinks);
  report.checkAtMost("force at which a knot slips", std::abs(r.slips - 1), kCapstan);
  report.checkAtMost("links of a knotted suture", r.worst_link, kLink);
  Table table("An iteration of 300 nodes, of one processor", {{"channels"}, {"knots"}, {"iteration", "us", 3}});
  for (const auto& [channels, knots] : {std::pair<size_t, size_t>{0, 0}, {6, 0}, {24, 0}, {0, 1}, {6, 1}, {6, 4}})
    table.add({static_cast<double>(channels), static_cast<double>(knots), iterationCost_us(channels, knots)});
  report.add(table, "knots");
}

void pulling(Report& report) {
  Table table("300 nodes, one end held, pulled at the other, substeps of 0.5 ms",
              {{"force", "N"}, {"worst link", "", 2}, {"iterations", "", 3}, {"at most"}, {"tension / force", "", 6}});
  for (const double force_n : {0.01, 1.0, 20.0}) {
    const PullTrial r = pulledBy(force_n);
    table.add({force_n, r.worst_link, r.iterations, r.most_iterations, r.tension});
    report.checkAtMost("links at " + Cell(force_n).text(3) + " N", r.worst_link, kLink);
  }
  report.add(table, "pull");
  const FlightTrial flight = thrown();
  report.note("2 s of free flight: momentum changed by " + Cell(flight.momentum).text(2) +
              " of the sum of m |v|, angular momentum by " + Cell(flight.angular).text(2) + ", worst link " +
              Cell(flight.worst_link).text(2) + "\n");
  report.checkAtMost("momentum in flight", flight.momentum, kMomentum);
  report.checkAtMost("links in flight", flight.worst_link, kLink);
}

void swinging(Report& report) {
  Table table("First mode of a clamped suture, bending damped by 0.2 ms",
              {{"length", "mm"}, {"measured", "Hz"}, {"exact", "Hz"}, {"damping ratio", "", 3}, {"law", "", 3}});
  for (const double length_m : {0.02, 0.03, 0.05}) {
    const ModeTrial r = plucked(length_m);
    table.add({length_m / kMilli, r.hz, r.exact_hz, r.damping, r.expected_damping});
    const std::string name = Cell(length_m / kMilli).text(3) + " mm";
    report.checkAtMost("frequency, " + name, std::abs(r.hz / r.exact_hz - 1), kFrequency);
    report.checkAtMost("damping, " + name, std::abs(r.damping - r.expected_damping), kDamping);
  }
  report.add(table, "mode");
}

void cost(Report& report) {
  Table table("A substep of one iteration, of one processor", {{"nodes"}, {"substep", "us", 3}, {"a node", "ns", 3}});
  for (const size_t nodes : {50, 100, 200, 300, 600, 1200}) {
    const double us = substepCost_us(nodes);
    table.add({static_cast<double>(nodes), us, 1e3 * us / static_cast<double>(nodes)});
  }
  report.add(table, "cost");
}

void stress(Report& report) {
  const double seconds = report.isShort() ? 3 : 60;
  Table table(
      "One end held, the other pulled around by a stylus with 20 N at up to 1 m/s, over a cylinder and the ground, " +
          Cell(seconds).text(3) + " s",
      {{"share of EI"},
       {"substeps", "", 7},
       {"links off by more than 1e-3"},
       {"worst link", "", 2},
       {"iterations", "", 3},
       {"at most"},
       {"substep", "us", 3},
       {"most force", "N", 3},
       {"deepest", "mm", 2},
       {"4 s after", "m/s", 2}});
  for (const double share : {1.0, 0.1, 0.01}) {
    report.stage("stress at " + Cell(share).text(3) + " of EI");
    const StressTrial r = drawnAbout(seconds, share);
    table.add({share, r.substeps, r.bad, r.worst_link, r.iterations, r.most_iterations, r.substep_us, r.most_force_n,
               r.deepest_m / kMilli, r.rest_speed_m_per_s});
    const std::string name = ", " + Cell(share).text(3) + " of EI";
    report.checkAtMost("not finite" + name, r.nonfinite, 0);
    report.checkAtMost("substeps with bad links" + name, r.bad, 0);
    report.checkAtMost("force of the stylus over its limit" + name, r.most_force_n / 20, kSlip);
    report.checkAtMost("deepest in an obstacle [m]" + name, r.deepest_m, kDeep_m);
    report.checkAtMost("speed at rest" + name, r.rest_speed_m_per_s, kRest_m_per_s);
  }
  report.add(table, "stress");
}

void tearing(Report& report) {
  const double seconds = report.isShort() ? 3 : 60;
  Table table(
      "A suture through twelve channels of tissue, one end held, the other pulled around by a stylus with 20 N at up "
      "to 1 m/s until they are torn out, then a new block, " +
          Cell(seconds).text(3) + " s",
      {{"E", "kPa"},
       {"blocks"},
       {"channels out"},
       {"springs cut", "", 7},
       {"substeps", "", 7},
       {"links off by more than 1e-3"},
       {"worst link", "", 2},
       {"iterations", "", 3},
       {"without a solution"},
       {"most force", "N", 3},
       {"tissue's stretch", "", 2},
       {"trips"},
       {"processor", "s", 3}});
  for (const double kpa : {1.0, 3.0, 10.0}) {
    report.stage("tearing at " + Cell(kpa).text(3) + " kPa");
    const TearingTrial r = tornOut(seconds, 1e3 * kpa, 1);
    const bool same = tornOut(seconds, 1e3 * kpa, 1).hash == r.hash;
    table.add({kpa, r.blocks, r.torn, r.springs, r.substeps, r.off, r.worst_link, r.iterations, r.waits, r.most_force_n,
               r.stretch, r.trips, r.seconds_of_cpu});
    const std::string name = ", torn out of " + Cell(kpa).text(3) + " kPa";
    report.checkAtMost("trips of the stability monitor" + name, r.trips, 0);
    report.checkAtMost("not finite" + name, r.nonfinite, 0);
    report.checkAtMost("share of substeps with links off" + name, r.off / r.substeps, kSeldom);
    report.checkAtMost("worst link" + name, r.worst_link, kLink);
    report.checkAtMost("force of the stylus over its limit" + name, r.most_force_n / 20, kSlip);
    report.checkAtLeast("a second run ends in the same hash" + name, same, 1);
  }
  report.add(table, "tearing");
}

}  // namespace

void sutureSuite(Report& report) {
  measureParts(report, {{"bending", bending},
                        {"hanging", hanging},
                        {"sliding", sliding},
                        {"channels", channels},
                        {"knots", knots},
                        {"pulling", pulling},
                        {"swinging", swinging},
                        {"cost", cost},
                        {"stress", stress},
                        {"tearing", tearing}});
}

}  // namespace viscera::bench
