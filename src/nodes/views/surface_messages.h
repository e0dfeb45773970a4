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

// Conversions of rendered data to messages: pure functions without a node. Both sides use metres.

/// Converts a topology. @param sent  has followed `skin`
SurfaceTopology toTopology(const VisibleTopology& skin, const SentVertices& sent, uint32_t version,
                           const std::string& frame, const ros::Time& stamp);
/// Returns the change that turns one topology into the next.
SurfaceTopologyChange toChange(const SurfaceTopology& before, const SurfaceTopology& after);
/// Converts vertices.
/// @param sent  has followed the frame's topology   @param colors  of the frame, of tissue or of strain
SurfaceVertices toVertices(const SurfaceFrame& frame, const std::vector<uint32_t>& colors, const SentVertices& sent,
                           uint32_t topology_version, const std::string& frame_id, const ros::Time& stamp);

/// Returns two markers per body, for stock rviz: a TRIANGLE_LIST of its surface mesh and then, after those of all
/// bodies, one of its cut walls. Each has one colour, since rviz switches lighting off with a colour per point. A
/// marker without triangles is DELETE. Triangles with a coordinate that is not finite are left out, since rviz would
/// crash on them.
std::vector<visualization_msgs::Marker> toMarkers(const VisibleMesh& skin, const std::string& frame_id,
                                                  const ros::Time& stamp);

/// Converts an image and moves its pixels out of `frame`: rgb8; depth 32FC1 [m]; labels mono8.
sensor_msgs::Image toImage(ImageFrame&& frame, const std::string& optical_frame, const ros::Time& stamp);
/// Returns the calibration in OpenCV's convention: the centre of the first pixel is at (0, 0), half a pixel from that
/// of Intrinsics.
/// @param kind  kRight: projects a point of the camera's own frame, that of the left eye, into the right image
sensor_msgs::CameraInfo toCameraInfo(const CameraConfig& camera, const std::string& optical_frame,
                                     const ros::Time& stamp, PictureKind kind = PictureKind::kColor);
/// Returns the camera's own optical frame, or the frame that carries it.
std::string opticalFrame(const CameraConfig& camera, const std::string& frame_prefix);

}  // namespace viscera::nodes
