// Passes across, resources down: when each resource is in use, and by which pass.

const CELL = { width: 20, height: 20, heads: 150 };
// Widths of resource names, in pixels.
const NAMES = { letter: 7.4, most: 310 };

const timelineView = {
  name: 'Timeline',

  build(panel) {
    const used = resources.map((_, index) => index).filter((index) => users[index].some((use) => passes[use.pass].place));
    const first = (resource) => Math.min(...users[resource].filter((use) => passes[use.pass].place).map((use) => passes[use.pass].place.order));
    used.sort((a, b) => first(a) - first(b) || a - b);
    const longest = Math.max(0, ...used.map((resource) => resourceName(resource).length));
    this.names = Math.min(NAMES.most, 24 + NAMES.letter * longest);
    const width = this.names + order.length * CELL.width + 140;
    const height = CELL.heads + used.length * CELL.height + 10;
    // Names stay visible while the rest is scrolled.
    const paper = (wide, high) => s('rect', { width: wide, height: high, fill: 'var(--card)' });
    const heads = s('g', {}, paper(width, CELL.heads), order.map((pass, place) => this.head(pass, place)));
    const names = s('g', {}, paper(this.names - 4, height), used.map((resource, row) => this.label(resource, row)));
    const corner = s('g', {}, paper(this.names - 4, CELL.heads));
    this.svg = s('svg', { width, height, role: 'group', 'aria-label': 'When each resource is in use' },
      order.map((pass, place) => this.column(pass, place, height)),
      used.map((resource, row) => this.row(resource, row, width)), names, heads, corner);
    const stay = (event) => {
      const { scrollLeft: left, scrollTop: top } = event.target;
      names.setAttribute('transform', `translate(${left} 0)`);
      heads.setAttribute('transform', `translate(0 ${top})`);
      corner.setAttribute('transform', `translate(${left} ${top})`);
    };
    panel.append(
      h('div', { class: 'bar' },
        h('span', {}, swatch('var(--write)', '■ writes'), ' ', swatch('var(--read)', '● reads'), ' ', swatch('var(--both)', '◆ preserves and writes')),
        h('span', { class: 'hint' }, 'A bar runs from first to last use. The background alternates between steps: passes of one step share a render pass.')),
      h('div', { class: 'scroll flush', onscroll: stay }, this.svg));
  },

  column(pass, place, height) {
    const x = this.names + place * CELL.width;
    const { place: at } = passes[pass];
    const shade = at.step % 2 ? 'var(--wash)' : 'transparent';
    return s('g', { class: 'col' }, s('rect', { x, y: CELL.heads, width: CELL.width, height: height - CELL.heads, fill: shade }));
  },

  head(pass, place) {
    const { place: at } = passes[pass];
    return s('text', {
      class: 'unit', tabindex: '0', role: 'button', transform: `translate(${this.names + place * CELL.width + 14} ${CELL.heads - 6}) rotate(-55)`,
      ...press(() => choose({ pass })), ...hint(`${passPath(pass)}\nstep ${at.step}: ${at.why}`),
    }, clip(passes[pass].name, 26));
  },

  label(resource, row) {
    return s('text', {
      class: 'unit', tabindex: '0', role: 'button', x: this.names - 12, y: CELL.heads + row * CELL.height + 14, 'text-anchor': 'end',
      ...press(() => choose({ resource })), ...hint(`${resourceName(resource)}: ${resources[resource].shape}, ${bytes(resources[resource].bytes)}\n${resources[resource].origin}`),
    }, clipFront(resourceName(resource), Math.floor((NAMES.most - 24) / NAMES.letter)));
  },

  row(resource, row, width) {
    const y = CELL.heads + row * CELL.height;
    const uses = users[resource].filter((use) => passes[use.pass].place)
      .map((use) => ({ ...use, at: passes[use.pass].place.order })).sort((a, b) => a.at - b.at);
    const [start, end] = [uses[0].at, uses.at(-1).at];
    const centre = (place) => this.names + place * CELL.width + CELL.width / 2;
    const mark = (use) => {
      const { writes, keeps } = use.access;
      const hintText = `${passPath(use.pass)} ${use.access.does} ${resourceName(resource)}${use.access.as}, ${versionOf(use.access)}`
        + `${use.access.part ? `, ${use.access.part}` : ''}${use.access.note ? `\n${use.access.note}` : ''}`
        + [use.access.load, use.access.clear, use.access.store].filter(Boolean).map(([action, why]) => `\n${action}: ${why}`).join('');
      const [x, middle] = [centre(use.at), y + CELL.height / 2];
      const shape = writes && keeps ? s('path', { d: `M${x - 6} ${middle}L${x} ${middle - 6}L${x + 6} ${middle}L${x} ${middle + 6}z`, fill: 'var(--both)' })
        : writes ? s('rect', { x: x - 5, y: middle - 5, width: 10, height: 10, fill: 'var(--write)' })
          : s('circle', { cx: x, cy: middle, r: 4.5, fill: 'var(--read)' });
      return s('g', { class: 'unit', role: 'img', onclick: () => choose({ pass: use.pass }), ...hint(hintText) }, shape);
    };
    return s('g', { class: 'row' },
      s('rect', { class: 'band', x: 0, y, width, height: CELL.height }),
      s('rect', { x: centre(start) - 3, y: y + 7, width: centre(end) - centre(start) + 6, height: 6, rx: 3, fill: 'var(--line)' }),
      uses.map(mark));
  },

  chosen() {},
};

const swatch = (color, text) => h('span', { style: `color:${color}` }, text);
