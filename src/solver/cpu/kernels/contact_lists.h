// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include "solver/contact/collision.h"
#include "solver/cpu/kernels/collision_kernel.h"
#include "solver/cpu/state/parallel.h"

namespace viscera {

/// Another node that an entry touches or may come to touch.
struct ListedContact {
  uint32_t other;    ///< entry of that node
  float distance_m;  ///< D_ij of collision.h
};

/// Complete contact search with lists of candidates that are kept over several substeps (Verlet 1967).
///
/// Candidates are all pairs that were nearer than D_ij + margin at the last search. They include all contacts as long
/// as the same nodes take part and no two nodes have moved by the margin relative to each other. So every substep finds
/// the pairs that its own search would find. They are in the order of the shader's search, so that sums are the same.
/// Nodes that the shader skips, since too many are in one bucket of its grid (kMostInBucket), are skipped here too:
/// this bounds the cost of bodies that have collapsed into one point.
class ContactLists {
 public:
  /// Entries are nodes that may touch others, in ascending order of slots; a job is a run of entries.
  static constexpr size_t kEntriesPerJob = 64;

  /// @param reach_m  largest D_ij
  /// @param margin_m  0: searches in every substep
  /// @param most_in_bucket  kMostInBucket; a test may lower it
  ContactLists(const CpuLattice& lattice, double reach_m, double margin_m, uint32_t most_in_bucket = kMostInBucket);

  /// Makes entries of the current state, and searches for candidates if the present ones are out of date.
  void update(glsl::CollisionRules& rules, const Parallel& parallel);
  /// Finds the contacts of a job's entries among the candidates. Call it after update().
  void findContacts(size_t job);

  size_t count() const { return count_; }  ///< number of entries
  size_t jobs() const { return (count_ + kEntriesPerJob - 1) / kEntriesPerJob; }
  std::array<size_t, 2> entriesOf(size_t job) const {
    return {job * kEntriesPerJob, std::min((job + 1) * kEntriesPerJob, count_)};
  }
  const ListedContact* begin(size_t entry) const {
    return contacts_[entry / kEntriesPerJob].data() + runs_[entry].first;
  }
  const ListedContact* end(size_t entry) const { return begin(entry) + runs_[entry].contacts; }

  const glsl::uvec4* entries() const { return entries_.data(); }  ///< as in collision_order.comp
  const glsl::vec4* before() const { return before_.data(); }     ///< as in collision_order.comp
  size_t searches() const { return searches_; }                   ///< number of searches so far
  uint32_t crowded() const { return crowded_; }                   ///< nodes that were skipped in the last update()
  size_t compared() const;                                        ///< pairs that the last search compared

 private:
  /// Range of an entry's candidates and contacts in those of its job.
  struct Run {
    uint32_t first, candidates, contacts;
  };
  static constexpr float kFar_m = std::numeric_limits<float>::infinity();
  /// Motion of nodes since the last search.
  struct Motion {
    glsl::vec3 low = glsl::vec3(kFar_m), high = glsl::vec3(-kFar_m);  ///< box of all displacements [m]
    bool same_nodes = true;
    bool crowds = false;  ///< a bucket of the shader's search may have become too full
  };

  glsl::vec3 positionOf(glsl::CollisionRules& rules, size_t node) const;
  void enter(glsl::CollisionRules& rules, size_t node, size_t entry, const glsl::vec3& x);
  void follow(glsl::CollisionRules& rules, size_t job);
  void moveTo(size_t node, uint32_t bucket, Motion& motion);
  bool isCrowded(size_t node) const { return in_shader_bucket_[shader_bucket_[node]] > most_in_bucket_; }
  bool recordCrowds(glsl::CollisionRules& rules);
  bool stillComplete() const;
  void search(glsl::CollisionRules& rules, const Parallel& parallel);
  void enterAll(glsl::CollisionRules& rules);
  void sortIntoCells();
  void listCandidates(glsl::CollisionRules& rules, size_t job);
  size_t listRow(glsl::CollisionRules& rules, uint32_t entry, const glsl::ivec3& middle,
                 std::vector<ListedContact>& out) const;
  void listRun(glsl::CollisionRules& rules, uint32_t entry, const glsl::ivec3& row, size_t first, size_t end,
               std::vector<ListedContact>& out) const;
  uint32_t bucketOf(const glsl::ivec3& cell) const;
  void sortByCells(size_t entry, ListedContact* begin, ListedContact* end) const;

  float reach_m_, margin_m_, cell_m_;
  uint32_t most_in_bucket_, crowded_ = 0;
  size_t count_ = 0, searches_ = 0;
  std::vector<glsl::vec4> rest_;         ///< [active] rest positions
  std::vector<uint32_t> entry_of_;       ///< [active] entry of the node; kNobody: takes no part
  std::vector<Motion> motions_;          ///< [jobs over active]
  std::vector<uint32_t> shader_bucket_;  ///< [active] bucket of the shader's search; kNobody: may touch nothing
  std::vector<std::atomic<uint32_t>> in_shader_bucket_;  ///< [buckets] number of nodes
  std::vector<glsl::uvec4> entries_;                     ///< [active]
  std::vector<glsl::vec4> before_;                       ///< [active]
  std::vector<glsl::vec3> position_;                     ///< [active] by entry, like the arrays below
  std::vector<glsl::vec3> searched_at_;                  ///< positions at the last search
  std::vector<glsl::ivec3> shader_cell_;  ///< cell of the shader's search, which determines the order of contacts
  std::vector<glsl::ivec3> cell_;         ///< at the last search
  std::vector<uint32_t> bucket_starts_;   ///< [buckets + 1] hashed grid of the last search
  std::vector<uint32_t> in_bucket_;       ///< entries by bucket, ascending in each
  std::vector<glsl::vec3> bucket_positions_;
  std::vector<Run> runs_;
  std::vector<std::vector<ListedContact>> candidates_, contacts_;  ///< [jobs]
  std::vector<size_t> compared_;                                   ///< [jobs]
};

}  // namespace viscera
