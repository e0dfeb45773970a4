// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera {

/// @throws GpuError  the skins have more vertices than this thread's driver can hold in one buffer; names what makes
/// them coarser
void requireSkinFits(size_t vertices);

}  // namespace viscera
