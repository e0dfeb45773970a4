// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"
#include "viscera/model/scene/tool_mode.h"

namespace viscera {

// What the kinds of tools are told, each in a group of its own.
struct ProbeConfig {
  double radius_m = 0.006;
};
struct GrabConfig {
  double radius_m = 0.008;
  double release_speed_m_per_s = 0.5;
};
/// Where a blade lies on the axis of its stylus.
enum class BladeSide {
  kShaft,  ///< from the tip back along the shaft, +z
  kAhead,  ///< from the tip on, -z
  kBoth,   ///< on both sides of the tip, its length on each
};

struct CutConfig {
  double blade_length_m = 0.02;
  BladeSide blade_side = BladeSide::kShaft;
  double friction_n_per_m = 0;  ///< of both walls together, per length of blade in tissue
  double point_width_m = 0;     ///< of what the tip parts as the blade is pushed along itself; 0: it parts nothing
};
struct CutParticlesConfig {
  double eraser_radius_m = 0.002;
};

/// Two blades on a pivot, which is behind their tips, on the shaft; they open across it, along x of the stylus.
struct ScissorsConfig {
  double blade_length_m = 0.012;  ///< from the pivot to the tips
  double opening_deg = 40;        ///< from blade to blade, when they begin to close
  double closing_s = 0.3;
};

struct SuctionConfig {
  double radius_m = 0.006;
  double max_force_n = 1;
  double release_speed_m_per_s = 0.5;
};

/// Two jaws, which hold what is between them by friction.
struct GrasperConfig {
  double radius_m = 0.005;      ///< of what is between them, around the tip
  double jaw_length_m = 0.014;  ///< from the pivot to the tips; what has slid so far is lost
  double opening_deg = 40;      ///< from jaw to jaw, when they are open
  double max_force_n = 5;       ///< at more what they hold slides in them
  double release_speed_m_per_s = 0.5;
};

constexpr size_t kMostClips = 32;  ///< of all hands together, until a reset

/// Two jaws on a pivot, which open as scissors do and set a clip.
struct ClipConfig {
  double jaw_length_m = 0.012;  ///< from the pivot to the tips
  double opening_m = 0.012;     ///< between them
  double width_m = 0.002;       ///< of a clip, along y of the stylus
  double gap_m = 0.0005;        ///< between the legs of a clip that is closed
  double force_n = 10;          ///< with which it closes, and stays closed
  int magazine = 20;            ///< clips that there are
};

/// A heated tip, which pushes as a probe does while it burns (docs/lessons/cautery.md).
struct CauteryConfig {
  double radius_m = 0.003;  ///< of the tip
  double power_w = 30;      ///< into the tissue that it touches
};

struct StylusConfig {
  std::string name = "stylus";
  ToolMode idle = ToolMode::kProbe;
  ToolMode button1 = ToolMode::kGrab;
  ToolMode button2 = ToolMode::kCut;
  ProbeConfig probe;
  GrabConfig grab;
  CutConfig cut;  ///< its blade is that of cut_particles too
  CutParticlesConfig cut_particles;
  SuctionConfig suction;
  ScissorsConfig scissors;
  GrasperConfig grasper;
  ClipConfig clip;
  CauteryConfig cautery;
  double shaft_length_m = 0.12;  ///< that is drawn, from the tip back; nothing collides with it
  double jaw_closing_s = 0.2;    ///< from open to closed, of jaws that a button closes
  double max_force_n = 5;
  double max_force_rate_n_per_s = 100;
  double max_torque_nm = 0.2;
  double max_torque_rate_nm_per_s = 4;
  double stale_after_s = 0.2;
  double workspace_m = 1;
};

}  // namespace viscera
