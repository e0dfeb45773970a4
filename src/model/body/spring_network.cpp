// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/spring_network.h"

#include <cmath>
#include <numeric>

namespace viscera {

namespace {

/// Returns a link. @param d  from the near to the far end at rest [m]
layout::Link linkTo(uint32_t far, const Vector3d& d, const NetworkSpring& spring, uint32_t lattice_spring) {
  layout::Link link{};
  const double l0 = spring.rest_length_m;
  link.offset_length = {static_cast<float>(d.x()), static_cast<float>(d.y()), static_cast<float>(d.z()),
                        static_cast<float>(l0)};
  link.stiffness = static_cast<float>(spring.stiffness_n_per_m);
  // Computed in double precision: rounded numbers would leave a force in springs at rest. A difference within double
  // rounding of a length that was computed from the ends counts as zero.
  constexpr double kRounding = 1e-12;
  const double prestrain_m2 = d.squaredNorm() - l0 * l0;
  link.prestrain_m2 = std::abs(prestrain_m2) <= kRounding * l0 * l0 ? 0.0f : static_cast<float>(prestrain_m2);
  link.far = far;
  link.lattice_spring = lattice_spring;
  return link;
}

uint32_t opposite(uint32_t lattice_spring) {
  return lattice_spring < layout::kSpringsPerNode ? lattice_spring ^ 1u : lattice_spring;
}

}  // namespace

double SpringNetwork::meanLength() const {
  double sum_m = 0;
  size_t counted = 0;
  for (const NetworkSpring& spring : springs) {
    if (spring.against_bending) continue;
    sum_m += spring.rest_length_m;
    ++counted;
  }
  return counted == 0 ? 0 : sum_m / static_cast<double>(counted);
}

NetworkLinks linksOf(const SpringNetwork& network) {
  NetworkLinks out;
  out.starts.assign(network.positions_m.size() + 1, 0);
  for (const NetworkSpring& spring : network.springs) {
    ++out.starts[spring.a + 1];
    ++out.starts[spring.b + 1];
  }
  std::partial_sum(out.starts.begin(), out.starts.end(), out.starts.begin());
  std::vector<uint32_t> next(out.starts.begin(), out.starts.end() - 1);
  out.links.resize(2 * network.springs.size());
  for (const NetworkSpring& spring : network.springs) {
    const Vector3d d = network.positions_m[spring.b] - network.positions_m[spring.a];
    const layout::SpringEnds ends{spring.a, spring.b, next[spring.a]++, next[spring.b]++};
    const uint32_t from_a = spring.against_bending ? layout::kBendingSpring : spring.lattice_spring;
    out.links[ends.link_a] = linkTo(spring.b, d, spring, from_a);
    out.links[ends.link_b] = linkTo(spring.a, -d, spring, opposite(from_a));
    out.ends.push_back(ends);
  }
  return out;
}

}  // namespace viscera
