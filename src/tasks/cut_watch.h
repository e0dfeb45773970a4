// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/fibre_state.h"
#include "viscera/solver/state.h"

namespace viscera {

/// A spring that was cut.
struct FreshCut {
  Vector3d at_m;  ///< position of the cut in the rest shape, tissue frame
  size_t body;
  uint32_t slot;  ///< one end, a slot of the body
};

/// Record of cut springs.
class CutWatch {
 public:
  /// @param model  must outlive this
  explicit CutWatch(const Model& model) : model_(model) {}
  /// Returns the springs that are cut and were whole at the last call. Springs against bending are left out.
  std::vector<FreshCut> fresh(const CutState& cuts);

 private:
  const Model& model_;
  std::vector<bool> seen_springs_, seen_axial_;
};

/// Connection of two positions of tissue by paths of intact springs.
class Joint {
 public:
  /// Uses the nodes nearest to both.
  /// @param part  name of the part that paths must not leave; empty: any path   @throws TaskError  the positions belong
  /// to different bodies; no body has the part
  Joint(const Model& model, const Vector3d& one_m, const Vector3d& other_m, const std::string& part = "");
  bool isApart(const CutState& cuts) const;

 private:
  const Model& model_;
  size_t body_ = 0;
  uint32_t one_ = 0, other_ = 0;
  uint16_t label_ = 0;  ///< of the part in the lattice; 0: any
};

/// Tissue of a lattice that is to be cut free from what holds it in space.
class HeldPiece {
 public:
  /// Uses the node nearest to the position. @throws TaskError  its body is no lattice, or nothing of it is held
  HeldPiece(const Model& model, const Vector3d& position_m);
  /// Returns whether no path of intact springs leads from the node to a held one, no fibre holds the piece, and it has
  /// at least half of the nodes of the node's part: a crumb around the node is none.
  bool isApart(const CutState& cuts, const std::vector<FibreState>& fibres) const;

 private:
  const Model& model_;
  size_t body_ = 0;
  uint32_t node_ = 0;
};

/// Test whether a disc is a piece by itself. No path of intact springs leads from the node nearest to its centre to a
/// node farther out than `outside_m`, and the piece has at least half of the disc.
class DiscPiece {
 public:
  /// @param normal  unit
  DiscPiece(const Model& model, const Vector3d& center_m, const Vector3d& normal, double radius_m, double outside_m);
  bool isApart(const CutState& cuts) const;

 private:
  enum class Zone : uint8_t { kNone, kDisc, kRim, kOutside };
  const Model& model_;
  size_t body_ = 0;
  uint32_t center_ = 0;
  std::vector<Zone> zones_;  ///< [slots of the body]
  size_t disc_nodes_ = 0;
};

}  // namespace viscera
