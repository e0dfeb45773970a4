// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/gallbladder_variant.h"

#include <cstdint>
#include <random>

namespace viscera {
namespace {

constexpr int kNamed = 5;               ///< seeds below have a fixed meaning
constexpr double kShortJunction = -33;  ///< height of the junction with a short duct

/// Numbers of one seed. Distributions of the standard library differ between machines; its engine does not.
class Draw {
 public:
  explicit Draw(int seed) : engine_(static_cast<uint32_t>(seed)) { engine_.discard(1); }
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  bool happens(double share) { return between(0, 1) < share; }

 private:
  std::mt19937 engine_;
};

}  // namespace

GallbladderVariant gallbladderVariant(int seed) {
  GallbladderVariant out;
  if (seed < kNamed) {
    out.short_duct = seed == 1;
    out.artery_in_front = seed == 2;
    out.two_arteries = seed == 3;
    out.inflamed = seed == 4;
  } else {
    Draw draw(seed);
    out.short_duct = draw.happens(0.15);
    out.artery_in_front = draw.happens(0.2);
    out.two_arteries = draw.happens(0.15);
    out.inflamed = draw.happens(0.25);
    out.width = draw.between(0.9, 1.1);
    out.duct_radius = draw.between(1.3, 1.9);
    out.artery_radius = draw.between(0.9, 1.1);
    out.junction_z = draw.between(-46, -38);
  }
  if (out.short_duct) out.junction_z = kShortJunction;
  return out;
}

}  // namespace viscera
