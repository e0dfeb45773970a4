'use strict';
// View of a session: camera, legend, pointers and drawing. Times and frames come from player.js (a file) or live.js (a
// web socket). The address may have #plain=1: no controls.
const byId = (id) => document.getElementById(id);
const NO_LINES = [];

function fail(text) {
  byId('fault').replaceChildren(Object.assign(document.createElement('p'), {textContent: text}));
  document.documentElement.dataset.state = 'failed';
}

function item(color, text, value) {
  const out = document.createElement('li'), chip = document.createElement('span'), name = document.createElement('span');
  chip.className = 'chip';
  chip.style.background = color;
  name.textContent = text;
  out.append(chip, name);
  if (value) out.append(value);
  return out;
}
const rgb = (color) => `rgb(${color.map((x) => Math.round(x)).join(',')})`;

class View {
  /** @throws Error  WebGL 2 is missing */
  constructor() {
    this.painter = new Painter(byId('view'));
    this.orbit = new Orbit();
    this.cameras = [];
    this.shapes = new Map();  // of tools, by number
    this.options = new URLSearchParams(location.hash.slice(1));
    document.documentElement.classList.toggle('plain', this.options.has('plain'));
  }
  /** Begins to draw. */
  ready() {
    this.draw();
    byId('fault').replaceChildren();
    document.documentElement.dataset.state = 'ready';
    const draw = (now) => {
      this.tick(now);
      if (this.dirty || this.resized()) this.draw();
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }
  tick() {}
  /** Shows the names of a scene: {name, bodies, styluses, tubes}. @param newton_m  length of the arrow of a newton */
  enter(scene, newton_m, has_lines) {
    byId('title').textContent = scene.name;
    byId('bodies').replaceChildren(...scene.bodies.map((body) => item(rgb(body.color.map((x) => 255 * x)), body.name)));
    this.forces = scene.styluses.map(() => Object.assign(document.createElement('span'), {className: 'value'}));
    byId('tools').replaceChildren(...scene.styluses.map((name, s) => item('#c8ccd2', name, this.forces[s])));
    const parts = new Map(scene.tubes.map((tube) => [tube.part, tube.color]));
    const things = [...parts].map(([part, color]) => item(rgb(color), part));
    things.push(item(rgb(FORCE_COLOR), `force on a tool, ${1000 * newton_m} mm per newton`));
    if (has_lines) things.push(item('rgb(0,158,115)', 'what the task asks for'));
    byId('things').replaceChildren(...things);
  }
  offer(cameras) {
    this.cameras = cameras;
    byId('camera').replaceChildren(...cameras.map((camera, i) => new Option(camera.name, i)), new Option('free', 'free'));
  }
  look(camera) {
    if (!this.cameras[camera]) return;
    this.orbit.look(this.cameras[camera]);
    byId('camera').value = String(camera);
    this.dirty = true;
  }
  showForces(styluses) {
    this.forces?.forEach((value, s) => { value.textContent = lengthOf(styluses[s]?.force_n ?? [0, 0, 0]).toFixed(2) + ' N'; });
  }
  resized() {
    const canvas = byId('view'), fine = Math.min(window.devicePixelRatio || 1, 2);
    return canvas.width !== Math.round(canvas.clientWidth * fine) || canvas.height !== Math.round(canvas.clientHeight * fine);
  }
  draw() {
    const canvas = byId('view'), fine = Math.min(window.devicePixelRatio || 1, 2);
    if (this.resized()) {
      canvas.width = Math.round(canvas.clientWidth * fine);
      canvas.height = Math.round(canvas.clientHeight * fine);
    }
    this.painter.draw(this.orbit, this.shapes);
    this.dirty = false;
  }
  listenToView() {
    byId('camera').addEventListener('change', () => this.look(Number(byId('camera').value)));
    byId('legend-button').addEventListener('click', () => this.toggleLegend());
    byId('view').addEventListener('webglcontextlost', () => fail('The graphics processor was lost. Load the page again.'));
    window.addEventListener('keydown', (event) => this.key(event));
    this.listenToPointers(byId('view'));
  }
  toggleLegend() {
    const legend = byId('legend');
    legend.hidden = !legend.hidden;
    byId('legend-button').setAttribute('aria-expanded', String(!legend.hidden));
  }
  /** Returns what keys do, by key. */
  actions() {
    return {
      l: () => this.toggleLegend(), '+': () => this.zoom(0.9), '=': () => this.zoom(0.9), '-': () => this.zoom(1 / 0.9)};
  }
  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === 'SELECT') return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = /^[1-9]$/.test(key) ? () => this.look(Number(key) - 1) : this.actions(event)[key];
    if (!action) return;
    event.preventDefault();
    action();
  }
  free() {
    byId('camera').value = 'free';
    this.dirty = true;
  }
  zoom(factor) {
    this.orbit.zoom(factor);
    this.free();
  }
  listenToPointers(canvas) {
    const down = new Map();
    const middle = () => [...down.values()].reduce((sum, p) => [sum[0] + p[0] / down.size, sum[1] + p[1] / down.size], [0, 0]);
    const spread = () => {
      const [a, b] = [...down.values()];
      return Math.max(Math.hypot(a[0] - b[0], a[1] - b[1]), 1);
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, (event) => down.delete(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      if (!down.has(event.pointerId)) return;
      const before = middle(), wide = down.size === 2 ? spread() : 1;
      down.set(event.pointerId, [event.clientX, event.clientY]);
      const after = middle(), right = after[0] - before[0], below = after[1] - before[1];
      const moves = down.size === 2 || event.shiftKey || (event.buttons & 6) !== 0;
      if (moves) this.orbit.move(right, below, this.orbit.focalIn(canvas.clientWidth, canvas.clientHeight));
      else this.orbit.turn(0.008 * right, -0.008 * below);
      if (down.size === 2) this.orbit.zoom(wide / spread());
      this.free();
    });
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.0015 * event.deltaY));
    }, {passive: false});
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }
  /** Returns the pixels of the last picture, RGBA, rows from the top, for tests. */
  pixels() {
    const {gl, canvas} = this.painter, {width, height} = canvas, out = new Uint8Array(4 * width * height);
    this.draw();
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out);
    const rows = new Uint8Array(out.length);
    for (let y = 0; y < height; ++y) rows.set(out.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    return {width, height, rows};
  }
}

/** Makes the view of this page, or says why there is none. @param missing  what the browser lacks, or nothing */
function start(make, missing) {
  if (missing) return fail(missing);
  let view = null;
  try {
    view = make(JSON.parse(byId('index').textContent));
  } catch (error) {
    fail(error.message === 'no WebGL 2' ? 'This page needs WebGL 2, which this browser or its graphics driver does not offer.' : String(error));
    return null;
  }
  view.begin().catch((error) => fail('The session cannot be shown: ' + error));
  return view;
}
