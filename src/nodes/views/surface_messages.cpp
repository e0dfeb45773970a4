// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/surface_messages.h"

#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "nodes/ros/conversions.h"
#include "nodes/views/topology_change.h"
#include "render/renderer.h"
#include "viscera/render/camera.h"

namespace viscera::nodes {
namespace {

geometry_msgs::Point toPoint(const float* xyz_m) {
  geometry_msgs::Point out;
  out.x = xyz_m[0], out.y = xyz_m[1], out.z = xyz_m[2];
  return out;
}

bool finite(const float* xyz) {
  return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
}

std_msgs::ColorRGBA toColor(const Vector3d& color) {
  std_msgs::ColorRGBA out;
  out.r = static_cast<float>(color.x());
  out.g = static_cast<float>(color.y());
  out.b = static_cast<float>(color.z());
  out.a = 1;
  return out;
}

/// Packs a colour. @param color  sRGB, 0..1   @returns the format of SurfaceVertices.colors
uint32_t packed(const Vector3d& color) {
  constexpr double kMost = 255;
  uint32_t out = 0xff;  // alpha, which ends up in the top byte
  for (const int axis : {2, 1, 0})
    out = out << 8U | static_cast<uint32_t>(std::lround(kMost * std::clamp(color[axis], 0.0, 1.0)));
  return out;
}

visualization_msgs::Marker emptyMarker(const VisibleBody& body, size_t id) {
  visualization_msgs::Marker marker;
  marker.ns = body.name;
  marker.id = static_cast<int32_t>(id);
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  marker.color = toColor(body.color);
  return marker;
}

/// Adds the corners of a patch's triangles, without triangles that have one that is not finite.
void addPoints(const VisibleMesh& skin, const VisiblePatch& patch, visualization_msgs::Marker& marker) {
  marker.points.reserve(marker.points.size() + 3 * patch.count);
  for (size_t t = patch.first; t < patch.first + patch.count; ++t) {
    const float* corner[3];
    for (size_t i = 0; i < 3; ++i) {
      corner[i] = &skin.positions_m[3 * static_cast<size_t>(skin.topology->triangles[3 * t + i])];
    }
    if (!finite(corner[0]) || !finite(corner[1]) || !finite(corner[2])) continue;
    for (const float* xyz_m : corner) marker.points.push_back(toPoint(xyz_m));
  }
}

}  // namespace

SurfaceTopology toTopology(const VisibleTopology& skin, const SentVertices& sent, uint32_t version,
                           const std::string& frame, const ros::Time& stamp) {
  SurfaceTopology out;
  out.header = toHeader(frame, stamp);
  out.version = version;
  out.vertices = static_cast<uint32_t>(sent.vertices().size());
  out.triangles.reserve(skin.triangles.size());
  for (const uint32_t vertex : skin.triangles) out.triangles.push_back(sent.numberOf(vertex));
  for (const VisibleBody& body : skin.bodies) {
    out.bodies.push_back(body.name);
    out.body_colors.push_back(packed(body.color));
    out.wound_colors.push_back(packed(woundColor(body.color)));
  }
  out.body_triangles.assign(skin.bodies.size(), 0);
  out.wound_triangles.assign(skin.bodies.size(), 0);
  for (const VisiblePatch& patch : skin.patches) {
    out.body_triangles[patch.body] += static_cast<uint32_t>(patch.count);
    if (patch.kind == SurfaceKind::kWound) out.wound_triangles[patch.body] += static_cast<uint32_t>(patch.count);
  }
  return out;
}

SurfaceTopologyChange toChange(const SurfaceTopology& before, const SurfaceTopology& after) {
  SurfaceTopologyChange out;
  out.header = after.header;
  out.version = after.version;
  out.vertices = after.vertices;
  out.body_triangles = after.body_triangles;
  out.wound_triangles = after.wound_triangles;
  TriangleEdits edits = editsBetween(before.triangles, after.triangles);
  out.kept = std::move(edits.kept);
  out.removed = std::move(edits.removed);
  out.added = std::move(edits.added);
  out.triangles = std::move(edits.triangles);
  return out;
}

SurfaceVertices toVertices(const SurfaceFrame& frame, const std::vector<uint32_t>& colors, const SentVertices& sent,
                           uint32_t topology_version, const std::string& frame_id, const ros::Time& stamp) {
  SurfaceVertices out;
  out.header = toHeader(frame_id, stamp);
  out.tick = frame.tick;
  out.topology_version = topology_version;
  out.positions_m.reserve(3 * sent.vertices().size());
  out.normals.reserve(sent.vertices().size());
  for (const uint32_t vertex : sent.vertices()) {
    const float* const xyz_m = &frame.positions_m[3 * size_t{vertex}];
    out.positions_m.insert(out.positions_m.end(), xyz_m, xyz_m + 3);
    out.normals.push_back(frame.normals[vertex]);
    if (!colors.empty()) out.colors.push_back(colors[vertex]);
  }
  return out;
}

std::vector<visualization_msgs::Marker> toMarkers(const VisibleMesh& skin, const std::string& frame_id,
                                                  const ros::Time& stamp) {
  const std::vector<VisibleBody>& bodies = skin.topology->bodies;
  std::vector<visualization_msgs::Marker> markers;
  for (const VisibleBody& body : bodies) markers.push_back(emptyMarker(body, markers.size()));
  for (const VisibleBody& body : bodies) {
    const VisibleBody wounds = {body.name + " wounds", woundColor(body.color)};
    markers.push_back(emptyMarker(wounds, markers.size()));
  }
  for (const VisiblePatch& patch : skin.topology->patches) {
    addPoints(skin, patch, markers[patch.body + (patch.kind == SurfaceKind::kWound ? bodies.size() : 0)]);
  }
  for (visualization_msgs::Marker& marker : markers) {
    marker.header = toHeader(frame_id, stamp);
    if (marker.points.empty()) marker.action = visualization_msgs::Marker::DELETE;
  }
  return markers;
}

std::string opticalFrame(const CameraConfig& camera, const std::string& frame_prefix) {
  return isCarriedByOpticalFrame(camera) ? camera.frame : frame_prefix + camera.name + "_optical_frame";
}

sensor_msgs::Image toImage(ImageFrame&& frame, const std::string& optical_frame, const ros::Time& stamp) {
  sensor_msgs::Image out;
  out.header = toHeader(optical_frame, stamp);
  out.width = static_cast<uint32_t>(frame.width);
  out.height = static_cast<uint32_t>(frame.height);
  switch (frame.kind) {
    case PictureKind::kDepth:
      out.encoding = sensor_msgs::image_encodings::TYPE_32FC1;
      out.step = sizeof(float) * out.width;
      out.data.resize(sizeof(float) * frame.depths_m.size());
      std::memcpy(out.data.data(), frame.depths_m.data(), out.data.size());
      break;
    case PictureKind::kLabels:
      out.encoding = sensor_msgs::image_encodings::MONO8;
      out.step = out.width;
      out.data = std::move(frame.labels);
      break;
    default:
      out.encoding = sensor_msgs::image_encodings::RGB8;
      out.step = 3 * out.width;
      out.data = std::move(frame.rgb);
  }
  return out;
}

sensor_msgs::CameraInfo toCameraInfo(const CameraConfig& camera, const std::string& optical_frame,
                                     const ros::Time& stamp, PictureKind kind) {
  constexpr double kPixelCentre = 0.5;  // centre of a pixel in Intrinsics; in a CameraInfo the centre of the first
                                        // pixel is at 0
  const Intrinsics lens = intrinsics(camera);
  const double cx = lens.cx - kPixelCentre, cy = lens.cy - kPixelCentre;
  sensor_msgs::CameraInfo out;
  out.header = toHeader(optical_frame, stamp);
  out.width = static_cast<uint32_t>(camera.width_px);
  out.height = static_cast<uint32_t>(camera.height_px);
  out.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  const PlumbBob& d = camera.distortion;
  out.D = {d.k1, d.k2, d.p1, d.p2, d.k3};
  out.K = {lens.fx, 0, cx, 0, lens.fy, cy, 0, 0, 1};
  out.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double shift = kind == PictureKind::kRight ? -lens.fx * camera.stereo_baseline_m : 0;
  out.P = {lens.fx, 0, cx, shift, 0, lens.fy, cy, 0, 0, 0, 1, 0};
  return out;
}

}  // namespace viscera::nodes
