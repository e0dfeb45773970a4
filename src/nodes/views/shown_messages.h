// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "nodes/views/sent_vertices.h"
#include "viscera/SurfaceTopology.h"
#include "viscera/SurfaceTopologyChange.h"
#include "viscera/SurfaceVertices.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/session/frame.h"

namespace viscera::nodes {

// What is shown, as messages: pure functions, no node needed. Everything is in metres on both sides.

/// @param sent  has followed `skin`
SurfaceTopology toTopology(const ShownTopology& skin, const SentVertices& sent, uint32_t version,
                           const std::string& frame, const ros::Time& stamp);
/// What turns one topology into the next.
SurfaceTopologyChange toChange(const SurfaceTopology& before, const SurfaceTopology& after);
/// @param sent  has followed the frame's topology   @param colors  of the frame, of tissue or of strain
SurfaceVertices toVertices(const SurfaceFrame& frame, const std::vector<uint32_t>& colors, const SentVertices& sent,
                           uint32_t topology_version, const std::string& frame_id, const ros::Time& stamp);

/// Two markers per body, for stock rviz: TRIANGLE_LIST of its skin, then, behind those of all bodies, of its wounds'
/// walls, in a colour of their own (with a colour per point rviz would switch lighting off); or DELETE if there is
/// none. Triangles with a coordinate that is not finite are left out, since rviz would crash on them.
std::vector<visualization_msgs::Marker> toMarkers(const ShownMesh& skin, const std::string& frame_id,
                                                  const ros::Time& stamp);

/// Takes the pixels out of `frame`: rgb8, of depths 32FC1 [m], of labels mono8.
sensor_msgs::Image toImage(ImageFrame&& frame, const std::string& optical_frame, const ros::Time& stamp);
/// As OpenCV counts: the centre of the first pixel is at (0, 0), half a pixel from where Intrinsics has it.
/// @param kind  kRight: the projection is that of a point of the camera's own frame, the left eye's, into the right one
sensor_msgs::CameraInfo toCameraInfo(const CameraConfig& camera, const std::string& optical_frame,
                                     const ros::Time& stamp, PictureKind kind = PictureKind::kColor);
/// The camera's own, or the one that carries it.
std::string opticalFrame(const CameraConfig& camera, const std::string& frame_prefix);

}  // namespace viscera::nodes
