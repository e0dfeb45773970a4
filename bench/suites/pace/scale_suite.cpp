// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/machine/machine.h"
#include "bench/harness/rate.h"
#include "bench/suites/pace/performance_suites.h"

namespace viscera::bench {

namespace {

constexpr double kGpuUpTo = 400e3, kFlatFrom = 9e3, kFlatUpTo = 1.1e6;  // nodes
constexpr double kFlat = 1.5;                                           // dearest over cheapest node between these
constexpr double kStateBytes = 4 * 12 + 4;  // of a node that a substep reads or writes, whole springs

struct Row {
  double nodes;
  Rate one, all, gpu;
  double bytes;  ///< per node, resident
};

Row measureSize(int edge, bool short_form) {
  const Specimen cube = cubeOf(edge);
  const double nodes = static_cast<double>(cube.nodes()), seconds = short_form ? 0.02 : 0.2;
  Row row{nodes, {}, {}, {}, 0};
  const double before = residentBytes();
  {
    const std::vector<Candidate> cpu = {candidate("", onCpu(cube, 1), cube.nodes())};
    row.one = measureRates(cpu, seconds)[0];
    row.bytes = (residentBytes() - before) / nodes;
  }
  row.all = measureRates({candidate("", onCpu(cube), cube.nodes())}, seconds)[0];
  if (nodes < kGpuUpTo && (!short_form || nodes < kFlatFrom))
    row.gpu = measureRates({candidate("", onGpu(cube), cube.nodes())}, seconds)[0];
  return row;
}

void addRow(Table& table, const Row& row) {
  const bool on_gpu = row.gpu.substeps_per_s > 0;
  table.add({row.nodes, row.one.ns_per_update(), row.all.ns_per_update(), on_gpu ? Cell(row.gpu.ns_per_update()) : "",
             row.all.substeps_per_s, row.all.spread, row.bytes > 0 ? Cell(row.bytes) : "",
             row.nodes * kStateBytes / 1048576});
}

void addPoint(Series& series, double nodes, const Rate& rate) {
  if (rate.substeps_per_s <= 0) return;
  series.x.push_back(nodes);
  series.y.push_back(rate.ns_per_update());
}

/// Upright lines where what a substep works on is as large as a cache.
void addCaches(Plot& plot, double low_ns, double high_ns) {
  for (const Cache& cache : caches()) {
    const double nodes = cache.bytes / kStateBytes;
    if (nodes < 1) continue;
    plot.series.push_back(
        {"L" + std::to_string(cache.level) + " cache", {nodes, nodes}, {low_ns, high_ns}, Series::Style::kLines});
  }
}

Plot plotOf(const std::vector<Row>& rows) {
  Plot plot{"Cost of a node, solid cube, no dashpot", "nodes", "ns per node update", true, true, {}};
  plot.series = {{"cpu, 1 thread", {}, {}}, {"cpu, all threads", {}, {}}, {"gpu", {}, {}}};
  double low = 1e9, high = 0;
  for (const Row& row : rows) {
    addPoint(plot.series[0], row.nodes, row.one);
    addPoint(plot.series[1], row.nodes, row.all);
    addPoint(plot.series[2], row.nodes, row.gpu);
    low = std::min(low, row.all.ns_per_update());
    high = std::max({high, row.one.ns_per_update(), row.gpu.substeps_per_s > 0 ? row.gpu.ns_per_update() : 0.0});
  }
  addCaches(plot, low, high);
  return plot;
}

/// Dearest over cheapest node where cost should be the same for all.
double unevenness(const std::vector<Row>& rows) {
  double low = 1e9, high = 0;
  for (const Row& row : rows) {
    if (row.nodes < kFlatFrom || row.nodes > kFlatUpTo) continue;
    low = std::min(low, row.all.ns_per_update());
    high = std::max(high, row.all.ns_per_update());
  }
  return high / low;
}

}  // namespace

void scaleSuite(Report& report, gpu::Context&) {
  const std::vector<double> sizes = report.isShort() ? std::vector<double>{1e3, 1e4, 3e4}
                                                     : std::vector<double>{1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7};
  Table table("solid cubes, no dashpot", {{"nodes", "", 8},
                                          {"cpu, 1 thread", "ns/update"},
                                          {"cpu, all threads", "ns/update"},
                                          {"gpu", "ns/update"},
                                          {"cpu, all threads", "substeps/s"},
                                          {"spread", "", 2},
                                          {"memory of the solver per node", "bytes"},
                                          {"a substep works on", "MiB"}});
  std::vector<Row> rows;
  for (double size : sizes) {
    report.stage("cube of about " + Cell(size).text(3) + " nodes");
    rows.push_back(measureSize(edgeOf(size), report.isShort()));
    addRow(table, rows.back());
  }
  report.add(table, "cubes");
  report.add(plotOf(rows), "cubes");
  report.checkAtMost("dearest over cheapest node, 10k to 1M nodes, cpu, all threads", unevenness(rows), kFlat);
}

}  // namespace viscera::bench
