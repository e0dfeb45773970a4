// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera::gpu {

/// Lowers the priority of this thread, and of the threads of Mesa's software rasteriser where that draws, below all
/// other threads of the process: images take what stepping leaves of the processor. It cannot be undone. Does nothing
/// where the system does not permit it.
void drawInBackground();

}  // namespace viscera::gpu
