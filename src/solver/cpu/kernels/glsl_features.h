// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Features of shaders that are compiled as C++, for VARIANT_FEATURES of glsl_variant.inc. They are bits that the
// preprocessor can test and that C++ knows too, so that an unknown feature is an error. WITH_X defines X.
#define WITH_NOTHING 0
#define WITH_BODY_FORCES (1 << 0)
#define WITH_COLLISIONS (1 << 1)
#define WITH_COMPENSATED (1 << 2)
#define WITH_CUT (1 << 3)
#define WITH_DASHPOT (1 << 4)
#define WITH_MIXED (1 << 6)
#define WITH_OBSTACLES (1 << 7)
#define WITH_PARTICLES (1 << 8)
#define WITH_RATE (1 << 9)
#define WITH_REBUILD (1 << 10)
#define WITH_RELEASE (1 << 11)
#define WITH_TOOLS (1 << 13)
#define WITH_WIND (1 << 15)
#define WITH_CONTACT (1 << 20)
#define WITH_BEFORE (1 << 21)
#define WITH_AHEAD (1 << 22)
#define WITH_PAIRS (1 << 23)
#define WITH_RECORD (1 << 24)
#define WITH_SUMMED (1 << 26)
#define WITH_SKINS (1 << 25)  // every kind of binding of map_skin.comp
