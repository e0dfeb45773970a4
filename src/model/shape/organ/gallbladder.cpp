// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Seen from the front, with the liver lifted: +x is the patient's left, -y faces the viewer, the fundus is at +z. The
// gallbladder hangs in front of the liver. Its neck leads to the cystic duct, which joins the common duct on its way
// down. Solids are added with small fillets, then the hollows of the gallbladder and of the common duct are subtracted.
// Bodies of their own may have the liver, the fat, and the rest: they meet without gaps.
// Lengths are millimetres of a gallbladder of 80 mm.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "model/shape/organ/gallbladder_variant.h"
#include "model/shape/organ/phantom.h"
#include "model/shape/organ/phantom_shapes.h"
#include "model/shape/organ/strand.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// In order of precedence: vertices between parts have the colour of the first, so that strands keep their width.
enum GallbladderPart : uint16_t {
  kCysticArtery,
  kHepaticArtery,
  kCysticDuct,
  kCommonHepaticDuct,
  kCommonBileDuct,
  kInfundibulum,
  kGallbladder,
  kGallbladderBed,
  kPeritoneum,
  kFatPart,
  kLiverCapsule,
  kLiver,
  kPartCount
};
struct PartLook {
  const char* name;
  Vector3d color;  ///< sRGB, by eye
};
const std::array<PartLook, kPartCount> kGallbladderParts = {{{"cystic_artery", {0.80, 0.16, 0.14}},
                                                             {"hepatic_artery", {0.74, 0.13, 0.12}},
                                                             {"cystic_duct", {0.80, 0.78, 0.62}},
                                                             {"common_hepatic_duct", {0.60, 0.66, 0.50}},
                                                             {"common_bile_duct", {0.60, 0.66, 0.50}},
                                                             {"infundibulum", {0.55, 0.60, 0.46}},
                                                             {"gallbladder", {0.50, 0.57, 0.44}},
                                                             {"gallbladder_bed", {0.80, 0.66, 0.50}},
                                                             {"peritoneum", {0.92, 0.76, 0.52}},
                                                             {"fat", {0.93, 0.78, 0.38}},
                                                             {"liver_capsule", {0.58, 0.23, 0.18}},
                                                             {"liver", {0.56, 0.22, 0.17}}}};

constexpr double kLength = 80;         ///< from the top of the fundus to the lowest point of the infundibulum
constexpr double kFar = 7;             ///< wider than any fillet: farther strands have no effect
constexpr double kWall = 2.5;          ///< of the gallbladder
constexpr double kInflamedWall = 1.6;  ///< factor on it
constexpr double kDuctWall = 1.5;      ///< of the common duct, thicker than a real one: no cell is as thin
constexpr double kBed = 2.5;           ///< thickness of the loose tissue between gallbladder and liver
constexpr double kCapsuleDepth = 1, kPeritoneumDepth = 1;
constexpr double kFloor = -62;   ///< height at which ducts, vessels and the fat around them end
constexpr double kSheath = 0.4;  ///< depth of the fillet around a strand that counts as the strand
constexpr double kFillet = 1.2, kWideFillet = 3;
/// Distance from its axis, in cells, within which a strand owns tissue. A cell that its axis passes through has its
/// centre within 0.87 and takes the part of most of it, so that a strand thinner than a cell is one connected part.
constexpr double kOwnCells = 1.15;

const Vector3d kLow(-48, -31, kFloor), kHigh(52, 17, 48);

double waves(const Vector3d& p) {
  return (std::sin(0.9 * p.x() + 0.4 * p.z()) + std::sin(0.7 * p.z() - 0.5 * p.x() + 1) +
          std::sin(0.8 * p.y() + 0.6 * p.z() + 2)) /
         3;
}

/// Sections into which bodies divide the anatomy.
enum Section : uint16_t { kOrgan, kFatSection, kLiverSection, kSectionCount };
constexpr Section sectionOf(uint16_t part) {
  return part == kLiver || part == kLiverCapsule   ? kLiverSection
         : part == kFatPart || part == kPeritoneum ? kFatSection
                                                   : kOrgan;
}
using Sections = std::array<bool, kSectionCount>;

/// Returns the sections that consist of some parts. @param parts  names; none: all
/// @throws SceneError  a name is unknown, or a section lacks a part
Sections sectionsOf(const std::vector<std::string>& parts) {
  if (parts.empty()) return {true, true, true};
  std::array<bool, kPartCount> wanted{};
  std::string known;
  for (const PartLook& part : kGallbladderParts) known += (known.empty() ? "" : ", ") + std::string(part.name);
  for (const std::string& name : parts) {
    const auto is = [&](const PartLook& part) { return part.name == name; };
    const auto found = std::find_if(kGallbladderParts.begin(), kGallbladderParts.end(), is);
    if (found == kGallbladderParts.end())
      throw SceneError("scan.labels must be parts of the gallbladder, of " + known + "; found '" + name + "'");
    wanted[static_cast<size_t>(found - kGallbladderParts.begin())] = true;
  }
  Sections out{};
  for (uint16_t part = 0; part < kPartCount; ++part) out[sectionOf(part)] |= wanted[part];
  for (uint16_t part = 0; part < kPartCount; ++part) {
    if (out[sectionOf(part)] && !wanted[part])
      throw SceneError(
          "scan.labels of a gallbladder must have liver and liver_capsule together, fat and peritoneum "
          "together, and all other parts together; '" +
          std::string(kGallbladderParts[part].name) + "' is missing");
  }
  return out;
}

/// Gallbladder and the tissue around it, for one variant.
class Gallbladder {
 public:
  Gallbladder(const GallbladderVariant& variant, double wall_scale, const Sections& sections);

  /// @param cell  edge of the cells that strands are to own, see kOwnCells; 0: strands own what they consist of
  LabelledDistance at(const Vector3d& p, double cell) const;

 private:
  struct Nearby;

  double wall() const { return wall_scale_ * kWall * (variant_.inflamed ? kInflamedWall : 1); }
  double aside() const { return variant_.short_duct ? -9 : 0; }
  double outerWall(const Vector3d& p) const;
  Vector3d onWall(Vector3d p) const;
  void addGallbladder();
  void addDucts();
  void addArteries();
  double liver(const Vector3d& p) const;
  double front(double z) const;
  double triangle(const Vector3d& p) const;
  double fat(const Vector3d& p) const;
  uint16_t partOf(const Vector3d& p, const Nearby& near) const;
  double border(const Nearby& near) const;

  GallbladderVariant variant_;
  double wall_scale_;
  Sections sections_;
  Strand body_, pouch_, cystic_duct_, hepatic_duct_, bile_duct_, hepatic_artery_, second_artery_, cystic_artery_,
      ligament_;
};

/// Distances of a point to all solids.
struct Gallbladder::Nearby {
  double gallbladder, liver, bed, fat;
  std::array<std::pair<Strand::Nearest, GallbladderPart>, 6> strands;
  double cell;
};

Gallbladder::Gallbladder(const GallbladderVariant& variant, double wall_scale, const Sections& sections)
    : variant_(variant), wall_scale_(wall_scale), sections_(sections) {
  addGallbladder();
  addDucts();
  addArteries();
}

void Gallbladder::addGallbladder() {
  const double w = variant_.width;
  body_ = Strand({{{-14, -13, 46 - 13.5 * w}, 13.5 * w},
                  {{-11.5, -10, 20}, 15.5 * w},
                  {{-7, -8.5, 5}, 14.2 * w},
                  {{-3, -8.5, -9}, 11 * w},
                  {{0, -9.5, -18}, 8 * w}},
                 kFar);
  pouch_ = Strand({{{0, -12, -34 + 9.5 * w}, 9.5 * w}, {{8, -11, -24.5}, 4.8}, {{13, -10, -25.5}, 2.6}}, kFar);
}

void Gallbladder::addDucts() {
  const double s = aside(), z = variant_.junction_z;
  const Vector3d junction(30.5 + s, -7, z);
  cystic_duct_ = Strand({{{11, -10.5, -25.2}, variant_.duct_radius},
                         {{16 + 0.2 * s, -9.8, -26.5}, variant_.duct_radius},
                         {{23 + 0.6 * s, -8.6, -25.5 + 0.5 * (z + 25.5) - 1}, variant_.duct_radius},
                         {junction, variant_.duct_radius}},
                        kFar);
  hepatic_duct_ =
      Strand({{{25 + 0.5 * s, 9, 5}, 3}, {{28 + s, -3, -12}, 3}, {{30 + s, -6, -26}, 3}, {junction, 3.2}}, kFar);
  bile_duct_ = Strand({{junction, 3.2}, {{30 + 0.7 * s, -5, z - 9}, 3.3}, {{29, -2, kFloor - 6}, 3.3}}, kFar);
  ligament_ = Strand({{{33, 0, -55}, 8.5}, {{33, 0, kFloor - 6}, 11}}, kFar);
}

void Gallbladder::addArteries() {
  const double s = 0.6 * aside(), in_front = variant_.artery_in_front ? 1 : 0;
  const double cross_y = in_front > 0 ? -11.2 : 1.4;
  const Vector3d origin(21.5 + s, in_front > 0 ? -6.5 : -3.5, -13), deep(17 + s, -1, -7);
  hepatic_artery_ = Strand({{{40, -2, kFloor - 6}, 1.6},
                            {{38.5, 0 - 4 * in_front, -46}, 1.6},
                            {{36.5 + s, 1 - 8 * in_front, -33}, 1.6},
                            {{30 + aside(), cross_y, -20}, 1.6},
                            {origin, 1.6},
                            {deep, 1.5},
                            {{13 + s, 6, -1}, 1.4}},
                           kFar);
  const double r = variant_.artery_radius;
  const Vector3d entry = onWall({9.5, -8.5, -7.5});
  std::vector<Strand::Knot> path = {{origin, r}, {{15 + 0.7 * s, -7, -9.5}, r}};
  for (const Vector3d& on : {entry, onWall({6, -14, 1}), onWall({1.9, -18, 12}), onWall({-1, -22, 21})})
    path.push_back({on, path.size() < 3 ? r : 0.85 * r});
  cystic_artery_ = Strand(path, kFar);
  if (!variant_.two_arteries) return;
  const Vector3d second = 0.6 * origin + 0.4 * Vector3d(30 + aside(), cross_y, -20);
  second_artery_ = Strand(
      {{second, r}, {{17 + 0.7 * s, -7.2, -15.5}, r}, {onWall({10, -9.5, -15}), r}, {onWall({7, -18, -13}), 0.85 * r}},
      kFar);
}

/// Returns the distance to the gallbladder as if it were solid.
double Gallbladder::outerWall(const Vector3d& p) const {
  return smoothMin(body_.distance(p), pouch_.distance(p), 2 * kWideFillet);
}

/// Returns the point of the outer wall next to a point near it.
Vector3d Gallbladder::onWall(Vector3d p) const {
  constexpr int kSteps = 8;
  constexpr double kDifference = 0.01;
  for (int i = 0; i < kSteps; ++i) {
    Vector3d slope;
    for (int c = 0; c < 3; ++c)
      slope[c] = outerWall(p + kDifference * Vector3d::Unit(c)) - outerWall(p - kDifference * Vector3d::Unit(c));
    p -= outerWall(p) * slope.stableNormalized();
  }
  return p;
}

/// Returns the distance to the liver without the hollow for the gallbladder: a slab with round edges and a wavy face.
double Gallbladder::liver(const Vector3d& p) const {
  constexpr double kCorner = 18, kEdge = 6, kMiddle = 7;
  const Eigen::Vector2d beyond = Eigen::Vector2d(std::abs(p.x() - 2) - 48, std::abs(p.z() - 16) - 22).array() + kCorner;
  const double outline = beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - kCorner;
  const double y = p.y() + 1.2 * std::sin(p.x() / 13 + 0.6) * std::cos(p.z() / 11);
  const Eigen::Vector2d q = Eigen::Vector2d(outline, std::abs(y - kMiddle) - kMiddle).array() + kEdge;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - kEdge;
}

/// Returns y of the front of the fat between the ducts.
double Gallbladder::front(double z) const {
  return -7 + 0.05 * (z + 20) - (variant_.inflamed ? 5 : 0);
}

/// Returns the distance to the fat of the triangle of duct, common duct and liver.
double Gallbladder::triangle(const Vector3d& p) const {
  const double s = aside(), grown = variant_.inflamed ? 4 : 0.5;
  const std::array<Eigen::Vector2d, 4> corners = {
      Eigen::Vector2d(-3, -2), {13, -25.5}, {30.5 + s, variant_.junction_z}, {28 + s, -2}};
  const Eigen::Vector2d at(p.x(), p.z());
  double out = -std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
    out = smoothMax(out, (at - corners[i]).dot(Eigen::Vector2d(side.y(), -side.x()).normalized()) - grown, kWideFillet);
  }
  const double back = -2.5 + 7 * std::clamp((p.z() + 22) / 18, 0.0, 1.0);
  return smoothMax(out, smoothMax(front(p.z()) - p.y(), p.y() - back, kFillet), kWideFillet);
}

double Gallbladder::fat(const Vector3d& p) const {
  return smoothMin(triangle(p), ligament_.distance(p), kWideFillet) + 0.4 * waves(p);
}

uint16_t Gallbladder::partOf(const Vector3d& p, const Nearby& near) const {
  const std::pair<Strand::Nearest, GallbladderPart>* owner = nullptr;
  for (const auto& strand : near.strands) {
    const auto& [at, part] = strand;
    const bool owns = at.distance + at.radius < std::max(at.radius + kSheath, kOwnCells * near.cell);
    if (owns && sections_[kOrgan] && (owner == nullptr || at.distance < owner->first.distance)) owner = &strand;
  }
  if (owner != nullptr) return owner->second;
  std::array<std::pair<double, GallbladderPart>, 4> all = {
      {{near.gallbladder, pouch_.distance(p) < body_.distance(p) ? kInfundibulum : kGallbladder},
       {near.liver, kLiver},
       {near.bed, kGallbladderBed},
       {near.fat, kFatPart}}};
  for (auto& [distance, part] : all)
    if (!sections_[sectionOf(part)]) distance = std::numeric_limits<double>::infinity();
  const auto* best = std::find_if(all.begin(), all.end(), [](const auto& solid) { return solid.first < 0; });
  if (best == all.end())
    best = std::min_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (best->second == kLiver && liver(p) > -kCapsuleDepth) return kLiverCapsule;
  if (best->second == kFatPart && fat(p - kPeritoneumDepth * Vector3d::UnitY()) > 0) return kPeritoneum;
  return best->second;
}

/// Returns the distance to the sections that are built, as far as others are next to them. In this order strands and
/// gallbladder, liver, bed and fat own what they share; fillets belong to what is nearest.
double Gallbladder::border(const Nearby& near) const {
  double first = near.gallbladder;
  for (const auto& strand : near.strands) first = std::min(first, strand.first.distance - kSheath);
  const double outside_liver = std::max(0.0, near.liver), outside_fat = std::max(0.0, near.fat);
  const double to_liver = std::max(outside_liver - first, near.liver - std::max(0.0, std::min(near.bed, near.fat)));
  const double to_fat = outside_fat - std::min({first, near.liver, near.bed});
  double out = std::numeric_limits<double>::infinity();
  if (sections_[kOrgan]) out = std::max(-to_liver, -to_fat);
  if (sections_[kFatSection]) out = std::min(out, to_fat);
  if (sections_[kLiverSection]) out = std::min(out, to_liver);
  return out;
}

LabelledDistance Gallbladder::at(const Vector3d& p, double cell) const {
  Nearby near;
  near.cell = cell;
  near.gallbladder = outerWall(p);
  const double whole_liver = liver(p);
  near.liver = std::max(whole_liver, kBed - near.gallbladder);
  // Only between the liver and the gallbladder, and a little beyond the border of their contact.
  near.bed = smoothMax(std::max(near.gallbladder - kBed, -near.gallbladder), whole_liver - 2, kFillet);
  near.fat = fat(p);
  near.strands = {{{cystic_artery_.nearest(p), kCysticArtery},
                   {second_artery_.nearest(p), kCysticArtery},
                   {hepatic_artery_.nearest(p), kHepaticArtery},
                   {bile_duct_.nearest(p), kCommonBileDuct},
                   {hepatic_duct_.nearest(p), kCommonHepaticDuct},
                   {cystic_duct_.nearest(p), kCysticDuct}}};
  double tissue = smoothMin(smoothMin(near.liver, near.bed, kFillet), near.gallbladder, kFillet);
  tissue = smoothMin(tissue, near.fat, kWideFillet);
  for (const auto& strand : near.strands) tissue = smoothMin(tissue, strand.first.distance, kFillet);
  const double lumen =
      std::min(near.strands[3].first.distance, near.strands[4].first.distance) + wall_scale_ * kDuctWall;
  const double hollow = std::min(near.gallbladder + wall(), std::max(lumen, kFloor + 5 - p.z()));
  double distance = std::max(std::max(tissue, -hollow), kFloor - p.z());
  if (sections_ != Sections{true, true, true}) distance = std::max(distance, border(near));
  return {distance, partOf(p, near)};
}

}  // namespace

Phantom gallbladderPhantom(double length_m, double wall_scale, int seed, const std::vector<std::string>& parts) {
  requirePhantomRange("phantom_length_m", length_m, 0.01, 1);
  requirePhantomRange("phantom_wall_scale", wall_scale, 0.1, 2);
  requirePhantomRange("phantom_seed", seed, 0, kMostPhantomSeed);
  const double unit_m = length_m / kLength;
  const Sections sections = sectionsOf(parts);
  const auto shape = std::make_shared<const Gallbladder>(gallbladderVariant(seed), wall_scale, sections);
  Phantom phantom;
  for (const PartLook& part : kGallbladderParts) {
    phantom.part_names.emplace_back(part.name);
    phantom.part_colors.push_back(part.color);
  }
  phantom.min_m = unit_m * kLow;
  phantom.max_m = unit_m * kHigh;
  const double gallbladder_wall = kWall * (gallbladderVariant(seed).inflamed ? kInflamedWall : 1);
  if (sections[kOrgan])
    phantom.walls = {{kGallbladderParts[kCommonBileDuct].name, unit_m * wall_scale * kDuctWall},
                     {kGallbladderParts[kGallbladder].name, unit_m * wall_scale * gallbladder_wall}};
  phantom.field_for_cells = [shape, unit_m](double spacing_m) -> DistanceField {
    return [shape, unit_m, cell = spacing_m / unit_m](const Vector3d& point_m) {
      LabelledDistance at = shape->at(point_m / unit_m, cell);
      at.distance_m *= unit_m;
      return at;
    };
  };
  phantom.field = phantom.field_for_cells(0);
  return phantom;
}

}  // namespace viscera
