// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera::rviz_plugin {

/// Makes Mesa ask again for the size of each window of Ogre's that is new since the last call: rviz's own, and those of
/// Image and Camera displays. Call it before they are drawn, in the thread that draws.
///
/// On a software renderer rviz may make a context before the X server has the window. Mesa then keeps an accidental
/// size, of height 0 too, up to the first swap, and writes beyond buffers of that size: rviz ended by SIGSEGV or
/// SIGABRT, seldom, more often on a busy machine.
void renewWindowSizes();

}  // namespace viscera::rviz_plugin
