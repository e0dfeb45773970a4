// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_skin.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kAround_m = 0.015;    // from where a suture enters or leaves
constexpr size_t kMostPositions = 64;  // the nearest ones are kept
constexpr double kApart = 0.7;         // of the tissue's spacing, between them
constexpr double kAt = 0.25;           // of the spacing below the surface: in its outermost cell
constexpr double kBelow = 0.75;        // of the spacing below that
constexpr double kFar = 1.5;           // of the spacing: the surface is not known farther from a place
constexpr double kDeepest = 0.5;       // of the spacing below the surface: a deeper node came from elsewhere
constexpr double kMass = 0.1;          // of the tissue's effective mass at one place: several nodes rest there
constexpr double kFriction = 0.1;      // wet

}  // namespace

void SutureSkin::lay(const Model& model, const TissuePoints& points, const std::vector<const TissuePoint*>& outer) {
  std::vector<Vector3d> around_m;
  for (const TissuePoint* point : outer) around_m.push_back(point->rest_m);
  if (around_m == laid_m_) return;
  laid_m_ = around_m;
  positions_.clear();
  if (outer.empty()) return;
  const uint32_t body = outer[0]->body;
  if (model.bodies[body].skin.two_sided) return;  // either side of a sheet is outside
  spacing_m_ = points.spacing_m(body);
  const TriangleMesh& skin = model.bodies[body].skin.mesh;
  const std::vector<Vector3f> normals = vertexNormals(skin);
  std::vector<std::pair<double, size_t>> near;  // distance from the nearest of these, vertex
  for (size_t v = 0; v < skin.positions_m.size(); ++v) {
    double distance_m = kAround_m;
    for (const Vector3d& at_m : around_m)
      distance_m = std::min(distance_m, (skin.positions_m[v].cast<double>() - at_m).norm());
    if (distance_m < kAround_m) near.push_back({distance_m, v});
  }
  std::sort(near.begin(), near.end());
  std::vector<Vector3d> taken_m;
  for (const auto& [distance_m, v] : near) {
    const Vector3d at_m = skin.positions_m[v].cast<double>(), normal = normals[v].cast<double>();
    const auto is_near = [&](const Vector3d& other_m) { return (other_m - at_m).norm() < kApart * spacing_m_; };
    if (positions_.size() == kMostPositions || std::any_of(taken_m.begin(), taken_m.end(), is_near)) continue;
    const std::optional<TissuePoint> at = points.embed(body, at_m - kAt * spacing_m_ * normal),
                                     below = points.embed(body, at_m - kBelow * spacing_m_ * normal);
    if (!at || !below) continue;
    positions_.push_back({*at, *below, kAt * spacing_m_});
    taken_m.push_back(at_m);
  }
}

void SutureSkin::addPoints(std::vector<const TissuePoint*>& points) const {
  for (const SurfacePoint& position : positions_) {
    points.push_back(&position.at);
    points.push_back(&position.below);
  }
}

void SutureSkin::begin(const TissuePoints& points) {
  now_.clear();
  along_x_.clear();
  box_m_.setEmpty();
  for (const SurfacePoint& position : positions_) {
    const Vector3d at_m = points.position_m(position.at), out = (at_m - points.position_m(position.below)).normalized();
    const double mobility = points.mobility(position.at, position.at);
    now_.push_back({at_m + position.depth_m * out, out, points.velocity_m_per_s(position.at),
                    mobility > 0 ? std::min(kRigidMass_kg, kMass / mobility) : kRigidMass_kg});
    const Vector3d& position_m = now_.back().position_m;
    if (!position_m.allFinite())
      continue;  // the stability monitor is about to restore this tissue: nothing rests there
    along_x_.push_back({position_m.x(), now_.size() - 1});
    box_m_.extend(position_m);
  }
  std::sort(along_x_.begin(), along_x_.end());
}

std::optional<size_t> SutureSkin::nearest(const Vector3d& to_m, double within_m) const {
  std::optional<size_t> out;
  double best_m2 = within_m * within_m;
  if (box_m_.squaredExteriorDistance(to_m) > best_m2) return out;
  const auto first = std::lower_bound(along_x_.begin(), along_x_.end(), std::make_pair(to_m.x() - within_m, size_t{0}));
  for (auto at = first; at != along_x_.end() && at->first <= to_m.x() + within_m; ++at) {
    const double distance_m2 = (now_[at->second].position_m - to_m).squaredNorm();
    if (distance_m2 > best_m2) continue;
    best_m2 = distance_m2;
    out = at->second;
  }
  return out;
}

std::optional<ChainTouch> SutureSkin::near(const Vector3d& ahead_m, double reach_m, double dt_s) const {
  if (now_.empty()) return std::nullopt;
  const double across_m = kFar * spacing_m_, along_m = std::max(reach_m, kDeepest * spacing_m_);
  const std::optional<size_t> position = nearest(ahead_m, std::sqrt(across_m * across_m + along_m * along_m));
  if (!position) return std::nullopt;
  const Now& now = now_[*position];
  const Vector3d offset_m = ahead_m - now.position_m;
  const double height_m = offset_m.dot(now.normal);
  if (height_m > reach_m || height_m < -kDeepest * spacing_m_) return std::nullopt;
  if ((offset_m - height_m * now.normal).norm() > across_m) return std::nullopt;
  ChainTouch touch;
  touch.thing = kThing + static_cast<uint32_t>(*position);
  touch.at_m = ahead_m - height_m * now.normal;
  touch.normal = now.normal;
  touch.moved_m = dt_s * now.velocity_m_per_s;
  touch.friction = kFriction;
  touch.mass_kg = now.mass_kg;
  return touch;
}

void SutureSkin::give(const std::vector<ChainTouch>& touches, double dt_s, TissuePoints& points) const {
  for (const ChainTouch& touch : touches) {
    if (touch.thing >= kThing && touch.closed) points.give(positions_[touch.thing - kThing].at, touch.impulse_ns, dt_s);
  }
}

}  // namespace viscera
