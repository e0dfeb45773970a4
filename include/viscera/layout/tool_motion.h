// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// What styluses do in a substep.
#ifndef VISCERA_LAYOUT_TOOL_MOTION_H
#define VISCERA_LAYOUT_TOOL_MOTION_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
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

// What a kind of tool does to tissue, bits of ToolMotion.info.y
const uint kToolPushes = 1u;  // nodes out of a swept sphere at the tip
const uint kToolHolds = 2u;   // the nodes that it took when it began
const uint kToolCuts = 4u;    // springs that its blade crosses
const uint kToolErases = 8u;  // springs of the nodes near its blade
const uint kToolFeels = 16u;  // a tool that pushes counts the nodes within its reach and leaves them alone

// One stylus over one substep, tissue frame.
struct ToolMotion {
  vec4 from;         // xyz tip at the start, of tools that cut the near end of the blade [m]; w reach around it [m]
  vec4 to;           // xyz the same at the end [m]; w of tools that hold: largest node speed after release [m/s]
  vec4 orientation;  // quaternion xyzw at the end
  vec4 blade_from;   // xyz far end of the blade at the start [m]; w half thickness of the particle eraser [m]
  vec4 blade_to;     // xyz far end of the blade at the end [m]
  uvec4 info;        // x mode; y what it does: kTool... bits
  vec4 timing;       // x length of the substep before [s]; 0 where there was none
  uvec4 pad;         // two styluses make 256 bytes, the coarsest alignment of a uniform block
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
