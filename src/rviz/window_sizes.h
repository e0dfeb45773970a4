// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera::rviz_plugin {

/// Makes Mesa query the size of each Ogre window that is new since the last call: rviz's own, and those of Image and
/// Camera displays. Call it on the drawing thread before they are drawn.
///
/// On a software renderer rviz may create a context before the X server has the window. Mesa then keeps an arbitrary
/// size, even a height of 0, until the first swap, and writes beyond buffers of that size. rviz then occasionally ended
/// with SIGSEGV or SIGABRT, more often on a busy machine.
void renewWindowSizes();

}  // namespace viscera::rviz_plugin
