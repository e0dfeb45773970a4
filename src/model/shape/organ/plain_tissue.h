// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "model/shape/organ/tissue.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

// Bodies defined by a few numbers.

std::unique_ptr<Tissue> boxTissue(const BodyConfig& config);
std::unique_ptr<Tissue> sheetTissue(const BodyConfig& config);
std::unique_ptr<Tissue> ballTissue(const BodyConfig& config);

}  // namespace viscera
