// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/similarity.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace viscera::bench {

namespace {

constexpr int kReach = 5;                                            // radius of the window [pixels]
constexpr double kSigma_px = 1.5;                                    // standard deviation of the window
constexpr double kLuminance = 2.55 * 2.55, kContrast = 7.65 * 7.65;  // (0.01 and 0.03 of 255) squared

using Plane = std::vector<double>;

Plane luma(const std::vector<uint8_t>& rgb) {
  Plane out(rgb.size() / 3);
  for (size_t i = 0; i < out.size(); ++i) out[i] = 0.299 * rgb[3 * i] + 0.587 * rgb[3 * i + 1] + 0.114 * rgb[3 * i + 2];
  return out;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), [](double x, double y) { return x * y; });
  return out;
}

/// Returns means over the window; pixels repeat at borders.
Plane smoothed(const Plane& plane, int width, int height) {
  std::array<double, 2 * kReach + 1> weights{};
  double sum = 0;
  for (int i = -kReach; i <= kReach; ++i)
    sum += weights[static_cast<size_t>(i + kReach)] = std::exp(-i * i / (2 * kSigma_px * kSigma_px));
  const auto along = [&](const Plane& from, int step_x, int step_y) {
    Plane out(from.size());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double total = 0;
        for (int i = -kReach; i <= kReach; ++i) {
          const int column = std::clamp(x + i * step_x, 0, width - 1), row = std::clamp(y + i * step_y, 0, height - 1);
          total += weights[static_cast<size_t>(i + kReach)] * from[static_cast<size_t>(row) * width + column];
        }
        out[static_cast<size_t>(y) * width + x] = total / sum;
      }
    }
    return out;
  };
  return along(along(plane, 1, 0), 0, 1);
}

}  // namespace

Similarity similarity(const std::vector<uint8_t>& rgb, const std::vector<uint8_t>& reference, int width, int height) {
  const Plane a = luma(rgb), b = luma(reference);
  const Plane mean_a = smoothed(a, width, height), mean_b = smoothed(b, width, height);
  const Plane aa = smoothed(product(a, a), width, height), bb = smoothed(product(b, b), width, height),
              ab = smoothed(product(a, b), width, height);
  double all = 0, seen = 0;
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double ma = mean_a[i], mb = mean_b[i];
    const double value = (2 * ma * mb + kLuminance) * (2 * (ab[i] - ma * mb) + kContrast) /
                         ((ma * ma + mb * mb + kLuminance) * (aa[i] - ma * ma + bb[i] - mb * mb + kContrast));
    all += value;
    if (std::equal(&reference[3 * i], &reference[3 * i] + 3, reference.begin())) continue;
    seen += value;
    ++count;
  }
  Similarity out;
  out.all = all / static_cast<double>(a.size());
  if (count > 0) out.seen = seen / static_cast<double>(count);
  return out;
}

}  // namespace viscera::bench
