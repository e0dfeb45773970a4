// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/similarity.h"

#include <gtest/gtest.h>

namespace viscera::bench {
namespace {

constexpr int kSide = 40;
constexpr double kRounding = 1e-9;

/// Returns stripes of a given width, with a border of 8 pixels.
std::vector<uint8_t> stripes(int width_px, int bright) {
  std::vector<uint8_t> out;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool inside = x >= 8 && y >= 8 && x < kSide - 8 && y < kSide - 8;
      out.insert(out.end(), 3, static_cast<uint8_t>(inside ? x / width_px % 2 ? bright : 60 : 20));
    }
  }
  return out;
}

TEST(Similarity, IsOneForTheSamePictureAndLessForOthers) {
  const std::vector<uint8_t> of = stripes(2, 200);
  EXPECT_NEAR(similarity(of, of, kSide, kSide).all, 1, kRounding);
  EXPECT_NEAR(similarity(of, of, kSide, kSide).seen, 1, kRounding);
  const Similarity nearly = similarity(stripes(2, 190), of, kSide, kSide),
                   other = similarity(stripes(3, 200), of, kSide, kSide);
  EXPECT_GT(nearly.all, 0.98);
  EXPECT_LT(other.all, 0.8);
  EXPECT_LT(other.seen, other.all) << "the border is alike";
}

/// In uniform pictures the formula reduces to the ratio of their means.
TEST(Similarity, OfEvenPicturesIsThatOfTheirMeans) {
  const std::vector<uint8_t> a(size_t{3} * kSide * kSide, 100), b(size_t{3} * kSide * kSide, 120);
  const double c = 2.55 * 2.55;
  EXPECT_NEAR(similarity(a, b, kSide, kSide).all, (2 * 100 * 120 + c) / (100 * 100 + 120 * 120 + c), kRounding);
}

}  // namespace
}  // namespace viscera::bench
