// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Effects of tools of mode cautery since the last reset (docs/lessons/instruments.md). given_j is the sum of the four
/// members below it.
struct BurnReport {
  double given_j = 0;        ///< heat from tips [J]
  double stored_j = 0;       ///< heat in the tissue above body temperature [J], without that of water that boiled off
  double steam_j = 0;        ///< heat lost with water that boiled off [J]
  double perfused_j = 0;     ///< heat carried away by blood [J]
  double surface_j = 0;      ///< heat lost to the air [J]
  double hottest_c = 37;     ///< highest temperature of any node now [deg C]
  double coagulated_m3 = 0;  ///< volume of tissue that is coagulated by more than 63 % [m3]
  uint64_t parted = 0;       ///< number of nodes that lost their springs when their water boiled
};

}  // namespace viscera
