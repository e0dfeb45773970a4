// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/tool_mode.h"

namespace VISCERA_PUBLIC viscera {

// Parameters of the kinds of tools, one group for each.
struct ProbeConfig {
  double radius_m = 0.006;
};
struct GrabConfig {
  double radius_m = 0.008;
  double release_speed_m_per_s = 0.5;
};
/// Position of a blade on the axis of its stylus.
enum class BladeSide {
  kShaft,  ///< from the tip back along the shaft, +z
  kAhead,  ///< ahead of the tip, -z
  kBoth,   ///< on both sides of the tip, its length on each
};

struct CutConfig {
  double blade_length_m = 0.02;
  BladeSide blade_side = BladeSide::kShaft;
  double friction_n_per_m = 0;  ///< friction of both walls together, per length of blade in tissue [N/m]
  double point_width_m = 0;     ///< width of the cut that the tip makes along its axis [m]; 0: the tip does not cut
};
struct CutParticlesConfig {
  double eraser_radius_m = 0.002;
};

/// Two blades on a pivot, which is on the shaft behind the tips. They open across the shaft, along x of the stylus.
struct ScissorsConfig {
  double blade_length_m = 0.012;  ///< distance from the pivot to the tips [m]
  double opening_deg = 40;        ///< angle between the blades when they begin to close [deg]
  double closing_s = 0.3;
};

struct SuctionConfig {
  double radius_m = 0.006;
  double max_force_n = 1;
  double release_speed_m_per_s = 0.5;
};

/// Two jaws that hold the tissue between them by friction.
struct GrasperConfig {
  double radius_m = 0.005;      ///< radius around the tip of the region that the jaws hold [m]
  double jaw_length_m = 0.014;  ///< distance from the pivot to the tips [m]; tissue that slides this far is lost
  double opening_deg = 40;      ///< angle between the open jaws [deg]
  double max_force_n = 5;       ///< largest force before the held tissue slides in the jaws [N]
  double release_speed_m_per_s = 0.5;
};

constexpr size_t kMostClips = 32;  ///< clips of all styluses together, until a reset

/// Two jaws on a pivot, which open as scissors do and set a clip.
struct ClipConfig {
  double jaw_length_m = 0.012;  ///< distance from the pivot to the tips [m]
  double opening_m = 0.012;     ///< distance between the open jaws [m]
  double width_m = 0.002;       ///< width of a clip, along y of the stylus [m]
  double gap_m = 0.0005;        ///< gap between the legs of a closed clip [m]
  double force_n = 10;          ///< force with which a clip closes and stays closed [N]
  int magazine = 20;            ///< number of clips
};

/// Heated tip, which pushes like a probe while it burns (docs/lessons/instruments.md).
struct CauteryConfig {
  double radius_m = 0.003;  ///< radius of the tip [m]
  double power_w = 30;      ///< power into the tissue that it touches [W]
};

/// Motion of an instrument with a shaft that passes a point of the body wall (docs/lessons/instruments.md#trocars).
enum class TrocarMotion {
  kNone,    ///< no trocar
  kHandle,  ///< the handle follows the pose: sideways motion rotates the shaft about the point, reversed at the tip
  kTip      ///< the tip follows the pose, and the shaft turns towards the point
};

struct TrocarConfig {
  TrocarMotion follows = TrocarMotion::kNone;
  Vector3d position_m = Vector3d::Zero();  ///< point that the axis of the shaft passes, tissue frame [m]
};

struct StylusConfig {
  std::string name = "stylus";
  ToolMode idle = ToolMode::kProbe;
  ToolMode button1 = ToolMode::kGrab;
  ToolMode button2 = ToolMode::kCut;
  ProbeConfig probe;
  GrabConfig grab;
  CutConfig cut;  ///< its blade is also that of cut_particles
  CutParticlesConfig cut_particles;
  SuctionConfig suction;
  ScissorsConfig scissors;
  GrasperConfig grasper;
  ClipConfig clip;
  CauteryConfig cautery;
  double shaft_length_m = 0.12;  ///< length of the shaft, from the tip back [m]
  double shaft_radius_m = 0;     ///< radius of the shaft [m]; 0: a fortieth of its length
  bool shaft_contact = false;    ///< tissue is pushed by the whole shaft, not by the tip alone
  TrocarConfig trocar;
  double jaw_closing_s = 0.2;  ///< time from open to closed, for jaws that a button closes [s]
  double max_force_n = 5;
  double max_force_rate_n_per_s = 100;
  double max_torque_nm = 0.2;
  double max_torque_rate_nm_per_s = 4;
  double stale_after_s = 0.2;
  double workspace_m = 1;
};

}  // namespace viscera
