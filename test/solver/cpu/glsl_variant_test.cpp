// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// One text, compiled as C++ with features in either order: nothing of a variant reaches the next.
#include <gtest/gtest.h>

#include <type_traits>

#include "solver/cpu/text/glsl_kernel.h"

namespace viscera::glsl {
namespace {

struct CellKernel : Kernel {
  using Kernel::Kernel;
  uint cell_count = 0;
  vec4* cell_forces_out = nullptr;
};

#define VARIANT_NAME TearFirst
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/tissue/volume.comp"
#define VARIANT_FEATURES WITH_CUT | WITH_VOLUME
#define VARIANT_MEMBERS                     \
  uint corners() {                          \
    return cornerSlot(0u, 1u) + cell_count; \
  }
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME Forces
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/tissue/volume.comp"
#define VARIANT_FEATURES WITH_VOLUME
#include "solver/cpu/text/glsl_variant.inc"

#define VARIANT_NAME TearAfterwards
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/tissue/volume.comp"
#define VARIANT_FEATURES WITH_VOLUME | WITH_CUT
#include "solver/cpu/text/glsl_variant.inc"

#if defined(VOLUME) || defined(CUT) || defined(LATTICE) || defined(NETWORK) || defined(INOUT) || defined(precise) || \
    defined(FOR_EACH_SPRING) || defined(VARIANT_NAME) || defined(VARIANT_FEATURES) || defined(VARIANT_MEMBERS)
#error "a variant has left macros behind"
#endif

/// A kernel with feature CUT has a function torn(), one of variant TearFirst corners().
template <class Variant, class = void>
struct Tears : std::false_type {};
template <class Variant>
struct Tears<Variant, std::void_t<decltype(&Variant::torn)>> : std::true_type {};
template <class Variant, class = void>
struct HasCorners : std::false_type {};
template <class Variant>
struct HasCorners<Variant, std::void_t<decltype(&Variant::corners)>> : std::true_type {};

TEST(GlslVariant, HasItsOwnFeaturesWhateverStandsBefore) {
  EXPECT_TRUE(Tears<TearFirst>::value);
  EXPECT_FALSE(Tears<Forces>::value);
  EXPECT_TRUE(Tears<TearAfterwards>::value);
}

TEST(GlslVariant, HasItsOwnMembersAlone) {
  EXPECT_TRUE(HasCorners<TearFirst>::value);
  EXPECT_FALSE(HasCorners<Forces>::value);
  EXPECT_FALSE(HasCorners<TearAfterwards>::value);
}

}  // namespace
}  // namespace viscera::glsl
