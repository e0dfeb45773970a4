// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"

namespace viscera {

/// What threads are made of (docs/thread.md 3), and which sizes of the United States Pharmacopeia they have.
enum class ThreadMaterial { kSilk, kNylon, kPolypropylene };
enum class ThreadSize { kUsp2, kUsp3, kUsp4, kUsp5, kUsp6 };
enum class ThreadEnd { kFree, kFixed };

/// A place that a thread goes through at first.
struct ThreadPlace {
  Vector3d position_m = Vector3d::Zero();
};

/// Tissue at rest that a thread goes through at first.
struct ThreadChannelConfig {
  std::string body;  ///< empty: the first
  Vector3d position_m = Vector3d::Zero();
};
enum class StitchedTissue { kPhantom, kBowel, kFascia };

enum class NeedleArc { kNone, kHalfCircle, kThreeEighths };

/// A needle on the start of a thread (docs/thread.md 6). What is 0 follows from the tissue's Young's modulus.
struct NeedleConfig {
  NeedleArc arc = NeedleArc::kNone;
  double radius_m = 0.008;  ///< of the arc
  double wire_radius_m = 0.00025;
  double puncture_n = 0;
  double cutting_n = 0;
  double friction_n_per_m = 0;
  Vector3d rotation_deg = Vector3d::Zero();  ///< at first
};

/// Pieces of all threads of a session beyond those of its scene, at most: they are not parted any more then.
constexpr size_t kMostParted = 16;

/// A thread that does not stretch.
struct ThreadConfig {
  std::string name = "thread";
  ThreadMaterial material = ThreadMaterial::kNylon;
  ThreadSize usp = ThreadSize::kUsp3;
  double radius_m = 0;          ///< 0: of usp
  double young_modulus_pa = 0;  ///< 0: of the material, as the next two
  double density_kg_per_m3 = 0;
  double bending_share = 0;  ///< of the bending of a solid thread
  double drag_per_s = 4;
  double length_m = 0;  ///< 0: of its path
  double spacing_m = 0.00075;
  Vector3d position_m = Vector3d::Zero();
  std::vector<ThreadPlace> path;  ///< from there through these: one place at least
  ThreadEnd start = ThreadEnd::kFree, end = ThreadEnd::kFree;
  std::vector<ThreadChannelConfig> channels;  ///< in the order of the path
  double friction = 0.1;                      ///< in channels
  double through_n_per_m = 0;                 ///< 0: by Young's modulus of the tissue
  double pull_out_n = 0;                      ///< 0: of `tissue`, with the next two
  StitchedTissue tissue = StitchedTissue::kPhantom;
  double bite_m = 0.0045, depth_m = 0.006;
  NeedleConfig needle;          ///< on its start
  std::vector<ThreadTie> ties;  ///< in the order of their times
  bool feelsTissue() const { return !channels.empty() || needle.arc != NeedleArc::kNone; }
};

}  // namespace viscera
