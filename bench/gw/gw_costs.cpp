// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_kernels.h"
#include "bench/gw/gw_parts.h"

namespace viscera::bench {

namespace {

/// GW Table 1, for a mesh with largest valence N.
struct Printed {
  double rgb, rgba, fetches, dependent, operations;
};

Printed printedPoint(double n, double nodes) {
  return {n * nodes, nodes, nodes + n * nodes, n * nodes, 10 * n * nodes};
}

Printed printedEdge(double nodes, double springs) {
  return {springs, springs + nodes, springs, 2 * springs, 14 * springs};
}

/// Work of the kernels of bench/gw/gw_*.comp for all forces. A fetch is a texel; a dependent one has its address from
/// another fetch.
struct Counted {
  double bytes, fetches, dependent, stores, operations;
};

// Float32 operations of a force (spring.glsl with NETWORK): w 3, d + w 3, its square 5, root 1, direction 3 and that at
// rest with its root 10, extension 5 + 5 + 2 + 2 + 1, k 1, direction 3. Comparisons and selections do not count.
constexpr double kForce = 44, kAddition = 3, kNegation = 3;

Counted countPoint(const GwKernels& kernels, const NetworkLinks& links, double nodes) {
  // Per node, two starts and u; per link, two texels and u of its far end.
  const auto all = static_cast<double>(links.links.size());
  return {static_cast<double>(kernels.pointBytes()), 3 * nodes + 3 * all, 3 * all, nodes, (kForce + kAddition) * all};
}

Counted countRuns(const GwKernels& kernels, const NetworkLinks& links, double nodes) {
  // Per spring, its ends, then two texels and both u; per node, two starts; per link, its force.
  const auto springs = static_cast<double>(links.ends.size()), all = static_cast<double>(links.links.size());
  return {static_cast<double>(kernels.edgeBytes()), 5 * springs + 2 * nodes + all, 4 * springs + all,
          2 * springs + nodes, (kForce + kNegation) * springs + kAddition * all};
}

void addRow(Table& table, const GwNetwork& network, const std::string& variant, const Counted& c, const Printed& p) {
  const auto nodes = static_cast<double>(network.nodes());
  table.add({network.name, nodes, static_cast<double>(network.springs()), variant, p.rgb / nodes, p.rgba / nodes,
             p.fetches / nodes, p.dependent / nodes, p.operations / nodes, c.bytes / nodes, c.fetches / nodes,
             c.dependent / nodes, c.stores / nodes, c.operations / nodes});
}

}  // namespace

void countCosts(Report& report) {
  report.stage("counting");
  Table table(
      "GW Table 1, per node. GW: its formulae with N as the largest valence; counted: bytes of our buffers (springs, "
      "u, "
      "1/m, "
      "forces) and operations of our kernels",
      {{"mesh"},
       {"nodes", "", 8},
       {"springs", "", 8},
       {"way"},
       {"GW mem. RGB", "texels"},
       {"GW mem. RGBA", "texels"},
       {"GW fetches"},
       {"GW dependent"},
       {"GW operations"},
       {"memory", "bytes"},
       {"fetches"},
       {"dependent"},
       {"stores"},
       {"operations"}});
  const uint32_t edge = report.isShort() ? 64 : 256;
  for (const GwNetwork& network : {regularSheet(edge), irregularSheet(edge)}) {
    const GwKernels kernels(network);
    const NetworkLinks links = linksOf(network.network());
    const auto nodes = static_cast<double>(network.nodes()), springs = static_cast<double>(network.springs());
    addRow(table, network, "point-centric", countPoint(kernels, links, nodes),
           printedPoint(valencesOf(network).most, nodes));
    addRow(table, network, "edge-centric, runs", countRuns(kernels, links, nodes), printedEdge(nodes, springs));
  }
  report.add(table, "costs");
}

}  // namespace viscera::bench
