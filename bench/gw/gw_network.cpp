// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "bench/gw/gw_triangulation.h"
#include "bench/harness/specimens/specimen.h"
#include "model/body/network_builder.h"

namespace viscera::bench {

namespace {

constexpr double kGwNetworkSpacing_m = 0.01, kThickness_m = 0.001;
constexpr double kJitter = 0.15;    // of a spacing, in both directions
constexpr double kDrag_per_s = 20;  // hanging bodies come to rest within a second

using Corners = std::array<uint32_t, 3>;

Field sheetPositions(uint32_t edge) {
  Field out;
  for (uint32_t row = 0; row < edge; ++row) {
    for (uint32_t column = 0; column < edge; ++column) {
      const double x = column + 0.5 * (row % 2), y = row * std::sqrt(0.75);
      out.push_back(kGwNetworkSpacing_m * Vector3d(x, y, 0));
    }
  }
  return out;
}

std::vector<Corners> sheetTriangles(uint32_t edge) {
  std::vector<Corners> out;
  for (uint32_t row = 0; row + 1 < edge; ++row) {
    for (uint32_t column = 0; column + 1 < edge; ++column) {
      const uint32_t a = row * edge + column, b = a + 1, c = a + edge, d = c + 1;
      if (row % 2 == 0) {
        out.push_back({a, b, c});
        out.push_back({b, d, c});
      } else {
        out.push_back({a, b, d});
        out.push_back({a, d, c});
      }
    }
  }
  return out;
}

MaterialConfig undashed() {
  MaterialConfig material;
  material.mass_damping_per_s = kDrag_per_s;
  material.stiffness_damping_ratio = 0;
  return material;
}

GwNetwork sheetOf(const std::string& name, const Field& at_m, const std::vector<Corners>& triangles) {
  TriangleMesh mesh;
  for (const Vector3d& p : at_m) mesh.positions_m.push_back(p.cast<float>());
  mesh.triangles = triangles;
  mesh.parts.assign(triangles.size(), 0);
  mesh.part_names = {"sheet"};
  Body body;
  body.name = "sheet";
  body.material = undashed();
  adoptNetwork(membraneNetwork(mesh, body.material, kThickness_m), body);
  GwNetwork out;
  out.name = name;
  out.model.bodies.push_back(std::move(body));
  return out;
}

/// Returns the node that is farthest along a direction.
uint32_t farthest(const GwNetwork& sheet, const Vector3d& direction) {
  const std::vector<uint32_t>& active = sheet.body().lattice.active_slots;
  return *std::max_element(active.begin(), active.end(), [&](uint32_t a, uint32_t b) {
    return direction.dot(sheet.network().positions_m[a]) < direction.dot(sheet.network().positions_m[b]);
  });
}

}  // namespace

Valences valencesOf(const GwNetwork& network) {
  const NetworkLinks links = linksOf(network.network());
  Valences out{std::numeric_limits<uint32_t>::max(), 0, 0};
  for (uint32_t slot : network.body().lattice.active_slots) {
    const uint32_t valence = links.starts[slot + 1] - links.starts[slot];
    out.least = std::min(out.least, valence);
    out.most = std::max(out.most, valence);
  }
  out.mean = 2.0 * static_cast<double>(network.springs()) / static_cast<double>(network.nodes());
  return out;
}

GwNetwork regularSheet(uint32_t nodes_per_edge) {
  return sheetOf("valence 6", sheetPositions(nodes_per_edge), sheetTriangles(nodes_per_edge));
}

GwNetwork irregularSheet(uint32_t nodes_per_edge) {
  Field at_m = sheetPositions(nodes_per_edge);
  std::mt19937 random(1);
  // Not std::uniform_real_distribution, which differs between libraries.
  const auto jitter_m = [&] { return kJitter * kGwNetworkSpacing_m * (random() / 2147483648.0 - 1); };
  for (Vector3d& p : at_m) {
    p.x() += jitter_m();
    p.y() += jitter_m();
  }
  Triangulation triangulation(at_m, sheetTriangles(nodes_per_edge));
  triangulation.flipAtRandom({3, 12, 5 * kGwNetworkSpacing_m}, random);
  return sheetOf("valence 3 to 12", at_m, triangulation.triangles());
}

GwNetwork hangingCloth(uint32_t nodes_per_edge) {
  GwNetwork out = regularSheet(nodes_per_edge);
  out.name = "cloth";
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) {
      const uint32_t corner = farthest(out, {x, y, 0});
      out.model.bodies[0].lattice.nodes[corner].lo |= layout::kFixedBit;
    }
  }
  return out;
}

GwNetwork hangingHeart(int nodes) {
  Scene scene = pigHeartScene(nodes, 0);
  scene.bodies[0].structure = Structure::kExplicit;
  scene.bodies[0].material.mass_damping_per_s = kDrag_per_s;
  return {"heart", buildModel(scene)};
}

Field deformed(const GwNetwork& network) {
  constexpr double kAmplitude = 0.4, kNumber = 0.5;  // [spacings]; [radians per spacing]
  const double length_m = network.network().meanLength();
  Field out(network.slots(), Vector3d::Zero());
  for (uint32_t slot : network.body().lattice.active_slots) {
    const Vector3d phase = kNumber / length_m * network.network().positions_m[slot];
    out[slot] =
        kAmplitude * length_m *
        Vector3d(std::sin(phase.y() + phase.z() + 1), std::sin(phase.x() + phase.z() + 2), 2 * std::sin(phase.x() + 3));
  }
  return out;
}

double largestSum_n(const GwNetwork& network, const Field& u_m) {
  std::vector<double> sums_n(network.slots(), 0);
  const auto positionOf = [&](uint32_t slot) -> Vector3d { return network.network().positions_m[slot] + u_m[slot]; };
  for (const NetworkSpring& spring : network.network().springs) {
    const double length_m = (positionOf(spring.b) - positionOf(spring.a)).norm();
    const double force_n = spring.stiffness_n_per_m * std::abs(length_m - spring.rest_length_m);
    sums_n[spring.a] += force_n;
    sums_n[spring.b] += force_n;
  }
  return *std::max_element(sums_n.begin(), sums_n.end());
}

}  // namespace viscera::bench
