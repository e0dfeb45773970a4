// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where a node touches an obstacle and what wind does to it (physics.md 8). After lattice.glsl.
#include "quaternion.glsl"

#ifndef __cplusplus
uniform uint active_count;
uniform float dt_s;
uniform float push_speed;     // m/s: nodes deep in an obstacle leave it no faster
uniform float resting_speed;  // m/s: nothing that comes slower bounces
#endif

/// Where a node touches an obstacle, in the obstacle's frame.
struct Touch {
  bool touches;
  vec3 normal;   // out of the obstacle
  vec3 surface;  // where the node goes [m]
};

Touch touchAt(bool touches, vec3 normal, vec3 surface) {
  Touch touch = {touches, normal, surface};
  return touch;
}
Touch noTouch() { return touchAt(false, vec3(0.0f), vec3(0.0f)); }

/// The tissue is on the +z side.
Touch touchPlane(vec3 to) { return touchAt(to.z < 0.0f, vec3(0.0f, 0.0f, 1.0f), vec3(to.x, to.y, 0.0f)); }

/// A capsule's axis; of a sphere (half length 0) its centre.
vec3 nearestOnAxis(ObstacleMotion o, vec3 p) { return vec3(0.0f, 0.0f, clamp(p.z, -o.to.w, o.to.w)); }
float roundDistance(ObstacleMotion o, vec3 p) { return distance(p, nearestOnAxis(o, p)) - o.from.w; }
vec3 pointBetween(vec3 a, vec3 b, float s) { return a + s * (b - a); }

/// Where a way enters a sphere or capsule: 0..1 of it, above 1 if it does not. The distance along it is convex, so its lowest
/// point, and then the first zero, are found by halving.
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

/// A node that is inside goes out along the radius. One that has passed through, or beyond the middle, goes to where it came in.
Touch touchRound(ObstacleMotion o, vec3 from, vec3 to) {
  const float slow = 0.25f;  // of the radius: on a shorter way no more than 1/128 of it can be cut off
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
  const float middle = 1e-6f;  // of the radius: there is no direction there
  vec3 normal = vec3(1.0f, 0.0f, 0.0f);
  if (dot(out_of, out_of) > middle * middle * radius * radius) normal = normalize(out_of);
  else if (dot(came_from, came_from) > middle * middle * radius * radius) normal = normalize(came_from);
  return touchAt(true, normal, nearestOnAxis(o, to) + radius * normal);
}

/// Which face a node meets is said by where it was: the face that its way came in by, or the nearest if it was inside. So a box
/// thinner than a substep's way holds nodes up, and one that lies on a face stays on it.
Touch touchBox(vec3 half_size, vec3 from, vec3 to) {
  vec3 depth = half_size - abs(from);
  vec3 depth_to = half_size - abs(to);
  int face = 0;
  if (min(min(depth.x, depth.y), depth.z) > 0.0f) {
    if (min(min(depth_to.x, depth_to.y), depth_to.z) <= 0.0f) return noTouch();
    for (int k = 1; k < 3; ++k) face = depth[k] < depth[face] ? k : face;
  } else {
    float enter = -1.0f, leave = 1.0f;  // of the way
    for (int k = 0; k < 3; ++k) {
      float way = to[k] - from[k];
      if (way == 0.0f) {
        if (depth[k] <= 0.0f) return noTouch();
        continue;
      }
      float side = way > 0.0f ? half_size[k] : -half_size[k];
      float in_at = (-side - from[k]) / way;
      if (in_at > enter) {
        enter = in_at;
        face = k;
      }
      leave = min(leave, (side - from[k]) / way);
    }
    if (enter < 0.0f || enter >= leave) return noTouch();
  }
  float side = from[face] < 0.0f ? -1.0f : 1.0f;
  vec3 normal = vec3(0.0f), surface = to;
  normal[face] = side;
  surface[face] = side * half_size[face];
  return touchAt(true, normal, surface);
}

/// Nodes go out of an obstacle; what they lose of their approach they get back by its restitution, and friction takes from
/// their sliding no more than Coulomb's share of that. It acts on the substep's way too, or else what should stay would creep.
/// @return whether they touch
bool meetObstacle(ObstacleMotion o, vec3 x, INOUT(vec3) x_next, INOUT(vec3) v_next) {
  vec3 from = rotated(conjugate(xyzw(o.from_orientation)), x - xyz(o.from));
  vec3 to = rotated(conjugate(xyzw(o.to_orientation)), x_next - xyz(o.to));
  Touch touch = o.info.x == kShapePlane ? touchPlane(to)
              : o.info.x == kShapeBox ? touchBox(xyz(o.half_size), from, to) : touchRound(o, from, to);
  if (!touch.touches) return false;
  vec3 normal = rotated(xyzw(o.to_orientation), touch.normal);
  vec3 out_of = rotated(xyzw(o.to_orientation), touch.surface - to);
  // Back the way it came in this substep at once; out of what appeared around it no faster than a probe pushes.
  float way = length(out_of), most = max(push_speed * dt_s, 1.001f * distance(from, to));
  x_next += (way > most ? most / way : 1.0f) * out_of;
  vec3 v = v_next - (xyz(o.velocity) + cross(xyz(o.spin), x_next - xyz(o.to)));
  float approach = dot(v, normal);
  if (approach >= 0.0f) return true;
  float change = -approach * (-approach > resting_speed ? 1.0f + o.spin.w : 1.0f);
  vec3 sliding = v - approach * normal;
  float speed = length(sliding);
  vec3 friction = speed > 0.0f ? -(min(o.velocity.w * change, speed) / speed) * sliding : vec3(0.0f);
  v_next += change * normal + friction;
  x_next += dt_s * friction;
  return true;
}

/// Change of a node's velocity by wind [m/s]: pressure rho C/2 |w_n| w_n on its area, w_n the part of the air's velocity relative
/// to the node that is normal to it. No more in a substep than stops that part.
/// @param area  normal times area [m2]   @param air  velocity [m/s]; w rho C/2 [kg/m3]
vec3 windKick(vec3 area, vec4 air, vec3 v, float mass) {
  float size = length(area);
  if (size == 0.0f) return vec3(0.0f);
  vec3 normal = area / size;
  float across = dot(xyz(air) - v, normal);
  return (min(air.w * abs(across) * size * dt_s / mass, 1.0f) * across) * normal;
}
