// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of a node from probes, shafts and obstacles: every such test is in this file (physics.md 5, 8).
// Feature: SHAFTS (a stylus with shaft_contact).
#ifndef TOUCH_GLSL
#define TOUCH_GLSL
#include "solver/tissue/quaternion.glsl"

/// Returns the point of the segment a..b nearest to x.
vec3 nearestOnSegment(vec3 a, vec3 b, vec3 x) {
  vec3 ab = b - a;
  float length2 = dot(ab, ab);
  return length2 > 0.0f ? a + clamp(dot(x - a, ab) / length2, 0.0f, 1.0f) * ab : a;
}

vec3 pointBetween(vec3 a, vec3 b, float s) { return a + s * (b - a); }

#ifdef SHAFTS
/// Returns where the axis of a shaft is nearest to x at the end of the substep: 0 at its near end, 1 at its far end.
float alongShaft(ToolMotion m, vec3 x) {
  vec3 axis = xyz(m.shaft_far_to) - xyz(m.shaft_to);
  return clamp(dot(x - xyz(m.shaft_to), axis) / dot(axis, axis), 0.0f, 1.0f);
}

/// Returns the swept sphere around a point of a shaft's axis as that of a probe.
ToolMotion sphereOfShaft(ToolMotion m, float along) {
  vec3 from = pointBetween(xyz(m.shaft_from), xyz(m.shaft_far_from), along);
  vec3 to = pointBetween(xyz(m.shaft_to), xyz(m.shaft_far_to), along);
  m.from.x = from.x;
  m.from.y = from.y;
  m.from.z = from.z;
  m.from.w = m.shaft_from.w;
  m.to.x = to.x;
  m.to.y = to.y;
  m.to.z = to.z;
  return m;
}

/// Returns a shaft as a node at x meets it: as a swept sphere around the nearest point of its axis.
ToolMotion shaftNear(ToolMotion m, vec3 x) { return sphereOfShaft(m, alongShaft(m, x)); }

bool pushesByShaft(ToolMotion m) { return (m.info.y & (kToolShaft | kToolFeels)) == kToolShaft; }
#endif
bool pushesByTip(ToolMotion m) { return (m.info.y & (kToolPushes | kToolFeels)) == kToolPushes; }

/// A swept sphere at the end of a substep, relative to a node at x.
struct ProbeSide {
  bool inside;
  vec3 normal;  // out of the probe
  float depth;  // depth below its surface along the normal [m]; negative outside
};

// Factor on the radius: nodes nearer than that to the final sphere are not treated as swept over. A node placed on its surface
// stays there despite rounding.
const float kOnSphere = 1.001f;

/// Returns the side of a probe. A node inside the final sphere sees its surface along the radius; one that the sphere has passed
/// over, that of the swept capsule.
/// @param came_from  position before the substep, for a node at the centre, where there is no direction
/// @param below      surfaceDepth() of the node: the probe is enlarged by it
ProbeSide sideOfProbe(ToolMotion motion, vec3 came_from, vec3 x, float below) {
  float radius = max(motion.from.w + below, 0.0f);
  vec3 travel = xyz(motion.to) - xyz(motion.from);
  vec3 centre = distance(x, xyz(motion.to)) < kOnSphere * radius ? xyz(motion.to) : nearestOnSegment(xyz(motion.from), xyz(motion.to), x);
  vec3 out_of = x - centre;
  float depth2 = dot(out_of, out_of);
  // A node leaves towards where it came from, or against the travel, or upwards.
  vec3 fallback = distance(came_from, centre) > 0.0f ? came_from - centre : dot(travel, travel) > 0.0f ? -travel : vec3(0.0f, 0.0f, 1.0f);
  vec3 normal = normalize(depth2 > 1e-12f * radius * radius ? out_of : fallback);
  ProbeSide side = {depth2 < radius * radius, normal, radius - dot(out_of, normal)};
  return side;
}

/// Contact of a node with an obstacle, in the obstacle's frame.
struct Touch {
  bool touches;
  vec3 normal;   // out of the obstacle
  vec3 surface;  // position to which the node is moved [m]
};

Touch touchAt(bool touches, vec3 normal, vec3 surface) {
  Touch touch = {touches, normal, surface};
  return touch;
}
Touch noTouch() { return touchAt(false, vec3(0.0f), vec3(0.0f)); }

/// Returns the contact with a plane; the tissue is on its +z side.
Touch touchPlane(vec3 to) { return touchAt(to.z < 0.0f, vec3(0.0f, 0.0f, 1.0f), vec3(to.x, to.y, 0.0f)); }

/// Returns the nearest point of a capsule's axis; of a sphere (half length 0) its centre.
vec3 nearestOnAxis(ObstacleMotion o, vec3 p) { return vec3(0.0f, 0.0f, clamp(p.z, -o.to.w, o.to.w)); }
float roundDistance(ObstacleMotion o, vec3 p) { return distance(p, nearestOnAxis(o, p)) - o.from.w; }

/// Returns where a path enters a sphere or capsule: 0..1 along it, above 1 if it does not. The distance along it is convex, so
/// its minimum, and then the first zero, are found by interval reduction.
float entryOfRound(ObstacleMotion o, vec3 from, vec3 to) {
  const int steps = 24;
  float low = 0.0f, high = 1.0f;
  for (int i = 0; i < steps; ++i) {
    float a = low + (high - low) / 3.0f, b = high - (high - low) / 3.0f;
    if (roundDistance(o, pointBetween(from, to, a)) < roundDistance(o, pointBetween(from, to, b))) high = b;
    else low = a;
  }
  float deepest = 0.5f * (low + high);
  if (roundDistance(o, pointBetween(from, to, deepest)) >= 0.0f) return 2.0f;
  low = 0.0f;
  high = deepest;
  for (int i = 0; i < steps; ++i) {
    float middle = 0.5f * (low + high);
    if (roundDistance(o, pointBetween(from, to, middle)) > 0.0f) low = middle;
    else high = middle;
  }
  return low;
}

/// Returns the contact along the radius for a node inside. One that has passed through, or beyond the middle, returns to where it
/// entered.
Touch touchRound(ObstacleMotion o, vec3 from, vec3 to) {
  const float slow = 0.25f;  // of the radius: a shorter path cuts off at most 1/128 of it
  float radius = o.from.w;
  vec3 out_of = to - nearestOnAxis(o, to);
  bool inside = dot(out_of, out_of) < radius * radius;
  if (distance(from, to) > slow * radius && roundDistance(o, from) >= 0.0f) {
    float entry = entryOfRound(o, from, to);
    if (entry <= 1.0f) {
      vec3 at = pointBetween(from, to, entry);
      vec3 normal = normalize(at - nearestOnAxis(o, at));
      if (!inside || dot(normal, out_of) < 0.0f) return touchAt(true, normal, at);
    }
  }
  if (!inside) return noTouch();
  vec3 came_from = from - nearestOnAxis(o, from);
  const float middle = 1e-6f;  // of the radius: nearer to the axis there is no direction
  vec3 normal = vec3(1.0f, 0.0f, 0.0f);
  if (dot(out_of, out_of) > middle * middle * radius * radius) normal = normalize(out_of);
  else if (dot(came_from, came_from) > middle * middle * radius * radius) normal = normalize(came_from);
  return touchAt(true, normal, nearestOnAxis(o, to) + radius * normal);
}

/// Returns the contact with a face of a box, chosen by the previous position: the face through which the path entered, or the
/// nearest one if the node was inside. So a box thinner than a substep's displacement supports nodes, and a node that rests on a
/// face stays on it.
Touch touchBox(vec3 half_size, vec3 from, vec3 to) {
  vec3 depth = half_size - abs(from);
  vec3 depth_to = half_size - abs(to);
  int face = 0;
  if (min(min(depth.x, depth.y), depth.z) > 0.0f) {
    if (min(min(depth_to.x, depth_to.y), depth_to.z) <= 0.0f) return noTouch();
    for (int k = 1; k < 3; ++k) face = depth[k] < depth[face] ? k : face;
  } else {
    float enter = -1.0f, leave = 1.0f;  // shares of the path
    for (int k = 0; k < 3; ++k) {
      float offset = to[k] - from[k];
      if (offset == 0.0f) {
        if (depth[k] <= 0.0f) return noTouch();
        continue;
      }
      float side = offset > 0.0f ? half_size[k] : -half_size[k];
      float in_at = (-side - from[k]) / offset;
      if (in_at > enter) {
        enter = in_at;
        face = k;
      }
      leave = min(leave, (side - from[k]) / offset);
    }
    if (enter < 0.0f || enter >= leave) return noTouch();
  }
  float side = from[face] < 0.0f ? -1.0f : 1.0f;
  vec3 normal = vec3(0.0f), surface = to;
  normal[face] = side;
  surface[face] = side * half_size[face];
  return touchAt(true, normal, surface);
}

/// Contact of a node with an obstacle during a substep, tissue frame.
struct Meeting {
  bool touches;
  vec3 normal;    // out of the obstacle
  vec3 out_of;    // from the node's position without contact to the surface [m]
  float offset;   // displacement relative to the obstacle [m]
};

/// Returns an obstacle enlarged by the depth of a node below the surface of its tissue. @param below  surfaceDepth() [m]
ObstacleMotion seenFrom(float below, ObstacleMotion o) {
  if (below == 0.0f) return o;
  if (o.info.x == kShapePlane) {
    vec3 from = rotated(xyzw(o.from_orientation), vec3(0.0f, 0.0f, below)), to = rotated(xyzw(o.to_orientation), vec3(0.0f, 0.0f, below));
    o.from.x += from.x;
    o.from.y += from.y;
    o.from.z += from.z;
    o.to.x += to.x;
    o.to.y += to.y;
    o.to.z += to.z;
  } else if (o.info.x == kShapeBox) {
    o.half_size.x = max(o.half_size.x + below, 0.0f);
    o.half_size.y = max(o.half_size.y + below, 0.0f);
    o.half_size.z = max(o.half_size.z + below, 0.0f);
  } else {
    o.from.w = max(o.from.w + below, 0.0f);
  }
  return o;
}

/// @param o  from seenFrom()
Meeting meetingOf(ObstacleMotion o, vec3 x, vec3 x_next) {
  vec3 from = rotated(conjugate(xyzw(o.from_orientation)), x - xyz(o.from));
  vec3 to = rotated(conjugate(xyzw(o.to_orientation)), x_next - xyz(o.to));
  Touch touch = o.info.x == kShapePlane ? touchPlane(to)
              : o.info.x == kShapeBox ? touchBox(xyz(o.half_size), from, to) : touchRound(o, from, to);
  Meeting meeting = {touch.touches, touch.normal, vec3(0.0f), 0.0f};
  if (!touch.touches) return meeting;
  meeting.normal = rotated(xyzw(o.to_orientation), touch.normal);
  meeting.out_of = rotated(xyzw(o.to_orientation), touch.surface - to);
  meeting.offset = distance(from, to);
  return meeting;
}

/// Returns the half space outside an obstacle in which a node at x must end a substep: xyz its normal, w depth of x inside [m].
/// For round obstacles it is bounded by the tangent plane nearest to x, with the obstacle wholly on the other side.
/// @param meeting  of the node's path, for faces
vec4 outsideOf(ObstacleMotion o, Meeting meeting, vec3 x, vec3 x_next) {
  vec4 side = vec4(meeting.normal, dot(meeting.normal, x_next + meeting.out_of - x));
  if (o.info.x == kShapePlane || o.info.x == kShapeBox) return side;
  vec3 p = rotated(conjugate(xyzw(o.to_orientation)), x - xyz(o.to));
  vec3 out_of = p - nearestOnAxis(o, p);
  const float middle = 1e-6f;  // of the radius: nearer to the axis there is no direction
  if (dot(out_of, out_of) <= middle * middle * o.from.w * o.from.w) return side;
  return vec4(rotated(xyzw(o.to_orientation), normalize(out_of)), o.from.w - length(out_of));
}

/// Returns the displacement of the surface of an obstacle at x in a substep [m].
vec3 motionOfSurface(ObstacleMotion o, vec3 x, float dt) { return dt * (xyz(o.velocity) + cross(xyz(o.spin), x - xyz(o.to))); }
#endif
