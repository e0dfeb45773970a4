// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera::gpu {

/// This thread, and the threads of Mesa's software rasteriser where that draws, give way to all other threads of the
/// process: pictures take what stepping leaves of the processor. It cannot be taken back. Does nothing where the
/// system does not let it.
void drawInBackground();

}  // namespace viscera::gpu
