// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/pressure/cavities.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "math/union_find.h"
#include "model/body/body_nodes.h"
#include "model/shape/organ/hollow_tube.h"
#include "model/shape/organ/placing.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kPerRadius = 2.5;            // least number of edges of the border per radius of a lumen
constexpr double kMostStations = 48;          // of an axis
constexpr double kHeldWithin = 1.5;           // spacings beyond the radius: a fixed node that near holds an end
constexpr double kM3PerMl_s = 1e-6 / 60;      // m3/s per ml/min
constexpr double kNoSupply_m3_per_s = 1e-10;  // of a vessel that does not bleed: any hole empties it
constexpr double kCavityPi = 3.14159265358979323846;
constexpr double kLeastCavity = 8;  // cells: smaller voids in a surface mesh are flaws

using Triangle = std::array<uint32_t, 3>;

double supplyOf_m3_per_s(const BodyConfig& config, const std::string& part) {
  double flow = config.material.bleeding.flow_ml_per_min;
  for (const PartConfig& own : config.parts)
    if (own.part == part) flow = own.bleeding.flow_ml_per_min;
  return std::max(kNoSupply_m3_per_s, flow * kM3PerMl_s);
}

/// Adds the centres of the borders of an open surface as vertices, with fans around them.
void closeRims(Cavities& out) {
  std::map<uint32_t, uint32_t> next;
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  for (const Triangle& t : out.triangles)
    for (size_t c = 0; c < 3; ++c) ++sides[{t[c], t[(c + 1) % 3]}];
  for (const auto& [side, uses] : sides)
    if (sides.find({side.second, side.first}) == sides.end()) next[side.second] = side.first;
  while (!next.empty()) {
    std::vector<uint32_t> rim;
    for (auto at = next.begin(); at != next.end(); at = next.find(rim.back())) {
      rim.push_back(at->second);
      next.erase(at);
    }
    out.rims.push_back(rim);
  }
  for (size_t r = 0; r < out.rims.size(); ++r) {
    const std::vector<uint32_t>& rim = out.rims[r];
    const auto centre = static_cast<uint32_t>(out.positions_m.size() + r);
    for (size_t i = 0; i < rim.size(); ++i) out.triangles.push_back({rim[i], rim[(i + 1) % rim.size()], centre});
  }
}

Vector3d middleOf(const Cavities& cavities, const Triangle& triangle) {
  Vector3d sum = Vector3d::Zero();
  for (const uint32_t v : triangle) {
    if (v < cavities.positions_m.size()) {
      sum += cavities.positions_m[v] / 3;
      continue;
    }
    const std::vector<uint32_t>& rim = cavities.rims[v - cavities.positions_m.size()];
    for (const uint32_t on : rim) sum += cavities.positions_m[on] / (3 * static_cast<double>(rim.size()));
  }
  return sum;
}

/// Stations along the axes of a tube.
class TubeStations {
 public:
  TubeStations(const HollowTube& tube, const Pose& pose, const Body& body, const BodyConfig& config)
      : tube_(tube), pose_(pose) {
    const std::vector<std::string> names = tube.partNames();
    for (uint32_t a = 0; a < tube.axes().size(); ++a) addAxis(a, body.lattice.spacing_m);
    for (uint32_t a = 1; a < tube.axes().size(); ++a) {
      const HollowTube::Axis& axis = tube.axes()[a];
      if (!axis.opens_at_start) link(a, axis.points_m.front(), first_[a]);
      if (!axis.opens_at_end) link(a, axis.points_m.back(), first_[a] + count_[a] - 1);
    }
    bool any = false;
    for (uint32_t a = 0; a < tube.axes().size(); ++a) {
      const HollowTube::Axis& axis = tube.axes()[a];
      const double supply = supplyOf_m3_per_s(config, a == 0 ? "tube" : names[a]);
      const double reach_m = axis.radius_m + kHeldWithin * body.lattice.spacing_m;
      const auto feed = [&](const Vector3d& end, uint32_t station) {
        if (!isHeld(body, pose_ * end, reach_m)) return;
        network.stations[station].supply_m3_per_s = supply;
        any = true;
      };
      if (axis.opens_at_start) feed(axis.points_m.front(), first_[a]);
      if (axis.opens_at_end) feed(axis.points_m.back(), first_[a] + count_[a] - 1);
    }
    if (!any) network.stations[0].supply_m3_per_s = supplyOf_m3_per_s(config, "tube");
  }

  uint32_t stationOf(const Vector3d& point_m) const {
    const HollowTube::Place at = tube_.nearest(point_m);
    return stationAt(at.axis, at.along_m);
  }

  LumenNetwork network;

 private:
  static bool isHeld(const Body& body, const Vector3d& at_m, double reach_m) {
    bool out = false;
    forEachNode(body, [&](uint32_t slot) {
      out = out || (isFixed(body.lattice.nodes[slot]) && (restPosition(body, slot) - at_m).norm() < reach_m);
    });
    return out;
  }

  void addAxis(uint32_t a, double spacing_m) {
    const HollowTube::Axis& axis = tube_.axes()[a];
    const double step_m = std::max({spacing_m, axis.lumenRadius_m(), axis.length_m() / kMostStations});
    const auto count = static_cast<uint32_t>(std::max(1.0, std::round(axis.length_m() / step_m)));
    first_.push_back(static_cast<uint32_t>(network.stations.size()));
    count_.push_back(count);
    const double length_m = axis.length_m() / count;
    for (uint32_t i = 0; i < count; ++i) {
      const double along_m = (i + 0.5) * length_m;
      size_t piece = 1;
      while (piece + 1 < axis.along_m.size() && axis.along_m[piece] < along_m) ++piece;
      const Vector3d line = axis.points_m[piece] - axis.points_m[piece - 1];
      const Vector3d at = axis.points_m[piece - 1] + line * ((along_m - axis.along_m[piece - 1]) / line.norm());
      network.stations.push_back({pose_ * at, pose_.orientation * line.normalized(), length_m,
                                  kCavityPi * axis.lumenRadius_m() * axis.lumenRadius_m(), 0, a});
      if (i > 0) network.links.push_back({first_[a] + i - 1, first_[a] + i});
    }
  }

  uint32_t stationAt(uint32_t axis, double along_m) const {
    const double share = along_m / tube_.axes()[axis].length_m() * count_[axis];
    return first_[axis] + static_cast<uint32_t>(std::clamp(std::floor(share), 0.0, count_[axis] - 1.0));
  }

  /// Joins an end to the station of the nearest other axis.
  void link(uint32_t axis, const Vector3d& end, uint32_t station) {
    HollowTube::Place best;
    double least_m = 1e9;
    for (uint32_t b = 0; b < tube_.axes().size(); ++b) {
      const HollowTube::Place place = tube_.placeOn(b, end);
      if (b == axis || place.distance_m >= least_m) continue;
      least_m = place.distance_m;
      best = place;
    }
    network.links.push_back({stationAt(best.axis, best.along_m), station});
  }

  const HollowTube& tube_;
  const Pose pose_;
  std::vector<uint32_t> first_, count_;  ///< [axes]
};

Cavities tubeCavities(const Body& body, const BodyConfig& config) {
  const HollowTube tube(config.tube, config.name);
  const Pose pose = bodyPose(config);
  const double edge_m = std::min(body.lattice.spacing_m, tube.narrowestLumen_m() / kPerRadius);
  const Eigen::AlignedBox3d box = tube.bounds();
  const auto lumen = [&](const Vector3d& p) { return tube.lumen(p); };
  TriangleMesh mesh = extractSkin(
      [&](const Vector3d& p) {
        return LabelledDistance{lumen(p), 0};
      },
      {"lumen"}, box.min(), box.max(), edge_m);
  moveOntoBorder(lumen, 0.5 * edge_m, mesh);
  compensateChords(lumen, mesh);
  Cavities out;
  TubeStations stations(tube, pose, body, config);
  std::vector<uint32_t> index(mesh.positions_m.size(), UINT32_MAX);
  for (const Triangle& triangle : mesh.triangles) {
    Vector3d middle = Vector3d::Zero();
    for (const uint32_t v : triangle) middle += mesh.positions_m[v].cast<double>() / 3;
    if (tube.isOnCap(middle)) continue;
    Triangle kept{};
    for (size_t c = 0; c < 3; ++c) {
      uint32_t& at = index[triangle[c]];
      if (at == UINT32_MAX) {
        at = static_cast<uint32_t>(out.positions_m.size());
        out.positions_m.push_back(pose * mesh.positions_m[triangle[c]].cast<double>());
      }
      kept[c] = at;
    }
    out.triangles.push_back(kept);
  }
  closeRims(out);
  const Pose to_body = pose.inverse();
  for (const Triangle& triangle : out.triangles)
    out.station_of.push_back(stations.stationOf(to_body * middleOf(out, triangle)));
  out.lumen = std::move(stations.network);
  return out;
}

/// Returns the pieces of the surface mesh that face inwards. Vertices at one position count as one.
Cavities enclosedCavities(const Body& body, const BodyConfig& config) {
  const TriangleMesh& mesh = body.skin.mesh;
  Cavities out;
  std::map<std::tuple<float, float, float>, uint32_t> known;
  std::vector<uint32_t> welded;
  for (const Vector3f& p : mesh.positions_m) {
    const auto [at, is_new] = known.try_emplace({p.x(), p.y(), p.z()}, static_cast<uint32_t>(known.size()));
    if (is_new) out.positions_m.push_back(p.cast<double>());
    welded.push_back(at->second);
  }
  UnionFind pieces(out.positions_m.size());
  for (const Triangle& t : mesh.triangles)
    for (size_t c = 1; c < 3; ++c) pieces.unite(welded[t[0]], welded[t[c]]);
  std::map<uint32_t, double> volume_m3;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d &a = out.positions_m[welded[t[0]]], &b = out.positions_m[welded[t[1]]],
                   &c = out.positions_m[welded[t[2]]];
    volume_m3[pieces.find(welded[t[0]])] += a.dot(b.cross(c)) / 6;
  }
  std::map<uint32_t, uint32_t> station;
  const double least_m3 = kLeastCavity * std::pow(body.lattice.spacing_m, 3);
  for (const auto& [piece, m3] : volume_m3) {
    if (m3 > -least_m3) continue;
    station[piece] = static_cast<uint32_t>(out.lumen.stations.size());
    out.lumen.stations.push_back(
        {Vector3d::Zero(), Vector3d::Zero(), 0, std::pow(-m3, 2.0 / 3), supplyOf_m3_per_s(config, ""), 0});
  }
  for (const Triangle& t : mesh.triangles) {
    const auto found = station.find(pieces.find(welded[t[0]]));
    if (found == station.end()) continue;
    out.triangles.push_back({welded[t[0]], welded[t[2]], welded[t[1]]});
    out.station_of.push_back(found->second);
  }
  std::vector<uint32_t> index(out.positions_m.size(), UINT32_MAX);
  std::vector<Vector3d> kept;
  for (Triangle& t : out.triangles) {
    for (uint32_t& v : t) {
      if (index[v] == UINT32_MAX) {
        index[v] = static_cast<uint32_t>(kept.size());
        kept.push_back(out.positions_m[v]);
      }
      v = index[v];
    }
  }
  out.positions_m = std::move(kept);
  return out;
}

}  // namespace

Cavities cavitiesOf(const Body& body, const BodyConfig& config) {
  Cavities out = config.source == TissueSource::kTube ? tubeCavities(body, config) : enclosedCavities(body, config);
  if (out.triangles.empty()) {
    throw SceneError("body '" + config.name +
                     "': pressure.mean_pa above 0 needs a cavity that tissue encloses on all sides, or source: tube; "
                     "the surface of this body has none");
  }
  return out;
}

}  // namespace viscera
