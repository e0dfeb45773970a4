// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// All that kernels and C++ share: for the text of kernels. C++ includes the parts that it needs.
#ifndef VISCERA_LAYOUT_H
#define VISCERA_LAYOUT_H
#include "layout/awake_bricks.h"
#include "layout/bindings.h"
#include "layout/edge_nodes.h"
#include "layout/law.h"
#include "layout/network_skin.h"
#include "layout/overlay.h"
#include "layout/surface_node.h"
#include "layout/surface_offsets.h"
#include "layout/touch_depths.h"
#include "layout/wind.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/links.h"
#include "viscera/layout/nodes.h"
#include "viscera/layout/obstacle_motion.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/layout/skin.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/layout/types.h"
#endif
