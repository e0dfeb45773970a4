// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Motions of styluses over a substep.
#ifndef VISCERA_LAYOUT_TOOL_MOTION_H
#define VISCERA_LAYOUT_TOOL_MOTION_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace VISCERA_PUBLIC viscera { namespace layout {
#endif

// Tool modes, as in ToolMotion.info.x
const uint kModeNone = 0u;
const uint kModeProbe = 1u;
const uint kModeGrab = 2u;
const uint kModeCut = 3u;
const uint kModeCutParticles = 4u;
const uint kModeSuction = 5u;
const uint kModeNeedle = 6u;
const uint kModeScissors = 7u;
const uint kModeGrasper = 8u;
const uint kModeClip = 9u;
const uint kModeCautery = 10u;

// Effects of a kind of tool on tissue, bits of ToolMotion.info.y
const uint kToolPushes = 1u;  // pushes nodes out of a swept sphere at the tip
const uint kToolHolds = 2u;  // holds the nodes that it took when it began
const uint kToolCuts = 4u;  // cuts the springs that its blade crosses
const uint kToolErases = 8u;  // erases the springs of the nodes near its blade
const uint kToolFeels = 16u;  // only counts the nodes within its reach and leaves them alone; for a tip or shaft that pushes
const uint kToolShaft = 32u;  // pushes nodes out of its shaft, a swept capsule

// Motion of one stylus over one substep, tissue frame.
struct ToolMotion {
  vec4 from;  // xyz tip at the start, or the near end of the blade of a tool that cuts [m]; w reach around it [m]
  vec4 to;  // xyz the same at the end [m]; w largest node speed after release, of tools that hold [m/s]
  vec4 orientation;  // quaternion xyzw of the stylus at the end
  vec4 blade_from;   // xyz far end of the blade at the start [m]; w half thickness of the particle eraser [m]
  vec4 blade_to;     // xyz far end of the blade at the end [m]
  uvec4 info;  // x mode; y effects on tissue: kTool... bits
  vec4 timing;  // x length of the previous substep [s]; 0 where there was none
  vec4 shaft_from;      // xyz near end of the shaft's axis at the start [m]; w its radius [m]
  vec4 shaft_to;        // xyz near end of the shaft's axis at the end [m]
  vec4 shaft_far_from;  // xyz far end of the shaft's axis at the start [m]; differs from the near end
  vec4 shaft_far_to;    // xyz far end of the shaft's axis at the end [m]
  uvec4 pad[5];  // pads a stylus to 256 bytes, the coarsest alignment of a uniform block
};

#ifdef __cplusplus
}}  // namespace viscera::layout
#endif
#endif
