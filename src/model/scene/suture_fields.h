// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/field_ranges.h"
#include "viscera/model/scene/attachment_config.h"
#include "viscera/model/scene/knot_kind.h"
#include "viscera/model/scene/suture_config.h"

namespace viscera {

// Scene keys of sutures and attachments (scene_fields.h).

template <class V>
void visitFields(V& v, SuturePathPoint& c) {
  v.vector("position_m", c.position_m, kCoordinate, "m", "position of the point in the tissue frame");
}

template <class V>
void visitFields(V& v, SutureChannelConfig& c) {
  v.text("body", c.body, "name of the body; empty: the first");
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "position of the point at rest in the tissue frame; the suture passes within a link of it");
}

template <class V>
void visitFields(V& v, NeedleConfig& c) {
  v.choice("arc", c.arc,
           {{"none", NeedleArc::kNone},
            {"half_circle", NeedleArc::kHalfCircle},
            {"three_eighths", NeedleArc::kThreeEighths}},
           "arc of a circle that the needle forms; none: no needle");
  v.number("radius_m", c.radius_m, {1e-3, 0.1}, "m", "radius of the needle's circle");
  v.number("wire_radius_m", c.wire_radius_m, {5e-5, 2e-3}, "m",
           "half the thickness of the needle; at most 0.2 times the radius of its circle");
  v.number("puncture_n", c.puncture_n, {0, 100}, "N", "force at which the surface yields to the tip; 0: 5 mm2 times E");
  v.number("cutting_n", c.cutting_n, {0, 100}, "N",
           "force on the tip inside tissue; 0: a third of puncture_n; not above puncture_n");
  v.number("friction_n_per_m", c.friction_n_per_m, {0, 1e5}, "N/m",
           "friction along the shaft, per length in tissue; 0: 0.1 mm times E");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg",
           "initial rotation: turns about the fixed x, then y, then z axis; unrotated, the arc is about y, and its tip "
           "is on x and points along z");
}

inline Choices<KnotKind> knotChoices() {
  Choices<KnotKind> out;
  for (size_t k = 1; k < kKnotNames.size(); ++k) out.push_back({kKnotNames[k], static_cast<KnotKind>(k)});
  return out;
}

template <class V>
void visitFields(V& v, SutureTie& c) {
  v.number("at_s", c.at_s, {0, 1e5}, "s", "time from the start or a reset at which the two tails are brought together");
  v.choice("knot", c.knot, knotChoices(), "kind of knot");
  v.number("tension_n", c.tension_n, {1e-3, 100}, "N", "tension to which the loop is tightened before it is tied");
  v.number("holds_n", c.holds_n, {0, 1000}, "N",
           "tension above which the knot slips; 0: by knot and suture (docs/physics.md 14)");
  v.choice("to", c.to, {{"other_tail", TieTo::kOtherTail}, {"strand", TieTo::kStrand}},
           "object that a tail is tied to: the other tail, or a strand for the nearer tail, as at the end of a running "
           "suture");
  v.vector("strand_m", c.strand_m, kCoordinate, "m",
           "position that selects the strand: the one outside of tissue that is nearest to it");
}

template <class V>
void visitFields(V& v, SutureConfig& c) {
  const Choices<SutureEnd> ends = {{"free", SutureEnd::kFree}, {"fixed", SutureEnd::kFixed}};
  v.text("name", c.name, "name of the suture, unique");
  v.choice("material", c.material,
           {{"silk", SutureMaterial::kSilk},
            {"nylon", SutureMaterial::kNylon},
            {"polypropylene", SutureMaterial::kPolypropylene}},
           "material of the suture: gives Young's modulus, density and bending share if they are 0 (docs/sutures.md)");
  v.choice("usp", c.usp,
           {{"2-0", SutureSize::kUsp2},
            {"3-0", SutureSize::kUsp3},
            {"4-0", SutureSize::kUsp4},
            {"5-0", SutureSize::kUsp5},
            {"6-0", SutureSize::kUsp6}},
           "USP size, used if radius_m is 0");
  v.number("radius_m", c.radius_m, {0, 2e-3}, "m", "radius; 0: that of the USP size");
  v.number("young_modulus_pa", c.young_modulus_pa, {0, 1e12}, "Pa",
           "Young's modulus for bending; 0: that of the material");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {0, 2e4}, "kg/m3", "mass density; 0: that of the material");
  v.number("bending_share", c.bending_share, {0, 1}, "1",
           "bending stiffness over that of a solid suture; a braid has less; 0: that of the material");
  v.number("mass_damping_per_s", c.mass_damping_per_s, {0, 1e4}, "1/s",
           "mass-proportional damping rate: loss of speed to the air");
  v.number("length_m", c.length_m, kLength, "m",
           "length; beyond its path the suture continues straight; 0: that of the path");
  v.number("spacing_m", c.spacing_m, {1e-4, 0.1}, "m", "length of the links");
  v.vector("position_m", c.position_m, kCoordinate, "m", "position of the start in the tissue frame");
  v.list("path", c.path, 1000,
         "points that the suture initially passes through from its start, in straight lines; at least one");
  v.choice("start", c.start, ends, "state of the end at position_m: free, or fixed in place");
  v.choice("end", c.end, ends, "state of the other end: free, or fixed in place");
  v.list("channels", c.channels, 200,
         "suture track: points of tissue that the suture initially passes through, in the order of its path, a link or "
         "more apart (docs/physics.md 15)");
  v.number("friction", c.friction, {0, 2}, "1", "friction coefficient in the suture track, as of a rope on a drum");
  v.number("through_n_per_m", c.through_n_per_m, {0, 1e4}, "N/m",
           "friction per length in tissue; 0: 0.1 mm times Young's modulus of the tissue");
  v.number("pull_out_n", c.pull_out_n, {0, 1e3}, "N",
           "force at a point of the suture track above which the tissue tears; 0: that of `tissue`");
  v.choice(
      "tissue", c.tissue,
      {{"phantom", StitchedTissue::kPhantom}, {"bowel", StitchedTissue::kBowel}, {"fascia", StitchedTissue::kFascia}},
      "tissue that tears: bowel at 4.6 N; fascia at 45 N per mm of bite_m; phantom at Young's modulus x bite_m x "
      "depth_m");
  v.number("bite_m", c.bite_m, {1e-4, 0.1}, "m", "distance from the wound to the point where a stitch enters");
  v.number("depth_m", c.depth_m, {1e-4, 0.1}, "m", "depth of a stitch in the tissue");
  v.group("needle", c.needle,
          "needle on the start of the suture, which is then free; its tail is at position_m (docs/sutures.md)");
  v.list("ties", c.ties, 16, "knots that are tied without a stylus, in the order of their times (docs/physics.md 14)");
}

constexpr double kMostAttachments = 32;

template <class V>
void visitFields(V& v, AttachmentConfig& c) {
  v.text("body_a", c.body_a, "name of the first body, of structure lattice");
  v.text("body_b", c.body_b, "name of the second body, of structure lattice");
  v.number("reach_m", c.reach_m, {1e-5, 0.1}, "m",
           "largest distance at rest of facing surface points that a fibre joins; at most twice the finer spacing");
  v.number(
      "modulus_pa", c.modulus_pa, {1, 1e9}, "Pa",
      "Young's modulus of the connective tissue; modulus_pa / thickness_m is its stiffness per area, limited to 10 "
      "times Young's modulus of the softer body over the finer spacing, and near light nodes (docs/physics.md 17)");
  v.number("thickness_m", c.thickness_m, {1e-5, 0.1}, "m",
           "thickness of the connective tissue; blades cut it within half of this on either side");
  v.number("toughness_j_per_m2", c.toughness_j_per_m2, {0.01, 1e5}, "J/m2", "work per area that separates the bodies");
  v.number("strength_pa", c.strength_pa, {1, 1e8}, "Pa",
           "largest traction, after which the traction falls until the bodies are separate; less where stiffness and "
           "toughness do not allow it");
}

}  // namespace viscera
