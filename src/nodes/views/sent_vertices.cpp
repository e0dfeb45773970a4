// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/sent_vertices.h"

#include <algorithm>

namespace viscera::nodes {
namespace {

constexpr uint32_t kNotSent = UINT32_MAX;

}  // namespace

SentVertices::SentVertices(const VisibleTopology& whole) : numbers_(whole.vertices, kNotSent) {
  append(whole.triangles);
  whole_ = vertices_.size();
}

void SentVertices::follow(const VisibleTopology& topology) {
  for (size_t i = whole_; i < vertices_.size(); ++i) numbers_[vertices_[i]] = kNotSent;
  vertices_.resize(whole_);
  numbers_.resize(std::max(numbers_.size(), topology.vertices), kNotSent);
  append(topology.triangles);
}

/// Appends the vertices that are not sent yet, in the order of the mesh.
void SentVertices::append(const std::vector<uint32_t>& triangles) {
  const size_t first = vertices_.size();
  for (const uint32_t vertex : triangles) {
    if (numbers_[vertex] != kNotSent) continue;
    numbers_[vertex] = 0;
    vertices_.push_back(vertex);
  }
  std::sort(vertices_.begin() + static_cast<std::ptrdiff_t>(first), vertices_.end());
  for (size_t i = first; i < vertices_.size(); ++i) numbers_[vertices_[i]] = static_cast<uint32_t>(i);
}

}  // namespace viscera::nodes
