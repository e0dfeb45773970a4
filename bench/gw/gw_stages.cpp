// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <GL/glew.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

#include "bench/gw/gw_kernels.h"
#include "bench/gw/gw_parts.h"
#include "bench/harness/rate.h"

namespace viscera::bench {

namespace {

constexpr double kStill_s = 1e-9;  // substep that leaves the state unchanged, so that every round has the same work [s]
constexpr double kMilli = 1e3;

/// GW Table 2 [ms]; the point-centric method has no separate accumulation.
struct GwStagesPrinted {
  uint32_t edge;
  double point_force, edge_force, edge_sum, integration;
};
constexpr GwStagesPrinted kPaper[] = {
    {128, 0.54, 0.40, 0.12, 0.20}, {256, 2.34, 1.76, 0.52, 0.74}, {512, 9.82, 7.34, 2.08, 3.18}};
constexpr double kPaperIrregular = 1.6;  // from GW's text: point- over edge-centric, valences 3 to 12

/// A method for a substep, in stages. Stages without work are empty.
struct GwStagesVariant {
  std::string name;
  std::function<void()> force, accumulate, integrate;
};

/// Methods and the data on which they run.
struct Course {
  std::unique_ptr<GwKernels> kernels;
  std::unique_ptr<BlendTarget> target;
  std::vector<GwStagesVariant> variants;
};
enum { kPoint, kPasses, kGwStagesRuns, kBlended };

Course courseOf(const GwNetwork& network) {
  Course out;
  const Field u_m = deformed(network);
  out.kernels = std::make_unique<GwKernels>(network);
  out.target =
      std::make_unique<BlendTarget>(BlendFormat::kFloat32, network.slots(), scaleOf(largestSum_n(network, u_m)));
  out.kernels->start(u_m);
  GwKernels* k = out.kernels.get();
  BlendTarget* target = out.target.get();
  const GwMotion still{kStill_s, Vector3d::Zero()};
  const auto integrate = [k, still] { k->integrate(still); };
  out.variants = {{"point-centric", [k] { k->pointForces(); }, {}, integrate},
                  {"point-centric, a pass per neighbour", [k] { k->pointPasses(); }, {}, integrate},
                  {"edge-centric, runs", [k] { k->springForces(); }, [k] { k->sumForces(); }, integrate},
                  {"edge-centric, blending", [k] { k->forceTexture(); }, [k, target] { k->scatterForces(*target); },
                   [k, still, target] { k->integrate(still, target); }}};
  return out;
}

Candidate candidateOf(const GwNetwork& network, std::function<void()> work) {
  return {"", static_cast<double>(network.nodes()), [work = std::move(work)] {
            work();
            glFinish();
            return 1.0;
          }};
}

/// [ms] times of a method's stages; 0 if there is no such stage.
struct Times {
  double force = 0, accumulate = 0, integrate = 0, total = 0, spread = 0;
};

/// Times all stages of all methods in turn.
std::vector<Times> timesOf(const GwNetwork& network, double seconds) {
  const Course course = courseOf(network);
  std::vector<Candidate> candidates;
  std::vector<std::pair<size_t, double Times::*>> positions;
  for (size_t w = 0; w < course.variants.size(); ++w) {
    const GwStagesVariant& variant = course.variants[w];
    const auto add = [&](const std::function<void()>& work, double Times::*position) {
      if (!work) return;
      candidates.push_back(candidateOf(network, work));
      positions.emplace_back(w, position);
    };
    add(variant.force, &Times::force);
    add(variant.accumulate, &Times::accumulate);
    add(variant.integrate, &Times::integrate);
    add(
        [variant] {
          variant.force();
          if (variant.accumulate) variant.accumulate();
          variant.integrate();
        },
        &Times::total);
  }
  const std::vector<Rate> rates = measureRates(candidates, seconds);
  std::vector<Times> out(course.variants.size());
  for (size_t c = 0; c < rates.size(); ++c) {
    out[positions[c].first].*positions[c].second = kMilli / rates[c].substeps_per_s;
    if (positions[c].second == &Times::total) out[positions[c].first].spread = rates[c].spread;
  }
  return out;
}

Cell orNone(double value) {
  return value > 0 ? Cell(value) : Cell("");
}

/// Returns GW's figures for a method; zeros for methods that are not GW's.
Times printedFor(const GwStagesPrinted& row, size_t variant) {
  Times out;
  if (variant == kPoint) out = {row.point_force, 0, row.integration};
  if (variant == kBlended) out = {row.edge_force, row.edge_sum, row.integration};
  out.total = out.force + out.accumulate + out.integrate;
  return out;
}

const std::vector<std::string>& variantNames() {
  static const std::vector<std::string> names = {"point-centric", "point-centric, a pass per neighbour",
                                                 "edge-centric, runs", "edge-centric, blending"};
  return names;
}

Table stageTable(const std::string& title, std::vector<Column> more) {
  std::vector<Column> columns = {{"nodes"},
                                 {"way"},
                                 {"force", "ms", 3},
                                 {"accumulation", "ms", 3},
                                 {"integration", "ms", 3},
                                 {"total", "ms", 3},
                                 {"point-centric over this", "", 3},
                                 {"spread", "", 2}};
  columns.insert(columns.end(), more.begin(), more.end());
  return Table(title, columns);
}

std::vector<Cell> cellsOf(const GwNetwork& network, size_t variant, const std::vector<Times>& times) {
  const Times& t = times[variant];
  return {static_cast<double>(network.nodes()),
          variantNames()[variant],
          t.force,
          orNone(t.accumulate),
          t.integrate,
          t.total,
          times[kPoint].total / t.total,
          t.spread};
}

void measureRegular(Report& report, double seconds) {
  Table table =
      stageTable("GW Table 2: a regular mesh of valence 6. Times hold for this machine and this moment; compare ratios",
                 {{"GW force", "ms"},
                  {"GW accumulation", "ms"},
                  {"GW integration", "ms"},
                  {"GW total", "ms"},
                  {"GW ratio", "", 3}});
  for (const GwStagesPrinted& row : kPaper) {
    if (report.isShort() && row.edge > 128) continue;
    report.stage("stages, " + std::to_string(row.edge) + " x " + std::to_string(row.edge) + " nodes");
    const GwNetwork network = regularSheet(row.edge);
    const std::vector<Times> times = timesOf(network, seconds);
    for (size_t w = 0; w < times.size(); ++w) {
      const Times gw = printedFor(row, w);
      std::vector<Cell> cells = cellsOf(network, w, times);
      for (double value : {gw.force, gw.accumulate, gw.integrate, gw.total}) cells.push_back(orNone(value));
      cells.push_back(gw.total > 0 ? Cell(printedFor(row, kPoint).total / gw.total) : Cell(""));
      table.add(std::move(cells));
    }
  }
  report.add(table, "stages");
}

void measureIrregular(Report& report, double seconds) {
  const GwNetwork network = irregularSheet(report.isShort() ? 128 : 256);
  const Valences valences = valencesOf(network);
  report.stage("stages, valences 3 to 12");
  const std::vector<Times> times = timesOf(network, seconds);
  Table table = stageTable("GW 5: an irregular mesh of valences " + std::to_string(valences.least) + " to " +
                               std::to_string(valences.most) + ", mean " + Cell(valences.mean).text(3),
                           {{"a pass per neighbour over this", "", 3}, {"GW ratio", "", 3}});
  for (size_t w = 0; w < times.size(); ++w) {
    std::vector<Cell> cells = cellsOf(network, w, times);
    cells.emplace_back(times[kPasses].total / times[w].total);
    cells.push_back(w == kBlended ? Cell(kPaperIrregular) : Cell(""));
    table.add(std::move(cells));
  }
  report.add(table, "valences");
  report.checkAtLeast("valences 3 to 12: point-centric in a pass per neighbour as GW's, over edge-centric time",
                      times[kPasses].total / times[kGwStagesRuns].total, 1);
}

}  // namespace

void measureStages(Report& report) {
  const double seconds = report.isShort() ? 0.03 : 0.1;
  measureRegular(report, seconds);
  measureIrregular(report, seconds);
}

}  // namespace viscera::bench
