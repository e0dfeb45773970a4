'use strict';
// Decoding of a page's blocks (page_writer.h, surface_coder.h): surface meshes, tubes, placed tools and forces of each frame.
const NONE = 0xffffffff;

/** Returns the bytes of a block, decompressed. */
async function loadBlock(number) {
  const text = document.getElementById('b' + number).textContent;
  let packed;
  if (Uint8Array.fromBase64) {
    packed = Uint8Array.fromBase64(text);
  } else {
    const binary = atob(text);
    packed = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) packed[i] = binary.charCodeAt(i);
  }
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }
  byte() { return this.bytes[this.at++]; }
  count() {
    let out = 0, scale = 1;
    for (;; scale *= 128) {
      const byte = this.bytes[this.at++];
      out += (byte & 127) * scale;
      if (byte < 128) return out;
    }
  }
  signed() {
    const bits = this.count();
    return bits % 2 ? -(bits + 1) / 2 : bits / 2;
  }
  float() {
    this.at += 4;
    return this.data.getFloat32(this.at - 4, true);
  }
  floats(n) { return Array.from({length: n}, () => this.float()); }
}

/** Reads the difference of two lists of triangles. A list has {corners: [3 n], kinds: [n], neighbours: [vertices]}. */
function readTriangles(reader, before) {
  const vertices = reader.count(), removed = new Set();
  for (let left = reader.count(), after = 0; left > 0; --left) {
    const index = after + reader.count();
    removed.add(index);
    after = index + 1;
  }
  const added = reader.count(), old = before.kinds.length, total = old - removed.size + added;
  const corners = new Uint32Array(3 * total), kinds = new Uint8Array(total);
  let t = 0;
  for (let i = 0; i < old; ++i) {
    if (removed.has(i)) continue;
    for (let c = 0; c < 3; ++c) corners[3 * t + c] = before.corners[3 * i + c];
    kinds[t++] = before.kinds[i];
  }
  for (let corner = 0; t < total; ++t) {
    kinds[t] = reader.byte();
    for (let c = 0; c < 3; ++c) corners[3 * t + c] = corner = (corner + reader.signed()) >>> 0;
    corner = corners[3 * t];
  }
  return {corners, kinds, vertices, neighbours: neighboursOf(corners, vertices)};
}

/** Returns for each vertex the two connected vertices with the largest smaller indices, which predict its motion. */
function neighboursOf(corners, vertices) {
  const out = new Uint32Array(2 * vertices).fill(NONE);
  const note = (v, other) => {
    if (other >= v) return;
    const first = out[2 * v], second = out[2 * v + 1];
    if (first === NONE) {
      out[2 * v] = out[2 * v + 1] = other;
    } else if (other > first) {
      out[2 * v] = other;
      out[2 * v + 1] = first;
    } else if (other < first && (second === first || other > second)) {
      out[2 * v + 1] = other;
    }
  };
  for (let i = 0; i < corners.length; i += 3) {
    const a = corners[i], b = corners[i + 1], c = corners[i + 2];
    note(a, b); note(a, c); note(b, a); note(b, c); note(c, a); note(c, b);
  }
  return out;
}

function readColors(reader, before, vertices) {
  const known = before.colors.length / 4, out = new Uint8Array(4 * vertices);
  for (let channel = 0; channel < 4; ++channel) {
    for (let v = 0; v < vertices; ++v)
      out[4 * v + channel] = reader.byte() + (v < known ? before.colors[4 * v + channel] : 0);
  }
  return out;
}

/** Returns positions in steps of the grid: x of all vertices, then y, then z. */
function readPositions(reader, before, neighbours, vertices) {
  const known = before.steps.length / 3, out = new Uint16Array(3 * vertices), bytes = reader.bytes;
  for (let axis = 0; axis < 3; ++axis) {
    const now = out.subarray(axis * vertices, (axis + 1) * vertices);
    const then = before.steps.subarray(axis * known, (axis + 1) * known);
    const pairs = reader.at, full = pairs + ((vertices + 1) >> 1);
    let longs = 0, long = 0;
    for (let at = pairs; at < full; ++at) longs += ((bytes[at] & 15) === 15) + (bytes[at] >> 4 === 15);
    for (let v = 0; v < vertices; ++v) {
      let bits = v & 1 ? bytes[pairs + (v >> 1)] >> 4 : bytes[pairs + (v >> 1)] & 15;
      if (bits === 15) {
        bits = bytes[full + long] | bytes[full + longs + long] << 8;
        ++long;
      }
      const a = neighbours[2 * v], b = neighbours[2 * v + 1];
      let value = (bits >>> 1) ^ -(bits & 1);
      if (v < known) value += then[v];
      if (a !== NONE) value += (now[a] + now[b] - (v < known ? then[a] + then[b] : 0) + 1) >> 1;
      now[v] = value;
    }
    reader.at = full + 2 * longs;
  }
  return out;
}

const NOTHING = {shape: {corners: new Uint32Array(0), kinds: new Uint8Array(0)}, colors: new Uint8Array(0), steps: new Uint16Array(0)};

/** Reads a surface mesh: {shape: triangles, colors: RGBA, steps}. */
function readSurface(reader, before) {
  const flags = reader.byte();
  const shape = flags & 1 ? readTriangles(reader, before.shape) : before.shape;
  const colors = flags & 2 ? readColors(reader, before, shape.vertices) : before.colors;
  return {shape, colors, steps: readPositions(reader, before, shape.neighbours, shape.vertices)};
}

function readTubes(reader, before) {
  const out = [];
  for (let left = reader.count(); left > 0; --left) {
    const style = reader.count(), places = reader.count(), follows = reader.byte(), steps = new Int32Array(3 * places);
    const old = follows ? before[out.length].steps : null;
    for (let i = 0; i < 3 * places; ++i) steps[i] = reader.signed() + (old ? old[i] : i < 3 ? 0 : steps[i - 3]);
    out.push({style, steps});
  }
  return out;
}

/** Reads a whole frame behind another one. */
function readFrame(reader, before) {
  const surface = readSurface(reader, before.surface), tubes = readTubes(reader, before.tubes);
  const tools = [];
  for (let left = reader.count(); left > 0; --left)
    tools.push({shape: reader.count(), position: reader.floats(3), orientation: reader.floats(4)});
  const styluses = Array.from({length: reader.count()}, () => ({force_n: reader.floats(3)}));
  for (const stylus of styluses) stylus.tip = reader.floats(3);
  return {surface, tubes, tools, styluses};
}

/** Frames of a page by number, decoded when they are shown. */
class Session {
  constructor(index) {
    this.index = index;
    this.blocks = [];
    let first = 0;
    for (const block of index.blocks) {
      this.blocks.push({...block, first});
      first += block.frames;
    }
    this.bytes = new Map();  // of blocks, the last used ones
    this.bases = new Map();
    this.shapes = new Map();
    this.at = null;  // the last decoded frame
  }
  blockOf(frame) { return this.blocks.find((block) => frame < block.first + block.frames); }
  async bytesOf(number) {
    if (!this.bytes.has(number)) this.bytes.set(number, loadBlock(number));
    const bytes = await this.bytes.get(number);
    if (this.bytes.size > 4) this.bytes.delete([...this.bytes.keys()].find((other) => other !== number));
    return bytes;
  }
  async baseOf(number) {
    if (!this.bases.has(number)) {
      const bytes = await loadBlock(this.index.bases[number].block);
      this.bases.clear();
      this.bases.set(number, readSurface(new Reader(bytes), NOTHING));
    }
    return this.bases.get(number);
  }
  /** Returns a shape of tools: {vertices: bytes of 28 each, indices, solid}. */
  async shapeOf(number) {
    if (!this.shapes.has(number)) {
      const {block, vertices, indices, solid} = this.index.shapes[number], bytes = await loadBlock(block);
      const split = 28 * vertices;
      this.shapes.set(number, {vertices: bytes.slice(0, split), indices: new Uint32Array(bytes.slice(split, split + 4 * indices).buffer), solid});
    }
    return this.shapes.get(number);
  }
  /** Returns a frame with its base's grid and scene. Waits only for blocks that are not decompressed yet. */
  async frame(number) {
    const block = this.blockOf(number), bytes = await this.bytesOf(block.block), base = await this.baseOf(block.base);
    let at = this.at;
    if (!at || at.block !== block || at.number > number)
      at = {block, number: block.first - 1, frame: {surface: base, tubes: []}, reader: new Reader(bytes)};
    while (at.number < number) {
      at.frame = readFrame(at.reader, at.frame);
      ++at.number;
    }
    this.at = at;
    for (const tool of at.frame.tools) await this.shapeOf(tool.shape);
    const grid = this.index.bases[block.base];
    return {...at.frame, number, grid, scene: grid.scene};
  }
  /** Begins to decompress the block behind a frame. */
  prepareAfter(number) {
    const next = this.blocks[this.blocks.indexOf(this.blockOf(number)) + 1];
    if (next) this.bytesOf(next.block);
  }
}
