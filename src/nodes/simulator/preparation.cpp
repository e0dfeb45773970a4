// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/preparation.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "viscera/model/scene/scene.h"

namespace viscera::nodes {
namespace {

/// Beginning and end of a stage, in shares of the time.
struct Span {
  const char* stage;
  double from, to;
};

// Measured with the heart on two cores without a GPU, from the stamps of the log of README's first ROS command.
constexpr double kShareOfAuto = 0.4, kShareOfRest = 0.5;  // share of everything; share of the rest
constexpr std::array<Span, 2> kAuto = {{{"measure this machine", 0, 0.7}, {"choose spacing", 0.7, 1}}};
constexpr std::array<Span, 8> kBody = {{{"read", 0, 0.05},
                                        {"voxelise", 0.05, 0.35},
                                        {"build lattice", 0.35, 0.4},
                                        {"build network", 0.05, 0.6},
                                        {"extract skin", 0.4, 0.65},
                                        {"paint detail", 0.65, 0.92},
                                        {"bake detail", 0.45, 0.92},
                                        {"bind skin", 0.92, 1}}};
constexpr std::array<Span, 2> kRest = {{{"start the solver", 0, 0.12}, {"prepare pictures", 0.12, 1}}};

template <size_t N>
double within(const std::array<Span, N>& spans, const std::string& stage, double fraction) {
  for (const Span& span : spans)
    if (stage == span.stage) return span.from + std::clamp(fraction, 0.0, 1.0) * (span.to - span.from);
  return 0;
}

}  // namespace

Preparation::Preparation(const Scene& scene)
    : auto_share_(autoBodies(scene).empty() ? 0 : kShareOfAuto),
      bodies_share_((1 - kShareOfRest) * (1 - auto_share_)),
      bodies_(std::max<size_t>(1, scene.bodies.size())) {}

int Preparation::percentAt(const std::string& stage, double fraction) {
  const size_t colon = stage.rfind(": ");
  const std::string of_body = colon == std::string::npos ? "" : stage.substr(colon + std::strlen(": "));
  double at = 0;
  if (!of_body.empty()) {
    if (of_body == "read") bodies_begun_ = std::min(bodies_begun_ + 1, bodies_);
    const double before = bodies_begun_ > 0 ? static_cast<double>(bodies_begun_ - 1) : 0;
    at = auto_share_ + bodies_share_ * (before + within(kBody, of_body, fraction)) / static_cast<double>(bodies_);
  } else if (std::any_of(kRest.begin(), kRest.end(), [&](const Span& span) { return stage == span.stage; })) {
    const double begin = auto_share_ + bodies_share_;
    at = begin + (1 - begin) * within(kRest, stage, fraction);
  } else {
    at = auto_share_ * within(kAuto, stage, fraction);
  }
  done_ = std::max(done_, at);
  return std::min(99, static_cast<int>(100 * done_));
}

}  // namespace viscera::nodes
