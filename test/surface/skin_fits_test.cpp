// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/skin_fits.h"

#include <gtest/gtest.h>

#include "gpu/limits.h"
#include "support/text.h"
#include "viscera/layout/skin.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

TEST(SkinFits, ASkinThatIsTooFineIsToldHowManyFacesItMayHave) {
  gpu::Limits limits;
  limits.storage_block_bytes = 1000 * sizeof(layout::SkinBinding) + 5;
  gpu::pretendDriverLimits(limits);
  EXPECT_NO_THROW(requireSkinFits(1000, false));
  EXPECT_TRUE(test::says(test::messageOf<GpuError>([] { requireSkinFits(1001, false); }),
                         {"1001 vertices", "at most 1000", "bodies[].skin_faces", "1600", "--no-view"}));
  EXPECT_NO_THROW(requireSkinFits(500, true));  // wounds have as many vertices again
  EXPECT_TRUE(test::says(test::messageOf<GpuError>([] { requireSkinFits(501, true); }),
                         {"501 vertices", "at most 500 where tissue can be cut", "bodies[].skin_faces", "800"}));
  gpu::clearDriverLimits();
}

}  // namespace
}  // namespace viscera
