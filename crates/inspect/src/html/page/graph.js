// The graph: nodes are closed until opened; a selected pass is shown with its neighbours.

// Groups are nodes, and runs of passes without a node if there are many.
const groups = nodes.map((node) => ({ name: node.name, parent: node.parent, node: true }));
const FEW = 40;
const MERGED = 4;
// Pixels around the view in which boxes are drawn too.
const BEYOND = 300;
const loose = passes.map((_, pass) => pass).filter((pass) => passes[pass].node == null);
const looseGroup = new Map();
if (loose.length > FEW) {
  const size = Math.ceil(Math.sqrt(loose.length));
  for (let first = 0; first < loose.length; first += size) {
    const run = loose.slice(first, first + size);
    run.forEach((pass) => looseGroup.set(pass, groups.length));
    groups.push({ name: `${passes[run[0]].name} … ${passes[run.at(-1)].name}`, parent: null, node: false });
  }
}
const groupsAround = (pass) => (looseGroup.has(pass) ? [looseGroup.get(pass)] : around(passes[pass].node));
const members = groups.map(() => []);
passes.forEach((_, pass) => groupsAround(pass).forEach((group) => members[group].push(pass)));

// Leaves out arrows between boxes that are also connected through other boxes.
function withoutImplied(arrows, count) {
  const next = Array.from({ length: count }, () => []);
  for (const arrow of arrows) next[arrow.from].push(arrow.to);
  const reach = [];
  for (let from = count - 1; from >= 0; from -= 1) {
    reach[from] = new Set(next[from].flatMap((to) => [to, ...reach[to]]));
  }
  return arrows.filter(({ from, to }) => !next[from].some((other) => other !== to && reach[other].has(to)));
}

const graphView = {
  name: 'Graph',
  open: new Set(),
  openSteps: new Set(),
  whole: true,
  reach: 1,
  view: { x: 20, y: 20, scale: 1 },

  build(panel) {
    this.note = h('span', { class: 'hint', 'aria-live': 'polite' });
    this.beyond = h('span', { class: 'hint', hidden: true }, 'Drag to see the rest, or Fit.');
    this.reachBox = h('select', { 'aria-label': 'Distance from the selection', onchange: (event) => {
      this.reach = Number(event.target.value);
      this.draw();
    } }, [1, 2, 3, 99].map((reach) => h('option', { value: reach }, reach > 9 ? 'all connected' : `distance ${reach}`)));
    this.back = h('button', { id: 'whole', onclick: () => this.showWhole() }, 'Whole frame (Esc)');
    this.svg = s('svg', { class: 'canvas', role: 'group', 'aria-label': 'Passes and their dependencies', tabindex: '0' });
    this.outline = h('nav', { class: 'outline', 'aria-label': 'Nodes and passes' });
    panel.append(
      h('div', { class: 'bar' },
        this.back, this.reachBox,
        h('button', { id: 'open-all', onclick: () => this.openAll(true) }, 'Open all'),
        h('button', { id: 'close-all', onclick: () => this.openAll(false) }, 'Close all'),
        h('button', { onclick: () => this.zoom(1.25), 'aria-label': 'Zoom in' }, '+'),
        h('button', { onclick: () => this.zoom(0.8), 'aria-label': 'Zoom out' }, '−'),
        h('button', { id: 'fit', onclick: () => this.fit(true) }, 'Fit'),
        this.note, this.beyond),
      h('div', { class: 'split' }, this.outline, this.svg));
    this.buildOutline();
    this.listen();
    this.draw();
  },

  buildOutline() {
    const item = (pass) => h('li', { class: passes[pass].place ? null : 'culled' },
      h('button', { class: 'link', onclick: () => choose({ pass }) }, passes[pass].name));
    const inside = (parent) => {
      const own = groups.map((_, group) => group).filter((group) => groups[group].parent === parent);
      const direct = parent == null ? loose.filter((pass) => !looseGroup.has(pass))
        : members[parent].filter((pass) => groupsAround(pass).at(-1) === parent);
      const sorted = [...own.map((group) => [Math.min(...members[group]), branch(group)]), ...direct.map((pass) => [pass, item(pass)])];
      return h('ul', {}, sorted.sort((a, b) => a[0] - b[0]).map(([, element]) => element));
    };
    const branch = (group) => {
      const details = h('details', { 'data-group': group }, h('summary', {}, `${groups[group].name} (${members[group].length})`), inside(group));
      details.addEventListener('toggle', () => {
        if (details.open === this.open.has(group)) return;
        if (details.open) this.open.add(group); else this.open.delete(group);
        if (this.whole) this.draw();
      });
      return h('li', {}, details);
    };
    this.outline.replaceChildren(inside(null));
  },

  openAll(open) {
    this.open = new Set(open ? groups.keys() : []);
    this.showWhole();
  },

  showWhole() {
    this.whole = true;
    this.draw();
  },

  focus() {
    this.whole = false;
    this.draw();
  },

  // The passes to show, and the links between them.
  shown() {
    if (this.whole || !chosen) return { of: new Set(passes.keys()), links };
    if (chosen.path) {
      const of = new Set(chosen.path);
      return { of, links: links.filter((link) => of.has(link.before) && of.has(link.after)) };
    }
    if (chosen.resource != null) {
      const own = users[chosen.resource].map((use) => use.pass);
      return { of: new Set(own), links: links.filter((link) => link.resource === chosen.resource) };
    }
    const of = new Set([chosen.pass]);
    for (const [next, end] of [[before, 'before'], [after, 'after']]) {
      let edge = [chosen.pass];
      const seen = new Set(edge);
      for (let far = 0; far < this.reach && edge.length; far += 1) {
        edge = [...new Set(edge.flatMap((pass) => next[pass].map((link) => link[end])))].filter((pass) => !seen.has(pass));
        edge.forEach((pass) => seen.add(pass));
      }
      seen.forEach((pass) => of.add(pass));
    }
    return { of, links: links.filter((link) => of.has(link.before) && of.has(link.after)) };
  },

  // The step that replaces a neighbour if many of its merged passes would be shown.
  mergedStep(pass, shown) {
    const { place } = passes[pass];
    if (!place || pass === chosen.pass || this.openSteps.has(place.step)) return undefined;
    return steps[place.step].filter((other) => shown.has(other)).length > MERGED ? place.step : undefined;
  },

  draw() {
    // Measured before the content changes, so that it is laid out once, at its scale.
    const box = this.svg.getBoundingClientRect();
    const whole = this.whole || !chosen;
    const { of, links: drawn } = this.shown();
    const units = new Map();
    const unitOf = new Map();
    // In order of declaration: nothing needs a later pass, and the passes of a node are adjacent.
    for (const pass of [...of].sort((a, b) => a - b)) {
      const closed = whole ? groupsAround(pass).find((group) => !this.open.has(group)) : undefined;
      const step = whole ? undefined : this.mergedStep(pass, of);
      const key = closed != null ? `g${closed}` : step != null ? `s${step}` : `p${pass}`;
      if (!units.has(key)) units.set(key, { key, pass: closed == null && step == null ? pass : null, group: closed, step, passes: [], place: units.size });
      units.get(key).passes.push(pass);
      unitOf.set(pass, units.get(key));
    }
    const arrows = new Map();
    for (const link of drawn) {
      const [a, b] = [unitOf.get(link.before), unitOf.get(link.after)];
      if (!a || !b || a === b) continue;
      const forward = a.place < b.place;
      const [from, to] = forward ? [a.place, b.place] : [b.place, a.place];
      const key = `${from} ${to}`;
      if (!arrows.has(key)) arrows.set(key, { from, to, links: [], forward: false, backward: false });
      const arrow = arrows.get(key);
      arrow.links.push(link);
      arrow[forward ? 'forward' : 'backward'] = true;
    }
    const list = [...units.values()];
    const far = list.length > 60 ? 6 : Infinity;
    const every = [...arrows.values()];
    const kept = whole && every.length > FEW ? withoutImplied(every, list.length) : every;
    layOut(list, kept, far);
    this.paint(list, kept, whole);
    this.back.hidden = whole;
    this.reachBox.hidden = whole || chosen?.pass == null;
    const missing = every.length - kept.filter((arrow) => arrow.points).length;
    this.note.textContent = whole
      ? `${counted(units.size, 'box', 'boxes')} for ${counted(passes.length, 'pass', 'passes')}. Click a box to open it or to see its neighbours.${missing ? ` ${missing} arrows are left out because others imply them or because they are long: select a pass to see all of its arrows.` : ''}`
      : `${of.size} of ${counted(passes.length, 'pass', 'passes')}, ${chosen.path ? 'of' : 'around'} ${chosen.path ? chosen.title : chosen.pass != null ? `“${passPath(chosen.pass)}”` : `“${resourceName(chosen.resource)}”`}.`;
    this.outline.querySelectorAll('details').forEach((details) => { details.open = this.open.has(Number(details.dataset.group)); });
    this.fit(false, box);
  },

  paint(units, arrows, whole) {
    const labels = arrows.length <= 40 || !whole;
    // Around a pass, arrows between its neighbours are faint.
    const own = whole || chosen.pass == null ? null : units.find((unit) => unit.pass === chosen.pass).place;
    const near = (arrow) => own == null || arrow.from === own || arrow.to === own;
    const arrowhead = (id, orient) => s('marker', { id, viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient },
      s('path', { d: 'M0 0L8 4L0 8z', fill: 'var(--faint)' }));
    const layers = Array.from({ length: 3 }, () => s('g', {}));
    this.content = s('g', {}, layers);
    const lines = arrows.filter((arrow) => arrow.points).sort((a, b) => near(a) - near(b)).map((arrow) => {
      const [across, down] = [arrow.points.map((point) => point.x), arrow.points.map((point) => point.y)];
      return {
        from: [Math.min(...across), Math.min(...down)], to: [Math.max(...across), Math.max(...down)],
        add: () => {
          const { line, label } = this.arrow(arrow, labels && near(arrow), near(arrow));
          layers[0].append(line);
          layers[1].append(label);
        },
      };
    });
    const boxes = units.map((unit) => ({
      from: [unit.x, unit.y - 16], to: [unit.x + BOX.width, unit.y + BOX.height], add: () => layers[2].append(this.unit(unit)),
    }));
    this.waiting = [...lines, ...boxes];
    this.target = units.find((unit) => unit.pass != null && unit.pass === chosen?.pass);
    this.svg.replaceChildren(s('defs', {}, arrowhead('ahead', 'auto'), arrowhead('behind', 'auto-start-reverse')), this.content);
    this.size = {
      width: Math.max(1, ...units.map((unit) => unit.x + BOX.width)),
      height: Math.max(1, ...units.map((unit) => unit.y + BOX.height)),
    };
  },

  arrow(arrow, labels, near) {
    const names = [...new Set(arrow.links.map(linkLabel))];
    const hintText = arrow.links.slice(0, 12).map(describeLink).join('\n') + (arrow.links.length > 12 ? `\nand ${arrow.links.length - 12} more` : '');
    const kinds = arrow.links.map((link) => link.kind);
    const style = !near || kinds.every((kind) => kind === 'faint') ? ' faint' : kinds.includes('ReadAfterWrite') ? '' : ' order';
    const line = s('path', {
      class: `edge${style}`, d: pathOf(arrow.points), 'marker-end': arrow.forward ? 'url(#ahead)' : null,
      'marker-start': arrow.backward ? 'url(#behind)' : null,
    });
    const wide = s('path', { d: pathOf(arrow.points), fill: 'none', stroke: 'transparent', 'stroke-width': 12, ...hint(hintText) });
    const middle = arrow.points.length > 2 ? arrow.points[Math.floor(arrow.points.length / 2)]
      : { x: (arrow.points[0].x + arrow.points[1].x) / 2, y: (arrow.points[0].y + arrow.points[1].y) / 2 };
    // It fits between two boxes, or in the place of a box where the arrow passes a layer.
    const length = arrow.points.length > 2 ? 28 : 14;
    const text = names.length > 1 ? `${clip(names[0], length - 3)} +${names.length - 1}` : clip(names[0], length);
    const label = labels ? s('text', { class: 'label', x: middle.x, y: middle.y - 3, 'text-anchor': 'middle' }, text) : null;
    return { line: s('g', { class: 'line' }, line, wide), label: label ?? '' };
  },

  unit(unit) {
    const isPass = unit.pass != null;
    const pass = isPass ? passes[unit.pass] : null;
    const culled = unit.passes.filter((index) => !passes[index].place).length;
    const run = unit.step != null;
    const node = isPass ? pass.node : run ? passes[unit.passes[0]].node : groups[unit.group].node ? unit.group : null;
    const name = isPass ? pass.name : run ? `${clip(passes[unit.passes[0]].name, 12)} … ${clip(passes[unit.passes.at(-1)].name, 12)}` : groups[unit.group].name;
    const second = isPass
      ? (pass.place ? `${pass.kind}, step ${pass.place.step}${pass.place.of > 1 ? `, ${pass.place.within + 1} of ${pass.place.of} merged` : ''}` : 'culled')
      : `▸ ${counted(unit.passes.length, 'pass', 'passes')}${run ? ` merged in step ${unit.step}` : ''}${culled ? `, ${culled} culled` : ''}`;
    const hintText = isPass ? `${passPath(unit.pass)}: ${pass.place ? `${second}\n${pass.live}` : `does not run: ${pass.culled}`}` : `${name}: ${second.slice(2)}. Click to open.`;
    const act = isPass ? () => choose({ pass: unit.pass }) : () => {
      if (run) this.openSteps.add(unit.step); else this.open.add(unit.group);
      this.draw();
    };
    const chosenHere = isPass && chosen?.pass === unit.pass;
    const outer = isPass && pass.node != null && this.whole ? clip(nodePath(pass.node), 28) : '';
    return s('g', {
      class: `unit${culled === unit.passes.length ? ' culled' : ''}${chosenHere ? ' chosen' : ''}`, tabindex: '0', role: 'button', 'data-name': name,
      transform: `translate(${unit.x} ${unit.y})`, ...press(act), ...hint(hintText),
    },
    s('rect', { width: BOX.width, height: BOX.height, rx: 6, style: `fill:${node == null ? 'var(--wash)' : hue(node)};stroke:${hueLine(node)}` }),
    s('text', { x: 10, y: 17, style: isPass ? '' : 'font-weight:600' }, clip(name, 28)),
    s('text', { class: 'small', x: 10, y: 32 }, clip(second, 32)),
    outer ? s('text', { class: 'small label', x: 2, y: -3 }, outer) : '');
  },

  // Moves the graph to where it is looked at. Boxes and arrows are added when they come near: large graphs have thousands of texts.
  place() {
    const { x, y, scale } = this.view;
    this.content.setAttribute('transform', `translate(${x} ${y}) scale(${scale})`);
    const [left, top] = [(-x - BEYOND) / scale, (-y - BEYOND) / scale];
    const [right, bottom] = [left + (this.width + 2 * BEYOND) / scale, top + (this.height + 2 * BEYOND) / scale];
    this.waiting = this.waiting.filter(({ from, to, add }) => {
      const isNear = to[0] > left && from[0] < right && to[1] > top && from[1] < bottom;
      if (isNear) add();
      return !isNear;
    });
  },

  fit(all = false, { width, height } = this.svg.getBoundingClientRect()) {
    [this.all, this.width, this.height] = [all, width, height];
    if (!width) return;
    const whole = Math.min(1.15, (width - 40) / this.size.width, (height - 50) / this.size.height);
    // Not so small that names cannot be read, unless the whole graph is requested.
    const scale = whole < 0.6 && !all ? 0.8 : whole;
    this.beyond.hidden = scale <= whole;
    this.view = { x: Math.max(20, (width - this.size.width * scale) / 2), y: Math.max(24, (height - this.size.height * scale) / 2), scale };
    if (this.size.height * scale > height) this.view.y = 24;
    this.centre(width, height);
    this.place();
  },

  // Scrolls to the selection if the graph does not fit.
  centre(width, height) {
    if (!this.target || (this.size.width * this.view.scale < width && this.size.height * this.view.scale < height)) return;
    this.view.x = width / 2 - (this.target.x + BOX.width / 2) * this.view.scale;
    this.view.y = height / 2 - (this.target.y + BOX.height / 2) * this.view.scale;
  },

  zoom(by, at) {
    const box = this.svg.getBoundingClientRect();
    const { x, y } = at ?? { x: box.width / 2, y: box.height / 2 };
    const scale = Math.min(3, Math.max(0.08, this.view.scale * by));
    const ratio = scale / this.view.scale;
    this.view = { x: x - (x - this.view.x) * ratio, y: y - (y - this.view.y) * ratio, scale };
    this.place();
  },

  listen() {
    this.svg.addEventListener('wheel', (event) => {
      event.preventDefault();
      const box = this.svg.getBoundingClientRect();
      this.zoom(Math.exp(-event.deltaY * 0.0012), { x: event.clientX - box.left, y: event.clientY - box.top });
    }, { passive: false });
    this.svg.addEventListener('pointerdown', (event) => { this.grip = { x: event.clientX, y: event.clientY, of: this.view }; });
    window.addEventListener('pointermove', (event) => {
      if (!this.grip || !event.buttons) return;
      this.view = { ...this.grip.of, x: this.grip.of.x + event.clientX - this.grip.x, y: this.grip.of.y + event.clientY - this.grip.y };
      this.place();
    });
    window.addEventListener('pointerup', () => { this.grip = null; });
    this.svg.addEventListener('keydown', (event) => {
      const move = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
      if (move && event.target === this.svg) {
        event.preventDefault();
        this.view = { ...this.view, x: this.view.x + move[0], y: this.view.y + move[1] };
        this.place();
      } else if (event.key === '+' || event.key === '-') {
        this.zoom(event.key === '+' ? 1.25 : 0.8);
      }
    });
  },

  chosen() {
    if (chosen) this.focus(); else this.showWhole();
  },
};
