// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/coarse_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/multigrid/levels/coarse_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/targets.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Three columns of four floats and the next block's begin, which meets x's zero, are one vector of 16, or several.
void multiplyRowsOf(const multigrid::BlockRows& matrix, const float* x, float* y, bool subtract, size_t first,
                    size_t end) {
  constexpr size_t kBlock = 12, kColumns = 4;
  using Tag = hn::CappedTag<float, 16>;
  constexpr Tag tag;
  constexpr size_t kLanes = hn::MaxLanes(tag), kParts = 16 / kLanes;
  using V = hn::Vec<Tag>;
  alignas(64) int32_t which[16];  // lane of x that a lane of the block meets
  for (int i = 0; i < 16; ++i) which[i] = i / static_cast<int>(kColumns);
  const hn::RebindToSigned<Tag> words;
  using Meets = decltype(hn::IndicesFromVec(tag, hn::Zero(words)));
  Meets meets[kParts];
  for (size_t part = 0; part < kParts; ++part)
    meets[part] = hn::IndicesFromVec(tag, hn::Load(words, which + part * kLanes));
  for (size_t row = first; row < end; ++row) {
    V sums[kParts];
    for (V& sum : sums) sum = hn::Zero(tag);
    for (size_t i = matrix.starts[row]; i < matrix.starts[row + 1]; ++i) {
      const V quad = hn::LoadDup128(tag, x + kColumns * matrix.columns[i]);
      for (size_t part = 0; part < kParts; ++part)
        sums[part] = hn::MulAdd(hn::LoadU(tag, matrix.numbers + kBlock * i + part * kLanes),
                                hn::TableLookupLanes(quad, meets[part]), sums[part]);
    }
    alignas(64) float lanes[16];
    for (size_t part = 0; part < kParts; ++part) hn::Store(sums[part], tag, lanes + part * kLanes);
    float* const to = y + kColumns * row;
    for (size_t c = 0; c < 3; ++c) {
      const float sum = lanes[c] + lanes[4 + c] + lanes[8 + c];
      to[c] = subtract ? to[c] - sum : sum;
    }
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(multiplyRowsOf);

}  // namespace viscera::simd

namespace viscera::multigrid {

MultiplyRows multiplyRows() {
  using namespace simd;  // NOLINT: the table of HWY_EXPORT
  return VISCERA_KERNEL_FOR(multiplyRowsOf, hwy::SupportedAndGeneratedTargets().front());
}

}  // namespace viscera::multigrid
#endif  // HWY_ONCE
