'use strict';
// Time and frames of a page of a session. The address may have #t=SECONDS&camera=NAME, and what view.js takes.
const KINDS = {  // of marks: colour, and name in the legend
  cut: ['#ff6b5e', 'cut'], clip: ['#b8e05a', 'clip'], knot: ['#6cb2ff', 'knot'],
  task: ['#00c389', 'task'], mistake: ['#ffb347', 'mistake that costs points'], mark: ['#d0d4da', 'mark']};
class Player extends View {
  constructor(index) {
    super();
    this.index = index;
    this.session = new Session(index);
    this.shapes = this.session.shapes;
    this.number = 0;
    this.playing = false;
    this.scene = null;
  }
  get times() { return this.index.times; }
  get last() { return this.times.length - 1; }
  async begin() {
    this.putMarks();
    this.listen();
    await this.show(this.options.has('t') ? this.frameAt(Number(this.options.get('t'))) : 0);
    if (this.options.has('camera')) this.look(this.cameras.findIndex((camera) => camera.name === this.options.get('camera')));
    this.ready();
  }
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
    if (this.scene !== frame.scene) this.enterScene(frame.scene);
    this.painter.take(frame, this.index.scenes[frame.scene], this.entryAt(this.index.lines, frame.number)?.[1] ?? NO_LINES, this.index.newton_m);
    this.number = frame.number;
    this.describe();
    this.dirty = true;
  }
  entryAt(list, number) { return list.filter((entry) => entry[0] <= number).pop(); }
  /** Begins a scene: its names, and the view of its first camera. */
  enterScene(number) {
    this.scene = number;
    const scene = this.index.scenes[number];
    document.title = `${scene.name}: session of viscera`;
    this.enter(scene, this.index.newton_m, this.index.lines.some((entry) => entry[1].length));
    this.offer(scene.cameras);
    this.look(0);
  }
  describe() {
    const time_s = this.times[this.number];
    byId('clock').textContent = time_s.toFixed(2) + ' s';
    byId('time').value = this.number;
    const [, task, step, score] = this.entryAt(this.index.statuses, this.number);
    byId('status').textContent = task ? `${task}: ${step}; score ${score.toFixed(1)}` : '';
    this.showForces(this.frame.styluses);
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
  }
  listen() {
    byId('play').addEventListener('click', () => this.play(!this.playing));
    byId('time').addEventListener('input', () => {
      this.play(false);
      this.show(Number(byId('time').value));
    });
    byId('speed').addEventListener('change', () => { this.clock = null; });
    this.listenToView();
  }
  actions(event) {
    const step = event.shiftKey ? Math.round(this.index.rate_hz) : 1;
    const go = (number) => { this.play(false); this.show(number); };
    return {
      ...super.actions(event), ' ': () => this.play(!this.playing), ArrowLeft: () => go(this.number - step),
      ArrowRight: () => go(this.number + step), Home: () => go(0), End: () => go(this.last)};
  }
}

const player = start(
  (index) => new Player(index),
  typeof DecompressionStream === 'undefined' &&
    'This browser cannot decompress the session: DecompressionStream is missing. Use a browser of 2023 or later.');
