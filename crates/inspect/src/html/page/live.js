// A running program: times and memory of its last frames, what it offers to change, and a texture while it changes.

const SHOWN_FRAMES = 600;
// Milliseconds for which the reason of a refusal is shown.
const REFUSAL_MS = 5000;

const medianOf = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

const liveView = {
  name: 'Live',
  frames: [],
  textures: 0,
  controls: {},
  wanted: null,
  refusedUntil: 0,

  build(panel) {
    this.state = h('span', { class: 'hint', role: 'status' }, 'connecting');
    this.buttons = h('span', { class: 'controls' });
    this.otherText = h('span');
    this.other = h('span', { class: 'hint', hidden: true }, this.otherText, h('button', { onclick: () => this.leave('') }, 'Show what it draws'));
    this.strip = h('canvas', { class: 'strip', width: SHOWN_FRAMES, height: 70, role: 'img', 'aria-label': 'Times of the last frames', ...hint('Bars: milliseconds from frame to frame, one colour for each plan; click a bar to see its plan. Line: memory.'), onclick: (event) => this.openPlan(event) });
    this.numbers = h('span', { class: 'value' });
    this.value = h('span', { class: 'value', 'aria-live': 'off' });
    this.canvas = h('canvas', { role: 'img', 'aria-label': 'The watched texture', onclick: (event) => this.askPixel(event), onpointermove: (event) => { this.value.textContent = this.snapshot ? valueAt(this.snapshot, this.texels, this.canvas, event) : ''; } });
    this.history = h('div', { class: 'history', 'aria-live': 'polite' });
    panel.append(
      h('div', { class: 'bar' }, this.state, this.buttons, this.other),
      h('div', { class: 'bar' }, this.strip, this.numbers),
      h('div', { class: 'bar' }, this.choices(), this.value),
      h('div', { class: 'scroll live' }, h('div', { class: 'stage' }, this.canvas), this.history));
    this.restore();
    this.connect();
  },

  // The texture to watch: its version, mip level and layer.
  choices() {
    const versions = (resource) => [...new Set(users[resource].filter(({ pass, access }) => access.writes && passes[pass].place).map(({ access }) => access.version + 1))].sort((a, b) => a - b);
    const shown = resources.map((_, index) => index).filter((index) => !resources[index].buffer && versions(index).length);
    const number = (label) => h('input', { type: 'number', min: 0, max: 4095, value: 0, 'aria-label': label, title: label, oninput: () => this.watch() });
    const option = (value, text) => h('option', { value }, text);
    [this.mip, this.layer] = [number('mip level'), number('layer')];
    this.version = h('select', { 'aria-label': 'Version', onchange: () => this.watch() });
    this.texture = h('select', { id: 'watched', 'aria-label': 'Texture', onchange: () => {
      this.version.replaceChildren(option('', 'last version'), ...versions(Number(this.texture.value)).map((version) => option(version, `v${version}`)));
      this.watch();
    } }, option('', 'no texture'), shown.map((index) => option(index, resourcePath(index))));
    const label = (text, input) => h('label', {}, `${text} `, input);
    return h('span', { class: 'controls' }, label('Watch', this.texture), this.version, label('mip', this.mip), label('layer', this.layer));
  },

  connect() {
    this.socket = new WebSocket(`${location.origin.replace('http', 'ws')}${location.pathname}socket`);
    this.socket.onopen = () => {
      this.state.textContent = 'connected';
      if (this.wanted) this.send({ watch: this.wanted });
    };
    this.socket.onmessage = (event) => this.take(JSON.parse(event.data));
    this.socket.onclose = () => {
      this.state.textContent = 'the program has ended, or does not answer';
      setTimeout(() => this.connect(), 1000);
    };
  },

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  },

  ask(request) { this.send({ request }); },

  watch() {
    const whole = (input) => Math.max(0, Math.floor(Number(input.value)) || 0);
    this.wanted = this.texture.value === '' ? null : {
      texture: resourcePath(Number(this.texture.value)), version: this.version.value ? Number(this.version.value) : null, mip: whole(this.mip), layer: whole(this.layer),
    };
    this.value.textContent = this.wanted ? 'waiting for a frame with it' : '';
    this.send({ watch: this.wanted });
  },

  take(message) {
    if (message.controls) this.showControls(message.controls);
    if (message.frames) this.showFrames(message.frames, message.times);
    if (message.texture) this.showTexture(message.texture);
    if (message.pixel) this.showPixel(message);
    if (message.refused) {
      this.state.textContent = `refused: ${message.refused}`;
      this.refusedUntil = performance.now() + REFUSAL_MS;
    }
  },

  showControls(controls) {
    this.controls = controls;
    const setting = ({ name, value }) => h('label', {}, `${name} `, value.choice
      ? h('select', { onchange: (event) => this.ask({ choose: { name, value: event.target.value } }) },
        value.choice.all.map((word) => h('option', { value: word, selected: word === value.choice.chosen }, word)))
      : h('input', { type: 'number', step: 'any', min: value.number.min, max: value.number.max, value: value.number.value, onchange: (event) => this.ask({ set: { name, value: Number(event.target.value) } }) }));
    this.buttons.replaceChildren(...[
      controls.freeze != null && h('button', { 'aria-pressed': String(controls.freeze), onclick: () => this.ask({ freeze: !controls.freeze }) }, controls.freeze ? 'Continue' : 'Freeze'),
      controls.freeze && h('button', { onclick: () => this.ask('step') }, 'Step'),
      controls.save_recording && h('button', { id: 'save-recording', onclick: () => this.ask('save_recording') }, 'Save the recording'),
      ...controls.settings.map(setting),
    ].filter(Boolean));
    this.canvas.style.cursor = controls.pixel ? 'crosshair' : 'default';
  },

  showFrames(frames, times) {
    this.frames = [...this.frames, ...frames].slice(-SHOWN_FRAMES);
    const last = this.frames.at(-1);
    const recent = this.frames.slice(-60);
    const median = medianOf(recent.map((tick) => tick.interval_ms));
    this.numbers.textContent = `frame ${last.number}, plan ${last.plan}: ${median.toFixed(1)} ms (median of ${recent.length}), ${bytes(last.bytes)}`;
    if (performance.now() > this.refusedUntil) this.state.textContent = 'connected';
    this.drawStrip();
    this.compare(last);
    if (last.plan === frame.live.plan && times.length === order.length) {
      order.forEach((pass, at) => { passes[pass].time = { ...passes[pass].time, cpu_ms: times[at][0], gpu_ms: times[at][1] }; });
      if (shownView() === passesView) passesView.draw();
    }
  },

  // Says where the program draws another plan: moving casters make plans alternate, so the page stays at its own.
  compare(last) {
    this.other.hidden = last.plan === frame.live.plan;
    this.otherText.textContent = `The program draws plan ${last.plan}; the other views show plan ${frame.live.plan}. `;
  },

  // Loads the page of another plan, with the same view and texture.
  leave(search) {
    if (this.wanted) sessionStorage.setItem('watch', JSON.stringify(this.wanted));
    if (location.search === search) location.reload();
    else location.search = search;
  },

  // Watches what the page before this one did.
  restore() {
    const before = JSON.parse(sessionStorage.getItem('watch') ?? 'null');
    sessionStorage.removeItem('watch');
    const found = before && [...this.texture.options].find((option) => option.textContent === before.texture);
    if (!found) return;
    this.texture.value = found.value;
    this.texture.dispatchEvent(new Event('change'));
    [this.version.value, this.mip.value, this.layer.value] = [before.version ?? '', before.mip, before.layer];
    this.watch();
  },

  drawStrip() {
    const { width, height } = this.strip;
    const context = this.strip.getContext('2d');
    const most = (of) => Math.max(...this.frames.map(of), 1e-9);
    // Single frames that take much longer are cut off.
    const longest = Math.min(most((tick) => tick.interval_ms), 4 * medianOf(this.frames.map((tick) => tick.interval_ms)));
    const memory = most((tick) => tick.bytes);
    context.clearRect(0, 0, width, height);
    const left = width - this.frames.length;
    this.frames.forEach((tick, at) => {
      context.fillStyle = `hsl(${hueOf(`plan ${tick.plan}`)} 50% 55%)`;
      const tall = Math.max(1, Math.min(1, tick.interval_ms / longest) * (height - 14));
      context.fillRect(left + at, height - tall, 1, tall);
    });
    context.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue('--mark');
    context.beginPath();
    this.frames.forEach((tick, at) => context.lineTo(left + at, height - 2 - (tick.bytes / memory) * (height - 16)));
    context.stroke();
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--faint');
    context.fillText(`${longest.toFixed(1)} ms, ${bytes(memory)}`, 4, 10);
  },

  openPlan(event) {
    const box = this.strip.getBoundingClientRect();
    const column = Math.floor(((event.clientX - box.left) / box.width) * this.strip.width) - (this.strip.width - this.frames.length);
    const tick = this.frames[column];
    if (tick && tick.plan !== frame.live.plan) this.leave(`?plan=${tick.plan}`);
  },

  async showTexture(snapshot) {
    if (snapshot.missing) {
      this.value.textContent = `No texels: ${snapshot.missing}.`;
      return;
    }
    const texels = await texelsOf(snapshot);
    if (this.value.textContent.startsWith('waiting')) this.value.textContent = '';
    [this.snapshot, this.texels] = [snapshot, texels];
    paintTexels(this.canvas, snapshot, texels, true);
    this.textures += 1;
    this.canvas.dataset.textures = this.textures;
    this.canvas.title = `${snapshot.full[0]} x ${snapshot.full[1]} texels, ${versionsOf(snapshot)}`;
  },

  askPixel(event) {
    if (!this.controls.pixel || !this.snapshot) return;
    const found = /^texel (\d+), (\d+)/.exec(valueAt(this.snapshot, this.texels, this.canvas, event));
    if (found) this.ask({ pixel: [Number(found[1]), Number(found[2])] });
  },

  // The passes that contributed to a pixel, from the image back.
  showPixel({ text, shadows }) {
    const byPath = new Map(passes.map((_, pass) => [passPath(pass), pass]));
    const path = text.split('\n').flatMap((line) => byPath.get(line) ?? []);
    const blocks = text.trim().split('\n\n').map((block) => {
      const [head, ...lines] = block.split('\n');
      const pass = byPath.get(head);
      return h('section', {}, pass == null ? h('h3', {}, head) : passLink(pass), h('pre', {}, lines.join('\n')));
    });
    const toGraph = () => {
      choose({ path, title: text.split('\n')[0] });
      graphView.whole = false;
      show('Graph');
    };
    this.history.replaceChildren(
      h('h2', {}, 'History of the pixel'), h('button', { id: 'path', onclick: toGraph }, 'Show the path in the graph'), ...blocks,
      ...(shadows ? [h('h2', {}, 'Shadows'), h('pre', {}, shadows)] : []));
  },

  chosen() {},
};
