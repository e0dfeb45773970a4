// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_mesh.h"

#include <algorithm>

#include "surface/skins/keep_room.h"

namespace viscera {

void WoundMesh::clear() {
  for (std::vector<uint32_t>* list : {&corners_, &names_, &position_of_, &next_, &first_, &free_}) list->clear();
  orders_.clear();
}

uint32_t WoundMesh::add(const std::array<uint32_t, 3>& corners, uint64_t order) {
  if (free_.empty()) {
    appendTo(free_, static_cast<uint32_t>(position_of_.size()));
    appendTo(position_of_, kNone);
    appendTo(orders_, uint64_t{0});
    for (int i = 0; i < 3; ++i) appendTo(next_, kNone);
  }
  const uint32_t name = free_.back();
  free_.pop_back();
  position_of_[name] = static_cast<uint32_t>(names_.size());
  orders_[name] = order;
  appendTo(names_, name);
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t vertex = corners[i];
    appendTo(corners_, vertex);
    if (vertex >= first_.size()) {
      keepRoom(first_, vertex + 1);
      first_.resize(vertex + 1, kNone);
    }
    next_[3 * size_t{name} + i] = first_[vertex];
    first_[vertex] = 3 * name + i;
  }
  ++made_;
  return name;
}

/// Removes a triangle. The last one takes its place.
void WoundMesh::remove(uint32_t name) {
  const size_t position = position_of_[name];
  for (uint32_t i = 0; i < 3; ++i) {
    uint32_t* link = &first_[corners_[3 * position + i]];
    while (*link != 3 * name + i) link = &next_[*link];
    *link = next_[*link];
  }
  const uint32_t last = names_.back();
  std::copy_n(corners_.end() - 3, 3, corners_.begin() + static_cast<ptrdiff_t>(3 * position));
  names_[position] = last;
  position_of_[last] = static_cast<uint32_t>(position);
  names_.pop_back();
  corners_.resize(corners_.size() - 3);
  position_of_[name] = kNone;
  appendTo(free_, name);
}

bool WoundMesh::isThis(uint32_t name, const std::array<uint32_t, 3>& corners, uint64_t order) const {
  return orders_[name] == order && cornersOf(name) == corners;
}

}  // namespace viscera
