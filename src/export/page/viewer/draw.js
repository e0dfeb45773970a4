'use strict';
// Drawing of a frame with WebGL 2, lit as the renderer of viscera lights it, without its grain, textures and shadows.
const LIGHT = `#version 300 es
precision highp float;
const vec3 kToKey = vec3(-0.5000, -0.6124, -0.6124), kKey = vec3(1.42, 1.36, 1.30);
const vec3 kSky = vec3(0.24, 0.25, 0.28), kGround = vec3(0.06, 0.045, 0.045);
vec3 fill(vec3 direction) { return mix(kGround, kSky, 0.5 - 0.5 * direction.y); }
float highlight(float n_h, float roughness) {
  float a = roughness * roughness, a2 = a * a, d = n_h * n_h * (a2 - 1.0) + 1.0;
  return 0.25 * a2 / (d * d);
}
float fresnel(float cosine, float straight) {
  float rest = 1.0 - cosine, rest2 = rest * rest;
  return straight + (1.0 - straight) * rest2 * rest2 * rest;
}
vec3 shoulder(vec3 light) {
  const float knee = 0.75;
  vec3 over = max(light - knee, 0.0) / (1.0 - knee);
  return min(light, knee) + (1.0 - knee) * over / (1.0 + over);
}
vec3 srgb(vec3 c) { return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThan(c, vec3(0.0031308))); }
in vec3 position_m;
in vec3 normal;
in vec4 color;
out vec4 image;
vec3 flatNormal() {
  vec3 n = normalize(cross(dFdx(position_m), dFdy(position_m)));
  return dot(n, position_m) < 0.0 ? n : -n;
}
vec3 seenNormal() {
  if (dot(normal, normal) > 0.01) return normalize(gl_FrontFacing ? normal : -normal);
  return flatNormal();
}
`;
const TISSUE = LIGHT + `
const vec3 kWrap = vec3(0.42, 0.14, 0.10), kGrazing = vec3(0.50, 0.28, 0.30), kRaw = vec3(0.36, 0.13, 0.13);
const float kFilm = 0.035, kRoughness = 0.25;
uniform bool wall;
void main() {
  vec3 n = seenNormal(), to_eye = -normalize(position_m);
  if (wall && dot(n, to_eye) < 0.2) n = flatNormal();
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0), n_h = max(dot(n, normalize(kToKey + to_eye)), 0.0);
  bool skin = gl_FrontFacing || wall || color.a < 0.5;
  vec3 albedo = color.rgb * mix(kGrazing, vec3(1.0), n_v) * (skin ? vec3(1.0) : kRaw);
  vec3 lit = max((dot(n, kToKey) + kWrap) / (1.0 + kWrap), 0.0) / (1.0 + 0.5 * kWrap);
  float wet = 0.6 * highlight(n_h, kRoughness) + 0.3 * highlight(n_h, kRoughness + 0.23);
  vec3 gloss = kFilm * wet * kKey + 0.6 * fresnel(n_v, kFilm) * fill(reflect(-to_eye, n));
  image = vec4(srgb(shoulder(albedo * (kKey * lit + fill(n)) + (skin ? 1.0 : 0.4) * gloss)), 1.0);
}`;
const METAL = LIGHT + `
vec3 around(vec3 direction) { return fill(direction) * (1.0 - smoothstep(-0.6, 0.7, direction.y)); }
void main() {
  vec3 n = seenNormal(), to_eye = -normalize(position_m);
  float n_v = clamp(dot(n, to_eye), 0.0, 1.0), n_h = max(dot(n, normalize(kToKey + to_eye)), 0.0);
  vec3 diffuse = 0.55 * color.rgb * (kKey * max(dot(n, kToKey), 0.0) + fill(n));
  vec3 gloss = color.rgb * (0.8 * kKey * highlight(n_h, 0.40) + 1.6 * around(reflect(-to_eye, n)));
  float rim = (1.0 - n_v) * (1.0 - n_v);
  image = vec4(srgb(shoulder(diffuse + gloss)), color.a < 0.99 ? color.a * (0.08 + 0.92 * rim) : 1.0);
}`;
const VERTEX = `#version 300 es
uniform mat4 optical_from_mesh, clip_from_optical;
out vec3 position_m;
out vec3 normal;
out vec4 color;
vec3 linear(vec3 c) { return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThan(c, vec3(0.04045))); }
void place(vec3 at, vec3 outward, vec4 tint) {
  position_m = (optical_from_mesh * vec4(at, 1.0)).xyz;
  normal = mat3(optical_from_mesh) * outward;
  color = vec4(linear(tint.rgb), tint.a);
  gl_Position = clip_from_optical * vec4(position_m, 1.0);
}
`;
const SURFACE_VERTEX = VERTEX + `
layout(location = 0) in float x;
layout(location = 1) in float y;
layout(location = 2) in float z;
layout(location = 3) in vec3 outward;
layout(location = 4) in vec4 tint;
uniform vec4 grid;  // origin, step
void main() { place(grid.xyz + grid.w * vec3(x, y, z), outward, tint); }`;
const TOOL_VERTEX = VERTEX + `
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 outward;
layout(location = 2) in vec4 tint;
void main() { place(at, outward, tint); }`;
const TUBE_VERTEX = VERTEX + `
layout(location = 0) in vec4 center;  // w radius
layout(location = 1) in vec3 outward;
layout(location = 2) in vec4 tint;
uniform float pixel;  // its width at a distance of 1
void main() {
  float away = (optical_from_mesh * vec4(center.xyz, 1.0)).z;
  float thickest = max(center.w, 0.0), thinnest = center.w < 0.0 ? 0.0 : 0.75 * pixel * away;
  place(center.xyz + outward * max(thickest, thinnest), outward, tint);
}`;
const BACKGROUND = [17 / 255, 19 / 255, 22 / 255];
const TUBE_SIDES = 8, LEAST_FORCE_N = 1e-3, FORCE_COLOR = [250, 215, 70];

function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  const places = new Map();
  return {
    program,
    place(name) {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
      return places.get(name);
    },
  };
}

/** Returns normals of vertices as signed bytes, four per vertex, from the shown triangles. */
function normalsOf(surface) {
  const {corners, vertices} = surface.shape, steps = surface.steps, sums = new Float32Array(3 * vertices);
  for (let i = 0; i < corners.length; i += 3) {
    const a = corners[i], b = corners[i + 1], c = corners[i + 2];
    const ax = steps[a], ay = steps[a + vertices], az = steps[a + 2 * vertices];
    const ux = steps[b] - ax, uy = steps[b + vertices] - ay, uz = steps[b + 2 * vertices] - az;
    const vx = steps[c] - ax, vy = steps[c + vertices] - ay, vz = steps[c + 2 * vertices] - az;
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    sums[3 * a] += nx; sums[3 * a + 1] += ny; sums[3 * a + 2] += nz;
    sums[3 * b] += nx; sums[3 * b + 1] += ny; sums[3 * b + 2] += nz;
    sums[3 * c] += nx; sums[3 * c + 1] += ny; sums[3 * c + 2] += nz;
  }
  const out = new Int8Array(4 * vertices);
  for (let v = 0; v < vertices; ++v) {
    const x = sums[3 * v], y = sums[3 * v + 1], z = sums[3 * v + 2], length = Math.sqrt(x * x + y * y + z * z);
    if (length === 0) continue;
    out[4 * v] = 127 * x / length; out[4 * v + 1] = 127 * y / length; out[4 * v + 2] = 127 * z / length;
  }
  return out;
}

/** Triangles of tubes along points. */
class Tubes {
  constructor() { this.centers = []; this.normals = []; this.colors = []; this.indices = []; }
  /** Adds a tube. A radius below 0 is a point of no width at any distance. */
  add(points, radii, color) {
    if (points.length < 2) return;
    let aside = null;
    const first = this.centers.length / 4;
    for (let i = 0; i < points.length; ++i) {
      const way = unit(subtract(points[Math.min(i + 1, points.length - 1)], points[Math.max(i - 1, 0)]));
      aside = aside || (Math.abs(way[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]);
      aside = unit(subtract(aside, scale(way, dot(aside, way))));
      const other = cross(way, aside);
      for (let k = 0; k < TUBE_SIDES; ++k) {
        const angle = 2 * Math.PI * k / TUBE_SIDES;
        this.centers.push(...points[i], radii[i]);
        this.normals.push(...add(scale(aside, Math.cos(angle)), scale(other, Math.sin(angle))));
        this.colors.push(...color, 255);
        if (i === 0) continue;
        const now = first + i * TUBE_SIDES, next = (k + 1) % TUBE_SIDES, before = now - TUBE_SIDES;
        this.indices.push(before + k, before + next, now + k, now + k, before + next, now + next);
      }
    }
  }
  addArrow(from, along, color) {
    const width = Math.min(0.0012, 0.05 * lengthOf(along));  // metres
    const tip = add(from, along), neck = add(from, scale(along, 0.7));
    this.add([from, neck], [width, width], color);
    this.add([neck, tip], [2.5 * width, -1], color);
  }
}

class Painter {
  /** @throws Error  WebGL 2 is missing */
  constructor(canvas) {
    const gl = this.gl = canvas.getContext('webgl2', {antialias: true, alpha: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error('no WebGL 2');
    this.canvas = canvas;
    this.tissue = programOf(gl, SURFACE_VERTEX, TISSUE);
    this.metal = programOf(gl, TOOL_VERTEX, METAL);
    this.tube = programOf(gl, TUBE_VERTEX, METAL);
    this.surface = {array: gl.createVertexArray(), positions: gl.createBuffer(), normals: gl.createBuffer(), colors: gl.createBuffer(), indices: gl.createBuffer()};
    this.tubes = this.makeTubes();
    this.lines = this.makeTubes();
    this.shapes = new Map();
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }
  makeTubes() {
    const gl = this.gl;
    return {array: gl.createVertexArray(), centers: gl.createBuffer(), normals: gl.createBuffer(), colors: gl.createBuffer(), indices: gl.createBuffer(), count: 0};
  }
  fill(target, buffer, data) {
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, data, this.gl.DYNAMIC_DRAW);
  }
  attribute(place, size, type, normalized, stride, offset) {
    this.gl.enableVertexAttribArray(place);
    this.gl.vertexAttribPointer(place, size, type, normalized, stride, offset);
  }
  /** Takes a frame to draw. @param lines  of a task   @param newton_m  length of the arrow of a newton */
  take(frame, scene, lines, newton_m) {
    this.frame = frame;
    this.takeSurface(frame.surface);
    const at = (steps, i) => [0, 1, 2].map((axis) => frame.grid.origin[axis] + frame.grid.step * steps[3 * i + axis]);
    const tubes = new Tubes();
    for (const {style, steps} of frame.tubes) {
      const look = scene.tubes[style], points = Array.from({length: steps.length / 3}, (_, i) => at(steps, i));
      tubes.add(points, points.map(() => look.radius), look.color);
    }
    for (const {tip, force_n} of frame.styluses) {
      if (lengthOf(force_n) > LEAST_FORCE_N) tubes.addArrow(tip, scale(force_n, newton_m), FORCE_COLOR);
    }
    this.takeTubes(this.tubes, tubes);
    if (lines === this.shown_lines) return;
    this.shown_lines = lines;
    const task = new Tubes();
    for (const line of lines) {
      const points = Array.from({length: line.length / 3}, (_, i) => line.slice(3 * i, 3 * i + 3));
      task.add(points, points.map(() => 0), [0, 158, 115]);
    }
    this.takeTubes(this.lines, task);
  }
  takeSurface(surface) {
    const gl = this.gl, own = this.surface, {vertices} = surface.shape;
    gl.bindVertexArray(own.array);
    this.fill(gl.ARRAY_BUFFER, own.positions, surface.steps);
    for (let axis = 0; axis < 3; ++axis) this.attribute(axis, 1, gl.UNSIGNED_SHORT, false, 0, 2 * axis * vertices);
    this.fill(gl.ARRAY_BUFFER, own.normals, normalsOf(surface));
    this.attribute(3, 3, gl.BYTE, true, 4, 0);
    if (own.shown_colors !== surface.colors) {
      this.fill(gl.ARRAY_BUFFER, own.colors, surface.colors);
      this.attribute(4, 4, gl.UNSIGNED_BYTE, true, 0, 0);
      own.shown_colors = surface.colors;
    }
    if (own.shown_shape === surface.shape) return;
    own.shown_shape = surface.shape;
    const {corners, kinds} = surface.shape, ordered = new Uint32Array(corners.length);
    let at = 0;
    for (const kind of [0, 1]) {
      for (let t = 0; t < kinds.length; ++t) {
        if (kinds[t] !== kind) continue;
        ordered.set(corners.subarray(3 * t, 3 * t + 3), at);
        at += 3;
      }
      if (kind === 0) own.skin = at;
    }
    own.all = at;
    this.fill(gl.ELEMENT_ARRAY_BUFFER, own.indices, ordered);
  }
  takeTubes(own, tubes) {
    const gl = this.gl;
    gl.bindVertexArray(own.array);
    this.fill(gl.ARRAY_BUFFER, own.centers, new Float32Array(tubes.centers));
    this.attribute(0, 4, gl.FLOAT, false, 0, 0);
    this.fill(gl.ARRAY_BUFFER, own.normals, new Float32Array(tubes.normals));
    this.attribute(1, 3, gl.FLOAT, false, 0, 0);
    this.fill(gl.ARRAY_BUFFER, own.colors, new Uint8Array(tubes.colors));
    this.attribute(2, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    this.fill(gl.ELEMENT_ARRAY_BUFFER, own.indices, new Uint32Array(tubes.indices));
    own.count = tubes.indices.length;
  }
  shapeOf(number, shape) {
    if (this.shapes.has(number)) return this.shapes.get(number);
    const gl = this.gl, array = gl.createVertexArray(), buffers = [gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(array);
    this.fill(gl.ARRAY_BUFFER, buffers[0], shape.vertices);
    this.attribute(0, 3, gl.FLOAT, false, 28, 0);
    this.attribute(1, 3, gl.FLOAT, false, 28, 12);
    this.attribute(2, 4, gl.UNSIGNED_BYTE, true, 28, 24);
    this.fill(gl.ELEMENT_ARRAY_BUFFER, buffers[1], shape.indices);
    this.shapes.set(number, {array, buffers, solid: shape.solid, all: shape.indices.length});
    return this.shapes.get(number);
  }
  /** Frees a shape that no frame shows any more. */
  drop(number) {
    const shape = this.shapes.get(number);
    if (!shape) return;
    this.gl.deleteVertexArray(shape.array);
    for (const buffer of shape.buffers) this.gl.deleteBuffer(buffer);
    this.shapes.delete(number);
  }
  use(program, view, mesh) {
    this.gl.useProgram(program.program);
    this.gl.uniformMatrix4fv(program.place('optical_from_mesh'), false, mesh ? times(view.optical, mesh) : view.optical);
    this.gl.uniformMatrix4fv(program.place('clip_from_optical'), false, view.clip);
  }
  /** Draws the frame. @param shapes  of tools, by number */
  draw(orbit, shapes) {
    const gl = this.gl, {width, height} = this.canvas, focal = orbit.focalIn(width, height);
    const near = Math.max(orbit.distance / 100, 1e-4), far = orbit.distance * 100;
    const view = {optical: inverseMatrix(orbit.position, orbit.orientation), clip: projection(focal, width, height, near, far)};
    gl.viewport(0, 0, width, height);
    gl.clearColor(...BACKGROUND, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.frame) return;
    this.use(this.tissue, view);
    gl.uniform4f(this.tissue.place('grid'), ...this.frame.grid.origin, this.frame.grid.step);
    gl.bindVertexArray(this.surface.array);
    gl.uniform1i(this.tissue.place('wall'), 0);
    gl.drawElements(gl.TRIANGLES, this.surface.skin, gl.UNSIGNED_INT, 0);
    gl.uniform1i(this.tissue.place('wall'), 1);
    if (this.surface.all > this.surface.skin)
      gl.drawElements(gl.TRIANGLES, this.surface.all - this.surface.skin, gl.UNSIGNED_INT, 4 * this.surface.skin);
    this.drawTools(view, shapes, false);
    this.drawTubes(this.tubes, view, focal);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    this.drawTools(view, shapes, true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.DEPTH_TEST);
    this.drawTubes(this.lines, view, focal);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
  drawTools(view, shapes, translucent) {
    const gl = this.gl;
    for (const tool of this.frame.tools) {
      const shape = this.shapeOf(tool.shape, shapes.get(tool.shape));
      const first = translucent ? shape.solid : 0, count = translucent ? shape.all - shape.solid : shape.solid;
      if (count === 0) continue;
      this.use(this.metal, view, poseMatrix(tool.position, tool.orientation));
      gl.bindVertexArray(shape.array);
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * first);
    }
  }
  drawTubes(own, view, focal) {
    if (own.count === 0) return;
    this.use(this.tube, view);
    this.gl.uniform1f(this.tube.place('pixel'), 1 / focal);
    this.gl.bindVertexArray(own.array);
    this.gl.drawElements(this.gl.TRIANGLES, own.count, this.gl.UNSIGNED_INT, 0);
  }
}
