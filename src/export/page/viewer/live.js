'use strict';
// Live view of a simulator: frames over the web socket of page_server (src/nodes/page/live_message.h).
const RETRY_MS = 2000, RATE_OVER_MS = 1000;

class Live extends View {
  constructor() {
    super();
    this.scene = {name: '', bodies: [], styluses: [], tubes: []};
    this.waiting = [];  // frames that arrived since the last picture; the newest is shown
    this.taken = [];    // their numbers, which the server hears once the picture is drawn
    this.moments = [];  // of the pictures of the last second
  }
  async begin() {
    this.listenToView();
    byId('reset').addEventListener('click', () => this.call('reset'));
    byId('pause').addEventListener('click', () => this.call(this.state.paused ? 'resume' : 'pause'));
    byId('start').addEventListener('click', () => this.call('start_task', byId('task').value));
    this.connect();
  }
  connect() {
    this.socket = new WebSocket(`ws://${location.host}/live`);
    this.socket.binaryType = 'arraybuffer';
    this.parts = new Map();
    this.waiting = [];
    this.anew = true;
    this.socket.onmessage = ({data}) => {
      if (typeof data === 'string') this.hear(JSON.parse(data));
      else this.receive(data);
    };
    this.socket.onclose = ({reason}) => {
      this.say('status', `no connection${reason ? ': ' + reason : ''}; the picture is old`);
      setTimeout(() => this.connect(), RETRY_MS);
    };
  }
  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
  call(service, task) { this.send(task === undefined ? {call: service} : {call: service, task}); }
  /** Takes a message of bytes: the length of a header, the header as JSON, and its data. */
  receive(data) {
    const size = new DataView(data).getUint32(0, true), bytes = new Uint8Array(data, 4 + size);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size)));
    if ('frame' in header) {
      this.parts = new Map(header.needs.map((number) => [number, this.parts.get(number)]));  // the server forgets the others too
      this.waiting.push({header, bytes, parts: this.parts});
      if (this.frame) return;
      this.tick();
      this.ready();
    } else if ('step' in header) {
      this.parts.set(header.part, {...header, surface: readSurface(new Reader(bytes), NOTHING)});
    } else {
      const split = 28 * header.vertices;
      this.parts.set(header.part, {solid: header.solid, vertices: bytes.slice(0, split), indices: new Uint32Array(bytes.slice(split).buffer)});
    }
  }
  /** Shows the newest frame, before a picture is drawn. */
  tick() {
    const newest = this.waiting.at(-1);
    if (!newest) return;
    this.taken = this.waiting.map((frame) => frame.header.frame);
    this.waiting = [];
    const {header, bytes, parts} = newest, base = parts.get(header.base);
    for (const number of [...this.painter.shapes.keys()])
      if (this.anew || !header.needs.includes(number)) this.painter.drop(number);
    this.anew = false;
    this.shapes = parts;
    this.frame = {...readFrame(new Reader(bytes), {surface: base.surface, tubes: []}), grid: base, header};
    this.painter.take(this.frame, header, NO_LINES, header.newton_m);
    this.dirty = true;
  }
  draw() {
    super.draw();
    if (this.taken.length) this.moments.push(performance.now());
    for (const shown of this.taken) this.send({shown});
    this.taken = [];
    this.describe();
  }
  /** Takes a message of text: the state of the simulator, or the answer of a service. */
  hear({state, answer}) {
    if (answer !== undefined) this.say('answer', answer);
    if (!state) return;
    this.state = state;
    if (!this.frame) byId('fault').firstElementChild.textContent = state.text;
    const cameras = JSON.stringify(state.cameras);
    if (cameras !== this.offered) {
      const chosen = byId('camera').value, first = !this.cameras.length;
      this.offer(state.cameras);
      if (first) this.look(Math.max(0, state.cameras.findIndex((camera) => camera.name === this.options.get('camera'))));
      else byId('camera').value = state.cameras[chosen] ? chosen : 'free';
      this.offered = cameras;
    }
    document.documentElement.classList.toggle('control', state.control);
    byId('pause').textContent = state.paused ? 'Resume' : 'Pause';
    if (byId('task').options.length !== state.tasks.length)
      byId('task').replaceChildren(...state.tasks.map((task) => new Option(task, task)));
    this.describe();
  }
  describe() {
    if (!this.state) return;
    const tubes = this.frame ? this.frame.header.tubes : [];
    const scene = {name: this.state.name, bodies: this.state.bodies, styluses: this.state.styluses, tubes};
    if (JSON.stringify(scene) !== JSON.stringify(this.scene)) {
      this.scene = scene;
      document.title = `${scene.name || 'no scene'}: viscera, live`;
      this.enter(scene, this.state.newton_m, false);
    }
    if (this.frame) this.showForces(this.frame.styluses);
    const now = performance.now();
    this.moments = this.moments.filter((moment) => now - moment < RATE_OVER_MS);
    const {task} = this.state;
    this.say('status', this.state.text + (task ? `; ${task.title}: ${task.step}; score ${task.score.toFixed(1)}` : ''));
    this.say('rate', `${this.moments.length} pictures per second`);
  }
  say(id, text) {
    if (byId(id).textContent !== text) byId(id).textContent = text;
  }
}

const live = start(() => new Live());
