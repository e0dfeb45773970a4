// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/smooth_shares.h"

#include <algorithm>

namespace viscera {

namespace {

// A node and its neighbours count 1/2 and 1/4 along each axis. Alone on a surface it keeps a quarter of its share, and
// in a line a half: this factor returns the middle of a line to the share of its nodes.
constexpr float kGain = 2;
constexpr int kMargin = 2;  // nodes around the painted ones: those that the smoothing reaches, and one that is 0

}  // namespace

SmoothShares::SmoothShares(const Lattice& lattice, const float* shares)
    : origin_m_(lattice.origin_m), spacing_m_(lattice.spacing_m) {
  Eigen::AlignedBox3i box;
  for (const uint32_t slot : lattice.active_slots)
    if (shares[slot] > 0) box.extend(lattice.nodeAt(slot));
  if (box.isEmpty()) return;
  low_ = box.min() - Vector3i::Constant(kMargin);
  size_ = box.sizes() + Vector3i::Constant(2 * kMargin + 1);
  std::vector<float> own(static_cast<size_t>(size_.prod())), sums, weights(own.size());
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3i at = lattice.nodeAt(slot) - low_;
    if ((at.array() < 0).any() || (at.array() >= size_.array()).any()) continue;
    own[indexOf(at)] = shares[slot];
    weights[indexOf(at)] = 1;
  }
  sums = own;
  std::vector<float> most = own;
  for (int axis = 0; axis < 3; ++axis) {
    blur(axis, sums, weights);
    const std::vector<float> before = most;
    const auto step = static_cast<size_t>(axis == 0 ? 1 : axis == 1 ? size_.x() : size_.x() * size_.y());
    for (size_t i = 0; i < most.size(); ++i) {
      if (i >= step) most[i] = std::max(most[i], before[i - step]);
      if (i + step < most.size()) most[i] = std::max(most[i], before[i + step]);
    }
  }
  smooth_.resize(own.size());
  for (size_t i = 0; i < own.size(); ++i)
    smooth_[i] = weights[i] > 0 ? std::min(kGain * sums[i] / weights[i], most[i]) : 0;
}

size_t SmoothShares::indexOf(const Vector3i& node) const {
  return static_cast<size_t>(node.x() + size_.x() * (node.y() + size_.y() * node.z()));
}

/// Sums with weights 1/4, 1/2, 1/4 along an axis; the border of the box is 0.
void SmoothShares::blur(int axis, std::vector<float>& sums, std::vector<float>& weights) const {
  const auto step = static_cast<size_t>(axis == 0 ? 1 : axis == 1 ? size_.x() : size_.x() * size_.y());
  for (std::vector<float>* of : {&sums, &weights}) {
    const std::vector<float> before = *of;
    for (size_t i = 0; i < of->size(); ++i) {
      const float behind = i >= step ? before[i - step] : 0, ahead = i + step < of->size() ? before[i + step] : 0;
      (*of)[i] = 0.5F * before[i] + 0.25F * (behind + ahead);
    }
  }
}

float SmoothShares::at(const Vector3f& rest_m) const {
  if (smooth_.empty()) return 0;
  const Vector3d place = (rest_m.cast<double>() - origin_m_) / spacing_m_ - low_.cast<double>();
  const Vector3i node = place.array().floor().cast<int>();
  if ((node.array() < 0).any() || (node.array() + 1 >= size_.array()).any()) return 0;
  const Vector3f within = (place - node.cast<double>()).cast<float>();
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, (c >> 1) & 1, (c >> 2) & 1);
    float weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= corner[axis] != 0 ? within[axis] : 1 - within[axis];
    sum += weight * smooth_[indexOf(node + corner)];
  }
  return sum;
}

}  // namespace viscera
