// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/contact_lists.h"

#include <algorithm>
#include <numeric>

namespace viscera {

namespace {

constexpr uint32_t kNobody = 0xffffffffu;
/// Share of the margin that is used. Distances and displacements have rounding errors of 1e-6, and every margin is a
/// larger share of D_ij than that.
constexpr float kUsableMargin = 0.999f;
constexpr float kCellMargin = 1.01f;    ///< as for the cells of the shader
constexpr uint32_t kFewestBuckets = 8;  ///< three adjacent buckets are distinct

float distance2(const glsl::vec3& a, const glsl::vec3& b) {
  const glsl::vec3 apart = a - b;
  return glm::dot(apart, apart);
}

}  // namespace

ContactLists::ContactLists(const CpuLattice& lattice, double reach_m, double margin_m, uint32_t most_in_bucket)
    : reach_m_(static_cast<float>(reach_m)),
      margin_m_(static_cast<float>(margin_m)),
      cell_m_(kCellMargin * (reach_m_ + margin_m_)),
      most_in_bucket_(most_in_bucket),
      in_shader_bucket_(bucketCount(lattice.store.active.size())) {
  const size_t nodes = lattice.store.active.size(), jobs = (nodes + kEntriesPerJob - 1) / kEntriesPerJob;
  rest_.resize(nodes);
  entry_of_.assign(nodes, kNobody);
  motions_.resize(jobs);
  shader_bucket_.assign(nodes, kNobody);
  entries_.resize(nodes);
  before_.resize(nodes);
  position_.resize(nodes);
  searched_at_.resize(nodes);
  shader_cell_.resize(nodes);
  cell_.resize(nodes);
  bucket_starts_.resize(std::max(bucketCount(nodes), kFewestBuckets) + 1);
  in_bucket_.resize(nodes);
  bucket_positions_.resize(nodes);
  runs_.resize(nodes);
  candidates_.resize(jobs);
  contacts_.resize(jobs);
  compared_.resize(jobs);
}

void ContactLists::update(glsl::CollisionRules& rules, const Parallel& parallel) {
  if (searches_ == 0) {
    for (size_t i = 0; i < rest_.size(); ++i) rest_[i] = glsl::vec4(rules.restPosition(rules.active_nodes[i]), 0);
  }
  parallel(motions_.size(), [&](size_t job) { follow(rules, job); });
  const bool others = recordCrowds(rules);
  if (others || !stillComplete()) search(rules, parallel);
}

/// Moves entries to the current positions of their nodes.
void ContactLists::follow(glsl::CollisionRules& rules, size_t job) {
  Motion motion;
  const size_t end = std::min((job + 1) * kEntriesPerJob, rest_.size());
  const auto mask = static_cast<uint32_t>(in_shader_bucket_.size() - 1);
  for (size_t i = job * kEntriesPerJob; i < end; ++i) {
    const uint32_t slot = rules.active_nodes[i], entry = entry_of_[i];
    const glsl::vec3 x = positionOf(rules, i);
    const bool collides = rules.collides(slot, rules.nodes[slot], x);
    moveTo(i, collides ? rules.hashOf(rules.cellOf(x)) & mask : kNobody, motion);
    if (entry == kNobody) continue;
    enter(rules, i, entry, x);
    const glsl::vec3 moved = x - searched_at_[entry];
    motion.low = glm::min(motion.low, moved);
    motion.high = glm::max(motion.high, moved);
  }
  motions_[job] = motion;
}

/// Moves a node to a bucket of the shader's search, or to none.
void ContactLists::moveTo(size_t node, uint32_t bucket, Motion& motion) {
  const uint32_t before = shader_bucket_[node];
  if (bucket == before) return;
  if (before == kNobody || bucket == kNobody) motion.same_nodes = false;
  if (before != kNobody) in_shader_bucket_[before].fetch_sub(1, std::memory_order_relaxed);
  if (bucket != kNobody && in_shader_bucket_[bucket].fetch_add(1, std::memory_order_relaxed) >= most_in_bucket_)
    motion.crowds = true;
  shader_bucket_[node] = bucket;
}

/// Finds the nodes that are crowded now, and clears what contacts did to them (collision_place.comp,
/// collision_scatter.comp).
/// @return whether others are crowded than at the last search
bool ContactLists::recordCrowds(glsl::CollisionRules& rules) {
  const bool may_be = std::any_of(motions_.begin(), motions_.end(), [](const Motion& m) { return m.crowds; });
  if (crowded_ == 0 && !may_be) return false;
  crowded_ = 0;
  bool others = false;
  for (size_t i = 0; i < shader_bucket_.size(); ++i) {
    if (shader_bucket_[i] == kNobody) continue;
    const bool crowded = isCrowded(i);
    others = others || crowded == (entry_of_[i] != kNobody);
    if (!crowded) continue;
    ++crowded_;
    const uint32_t slot = rules.active_nodes[i];
    rules.contacts[slot] = glsl::vec4(0);
    if (rules.corrections) rules.corrections[2 * slot] = rules.corrections[2 * slot + 1] = glsl::vec4(0);
  }
  return others;
}

glsl::vec3 ContactLists::positionOf(glsl::CollisionRules& rules, size_t node) const {
  const int slot = static_cast<int>(rules.active_nodes[node]);
  const glsl::vec3 x = glsl::xyz(rest_[node]) + glsl::xyz(stateAt(rules.displacement, slot));
  return rules.increment ? x + glsl::xyz(rules.increment[slot]) : x;
}

void ContactLists::enter(glsl::CollisionRules& rules, size_t node, size_t entry, const glsl::vec3& x) {
  const uint32_t slot = rules.active_nodes[node];
  entries_[entry] = glsl::uvec4(glsl::floatBitsToUint(x), slot);
  before_[entry] = rest_[node] + glsl::vec4(rules.increment ? rules.displacement[slot] : rules.next_displacement[slot]);
  position_[entry] = x;
  shader_cell_[entry] = rules.cellOf(x);
}

/// Returns whether the candidates are still complete. The diagonal of the box of all displacements bounds the relative
/// motion of two nodes.
bool ContactLists::stillComplete() const {
  Motion all;
  for (const Motion& motion : motions_) {
    if (!motion.same_nodes) return false;
    all.low = glm::min(all.low, motion.low);
    all.high = glm::max(all.high, motion.high);
  }
  const float usable_m = kUsableMargin * margin_m_;
  const glsl::vec3 size = glm::max(all.high - all.low, glsl::vec3(0));
  return searches_ > 0 && glm::dot(size, size) < usable_m * usable_m;
}

void ContactLists::search(glsl::CollisionRules& rules, const Parallel& parallel) {
  ++searches_;
  enterAll(rules);
  sortIntoCells();
  parallel(jobs(), [&](size_t job) { listCandidates(rules, job); });
}

/// Makes entries of all nodes that may touch others now and are not crowded.
void ContactLists::enterAll(glsl::CollisionRules& rules) {
  count_ = 0;
  for (size_t i = 0; i < rest_.size(); ++i) {
    const bool takes_part = shader_bucket_[i] != kNobody && !isCrowded(i);
    entry_of_[i] = takes_part ? static_cast<uint32_t>(count_) : kNobody;
    if (!takes_part) continue;
    const glsl::vec3 x = positionOf(rules, i);
    enter(rules, i, count_, x);
    searched_at_[count_] = x;
    cell_[count_++] = glsl::ivec3(glm::floor(x / cell_m_));
  }
}

/// Returns the bucket of a cell. Cells that are adjacent along x have adjacent buckets.
uint32_t ContactLists::bucketOf(const glsl::ivec3& cell) const {
  const uint32_t row = static_cast<uint32_t>(cell.y) * 73856093u ^ static_cast<uint32_t>(cell.z) * 19349663u;
  const uint32_t mask = static_cast<uint32_t>(bucket_starts_.size() - 2);
  return ((row ^ row >> 15) + static_cast<uint32_t>(cell.x)) & mask;
}

/// Sorts entries into buckets (counting sort).
void ContactLists::sortIntoCells() {
  std::fill(bucket_starts_.begin(), bucket_starts_.end(), 0);
  for (size_t e = 0; e < count_; ++e) ++bucket_starts_[bucketOf(cell_[e])];
  uint32_t sum = 0;
  for (uint32_t& start : bucket_starts_) start = sum += start;  // end of the bucket, until its nodes are in it
  for (size_t e = count_; e-- > 0;) {
    const uint32_t rank = --bucket_starts_[bucketOf(cell_[e])];
    in_bucket_[rank] = static_cast<uint32_t>(e);
    bucket_positions_[rank] = position_[e];
  }
}

void ContactLists::listCandidates(glsl::CollisionRules& rules, size_t job) {
  std::vector<ListedContact>& out = candidates_[job];
  out.clear();
  compared_[job] = 0;
  const auto range = entriesOf(job);
  for (size_t e = range[0]; e < range[1]; ++e) {
    const auto first = static_cast<uint32_t>(out.size());
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y)
        compared_[job] += listRow(rules, static_cast<uint32_t>(e), cell_[e] + glsl::ivec3(0, y, z), out);
    }
    std::sort(out.begin() + first, out.end(), [](const auto& a, const auto& b) { return a.other < b.other; });
    runs_[e] = {first, static_cast<uint32_t>(out.size()) - first, 0};
  }
  contacts_[job].resize(out.size());
}

size_t ContactLists::compared() const {
  return std::accumulate(compared_.begin(), compared_.begin() + static_cast<std::ptrdiff_t>(jobs()), size_t{0});
}

/// Lists the candidates of an entry in a cell and its two neighbours along x.
/// @return number of entries compared
size_t ContactLists::listRow(glsl::CollisionRules& rules, uint32_t entry, const glsl::ivec3& middle,
                             std::vector<ListedContact>& out) const {
  const size_t buckets = bucket_starts_.size() - 1;
  const size_t first = bucketOf(middle - glsl::ivec3(1, 0, 0)), end = first + 3;
  const uint32_t from = bucket_starts_[first], to = bucket_starts_[std::min(end, buckets)];
  const uint32_t wrapped = end > buckets ? bucket_starts_[end - buckets] : 0;
  listRun(rules, entry, middle, from, to, out);
  listRun(rules, entry, middle, 0, wrapped, out);
  return to - from + wrapped;
}

/// Lists the candidates in a run of buckets. Different rows may share buckets, so each entry's row is checked.
void ContactLists::listRun(glsl::CollisionRules& rules, uint32_t entry, const glsl::ivec3& row, size_t first,
                           size_t end, std::vector<ListedContact>& out) const {
  const glsl::vec3 x = position_[entry];
  const float most2 = (reach_m_ + margin_m_) * (reach_m_ + margin_m_);
  for (size_t k = first; k < end; ++k) {
    const float d2 = distance2(x, bucket_positions_[k]);
    if (d2 > most2) continue;  // true for most
    const uint32_t other = in_bucket_[k];
    if (other == entry || cell_[other].y != row.y || cell_[other].z != row.z) continue;
    const float wanted = rules.contactDistance(entries_[entry].w, entries_[other].w), far = wanted + margin_m_;
    if (d2 <= far * far) out.push_back({other, wanted});
  }
}

void ContactLists::findContacts(size_t job) {
  const auto range = entriesOf(job);
  for (size_t e = range[0]; e < range[1]; ++e) {
    Run& run = runs_[e];
    const glsl::vec3 x = position_[e];
    const ListedContact* const candidates = candidates_[job].data() + run.first;
    ListedContact* const contacts = contacts_[job].data() + run.first;
    uint32_t count = 0;
    for (uint32_t c = 0; c < run.candidates; ++c) {
      const ListedContact candidate = candidates[c];
      contacts[count] = candidate;  // no branch, as it would be unpredictable
      count += distance2(x, position_[candidate.other]) < candidate.distance_m * candidate.distance_m ? 1 : 0;
    }
    run.contacts = count;
    if (count > 1) sortByCells(e, contacts, contacts + count);
  }
}

/// Sorts contacts into the order in which the shader's search visits cells; within a cell they are in order already.
void ContactLists::sortByCells(size_t entry, ListedContact* begin, ListedContact* end) const {
  const auto rankOf = [&](const ListedContact& contact) {
    const glsl::ivec3 away = shader_cell_[contact.other] - shader_cell_[entry];
    return away.x + 3 * away.y + 9 * away.z;
  };
  for (ListedContact* next = begin + 1; next < end; ++next) {  // few, and mostly in order
    const ListedContact contact = *next;
    const int rank = rankOf(contact);
    ListedContact* to = next;
    for (; to > begin && rankOf(to[-1]) > rank; --to) *to = to[-1];
    *to = contact;
  }
}

}  // namespace viscera
