'use strict';
// Time, views and controls of the page. The address may have #t=SECONDS&camera=NAME&plain=1.
const KINDS = {  // of marks: colour, and name in the legend
  cut: ['#ff6b5e', 'cut'], clip: ['#b8e05a', 'clip'], knot: ['#6cb2ff', 'knot'],
  task: ['#00c389', 'task'], mistake: ['#ffb347', 'mistake that costs points'], mark: ['#d0d4da', 'mark']};
const byId = (id) => document.getElementById(id);

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

class Player {
  constructor(index) {
    this.index = index;
    this.session = new Session(index);
    this.painter = new Painter(byId('view'));
    this.orbit = new Orbit();
    this.number = 0;
    this.playing = false;
    this.scene = null;
    this.options = new URLSearchParams(location.hash.slice(1));
    document.documentElement.classList.toggle('plain', this.options.has('plain'));
  }
  get times() { return this.index.times; }
  get last() { return this.times.length - 1; }
  async begin() {
    this.putMarks();
    this.listen();
    await this.show(this.options.has('t') ? this.frameAt(Number(this.options.get('t'))) : 0);
    if (this.options.has('camera')) this.look(this.cameras.findIndex((camera) => camera.name === this.options.get('camera')));
    this.draw();
    byId('fault').replaceChildren();
    document.documentElement.dataset.state = 'ready';
    requestAnimationFrame((now) => this.tick(now));
  }
  get cameras() { return this.index.scenes[this.frame.scene].cameras; }
  /** Returns the last frame that is not after a time. */
  frameAt(time_s) {
    let low = 0, high = this.last;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time_s + 1e-6) low = middle;
      else high = middle - 1;
    }
    return low;
  }
  /** Shows a frame. If another one is requested meanwhile, that one is shown instead. */
  async show(number) {
    this.wanted = Math.min(Math.max(number, 0), this.last);
    if (this.busy) return this.busy;
    this.busy = (async () => {
      while (this.wanted !== this.shown) {
        const next = this.wanted;
        this.take(await this.session.frame(next));
        this.shown = next;
      }
    })();
    try {
      await this.busy;
    } finally {
      this.busy = null;
    }
  }
  take(frame) {
    this.frame = frame;
    if (this.scene !== frame.scene) this.enter(frame.scene);
    this.painter.take(frame, this.index.scenes[frame.scene], this.entryAt(this.index.lines, frame.number)?.[1] ?? NO_LINES, this.index.newton_m);
    this.number = frame.number;
    this.describe();
    this.dirty = true;
  }
  entryAt(list, number) { return list.filter((entry) => entry[0] <= number).pop(); }
  /** Begins a scene: its names, and the view of its first camera. */
  enter(number) {
    this.scene = number;
    const scene = this.index.scenes[number];
    document.title = `${scene.name}: session of viscera`;
    byId('title').textContent = scene.name;
    byId('camera').replaceChildren(...scene.cameras.map((camera, i) => new Option(camera.name, i)), new Option('free', 'free'));
    byId('bodies').replaceChildren(...scene.bodies.map((body) => item(rgb(body.color.map((x) => 255 * x)), body.name)));
    this.forces = scene.styluses.map(() => Object.assign(document.createElement('span'), {className: 'value'}));
    byId('tools').replaceChildren(...scene.styluses.map((name, s) => item('#c8ccd2', name, this.forces[s])));
    const parts = new Map(scene.tubes.map((tube) => [tube.part, tube.color]));
    const things = [...parts].map(([part, color]) => item(rgb(color), part));
    things.push(item(rgb(FORCE_COLOR), `force on a tool, ${1000 * this.index.newton_m} mm per newton`));
    if (this.index.lines.some((entry) => entry[1].length)) things.push(item('rgb(0,158,115)', 'what the task asks for'));
    byId('things').replaceChildren(...things);
    if (scene.cameras.length) this.look(0);
  }
  look(camera) {
    if (!this.cameras[camera]) return;
    this.orbit.look(this.cameras[camera]);
    byId('camera').value = String(camera);
    this.dirty = true;
  }
  describe() {
    const time_s = this.times[this.number];
    byId('clock').textContent = time_s.toFixed(2) + ' s';
    byId('time').value = this.number;
    const [, task, step, score] = this.entryAt(this.index.statuses, this.number);
    byId('status').textContent = task ? `${task}: ${step}; score ${score.toFixed(1)}` : '';
    this.frame.styluses.forEach(({force_n}, s) => { this.forces[s].textContent = lengthOf(force_n).toFixed(2) + ' N'; });
  }
  putMarks() {
    const begin = this.times[0], span = Math.max(this.times[this.last] - begin, 1e-6), events = [];
    byId('time').max = this.last;
    for (const mark of [...this.index.marks].sort((a, b) => a.from - b.from)) {
      const [color] = KINDS[mark.kind] || KINDS.mark, tick = document.createElement('i');
      const place = (time_s) => 100 * (this.frameAt(time_s) / Math.max(this.last, 1));
      tick.style.left = place(mark.from) + '%';
      tick.style.width = `calc(${Math.max(place(mark.to) - place(mark.from), 0)}% + 1px)`;
      tick.style.background = color;
      tick.title = `${mark.from.toFixed(2)} s: ${mark.text}`;
      tick.addEventListener('click', () => this.jump(mark.from));
      byId('marks').append(tick);
      const button = document.createElement('button'), line = document.createElement('li');
      button.append(...item(color, `${mark.from.toFixed(1)} s: ${mark.text}`).childNodes);
      button.addEventListener('click', () => this.jump(mark.from));
      line.append(button);
      events.push(line);
    }
    byId('events').replaceChildren(...events);
    if (!events.length) byId('events').append(item('transparent', 'none'));
  }
  jump(time_s) {
    this.play(false);
    this.show(this.frameAt(time_s));
  }
  play(on) {
    if (on && this.number >= this.last) this.show(0);
    this.playing = on;
    this.clock = null;
    byId('play').textContent = on ? '\u23f8' : '\u25b6';
    byId('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  }
  tick(now) {
    if (this.playing && !this.busy) {
      if (!this.clock) this.clock = {now, from: this.times[this.number]};
      const time_s = this.clock.from + Number(byId('speed').value) * (now - this.clock.now) / 1000;
      const wanted = this.frameAt(time_s);
      if (wanted !== this.number) this.show(wanted);
      this.session.prepareAfter(wanted);
      if (wanted >= this.last) this.play(false);
    }
    if (this.dirty || this.resized()) this.draw();
    requestAnimationFrame((next) => this.tick(next));
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
    this.painter.draw(this.orbit, this.session.shapes);
    this.dirty = false;
  }
  listen() {
    byId('play').addEventListener('click', () => this.play(!this.playing));
    byId('time').addEventListener('input', () => {
      this.play(false);
      this.show(Number(byId('time').value));
    });
    byId('speed').addEventListener('change', () => { this.clock = null; });
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
  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.tagName === 'SELECT') return;
    const step = event.shiftKey ? Math.round(this.index.rate_hz) : 1;
    const go = (number) => { this.play(false); this.show(number); };
    const actions = {
      ' ': () => this.play(!this.playing), ArrowLeft: () => go(this.number - step), ArrowRight: () => go(this.number + step),
      Home: () => go(0), End: () => go(this.last), l: () => this.toggleLegend(),
      '+': () => this.zoom(0.9), '=': () => this.zoom(0.9), '-': () => this.zoom(1 / 0.9)};
    const action = /^[1-9]$/.test(event.key) ? () => this.look(Number(event.key) - 1) : actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
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
const NO_LINES = [];

let player = null;
(() => {
  if (typeof DecompressionStream === 'undefined')
    return fail('This browser cannot decompress the session: DecompressionStream is missing. Use a browser of 2023 or later.');
  try {
    player = new Player(JSON.parse(byId('index').textContent));
  } catch (error) {
    return fail(error.message === 'no WebGL 2' ? 'This page needs WebGL 2, which this browser or its graphics driver does not offer.' : String(error));
  }
  player.begin().catch((error) => fail('The session cannot be shown: ' + error));
})();
