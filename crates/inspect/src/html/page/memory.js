// Physical textures and buffers as lanes, and the bytes in use at each step.

const LANE = { width: 24, height: 26, names: 300, chart: 120 };

const memoryView = {
  name: 'Memory',

  build(panel) {
    const wide = Math.max(2, Math.min(LANE.width * 2, Math.floor(1400 / Math.max(1, stepCount))));
    const width = LANE.names + stepCount * wide + 160;
    const live = steps.map((_, step) => slots.reduce((sum, slot) => sum + (slot.resources.some((resource) => within(resource, step)) ? slot.bytes : 0), 0));
    const transient = slots.filter((slot) => slot.transient);
    const total = slots.reduce((sum, slot) => sum + slot.bytes, 0);
    const saved = slots.reduce((sum, slot) => sum + slot.bytes * Math.max(0, slot.resources.length - 1), 0);
    const peak = Math.max(0, ...live);
    const facts = [
      `${slots.length} slots of ${bytes(total)}`, `${bytes(saved)} saved by sharing`,
      `peak ${bytes(peak)} in step ${Math.max(0, live.indexOf(peak))}`,
      `${transient.length} transient attachments${transient.length ? ` of ${bytes(transient.reduce((sum, slot) => sum + slot.bytes, 0))}, which take no memory on GPUs that draw in tiles` : ''}`,
    ];
    const height = LANE.chart + 30 + slots.length * LANE.height + 10;
    const x = (step) => LANE.names + step * wide;
    panel.append(
      h('div', { class: 'bar' }, h('span', { id: 'memory-facts' }, facts.join('; '))),
      h('div', { class: 'scroll' },
        s('svg', { width, height, role: 'group', 'aria-label': 'Slots and the resources in them' }, this.chart(live, peak, x), slots.map((slot, index) => this.lane(slot, index, x, width)),
          s('text', { class: 'small', x: LANE.names, y: LANE.chart + 18 }, stepCount ? `steps 0 to ${stepCount - 1}` : 'no steps')),
        this.unslotted()));
  },

  chart(live, peak, x) {
    const y = (count) => LANE.chart - (peak ? (count / peak) * (LANE.chart - 24) : 0);
    const path = live.map((count, step) => `L${x(step)} ${y(count)}L${x(step + 1)} ${y(count)}`).join('');
    return [
      s('path', { d: `M${x(0)} ${LANE.chart}${path}L${x(live.length)} ${LANE.chart}z`, fill: 'var(--line)', stroke: 'var(--faint)' }),
      s('text', { x: LANE.names - 8, y: 22, 'text-anchor': 'end' }, bytes(peak)),
      s('text', { class: 'small', x: LANE.names - 8, y: LANE.chart, 'text-anchor': 'end' }, 'bytes in use'),
      live.map((count, step) => s('rect', {
        x: x(step), y: 0, width: x(step + 1) - x(step), height: LANE.chart, fill: 'transparent',
        ...hint(`step ${step}: ${bytes(count)}\n${steps[step].map(passPath).join('\n')}`),
      })),
    ];
  },

  lane(slot, number, x, width) {
    const y = LANE.chart + 30 + number * LANE.height;
    const bars = slot.resources.map((index) => {
      const resource = resources[index];
      const [start, end] = resource.steps;
      const wide = x(end + 1) - x(start);
      const name = clip(resource.name, Math.max(1, Math.floor((wide - 6) / 6.5)));
      return s('g', { class: 'unit', tabindex: '0', role: 'button', ...press(() => choose({ resource: index })), ...hint(`${resourceName(index)}: steps ${start} to ${end}\n${resource.why}`) },
        s('rect', { x: x(start) + 0.5, y: y + 3, width: wide - 1, height: LANE.height - 6, rx: 3, style: `fill:${laneColor(index)};stroke:${laneLine(index)}` }),
        name.length > 2 ? s('text', { class: 'small', x: x(start) + 5, y: y + 17 }, name) : '');
    });
    return s('g', { class: 'row' }, s('rect', { class: 'band', x: 0, y, width, height: LANE.height }),
      s('text', { x: LANE.names - 8, y: y + 17, 'text-anchor': 'end' }, clip(`${number}: ${slot.shape}, ${bytes(slot.bytes)}`, 46)), bars);
  },

  // Resources that are not in slots.
  unslotted() {
    const others = resources.map((_, index) => index).filter((index) => resources[index].slot == null);
    if (!others.length) return '';
    return h('div', {}, h('h3', {}, 'Not in slots'), h('table', {}, h('tbody', {}, others.map((index) => h('tr', {},
      h('td', {}, resourceLink(index)), h('td', {}, resources[index].shape), h('td', { class: 'number' }, bytes(resources[index].bytes)), h('td', {}, resources[index].why))))));
  },

  chosen() {},
};

const within = (resource, step) => resources[resource].steps && resources[resource].steps[0] <= step && step <= resources[resource].steps[1];
const laneColor = (index) => `hsl(${(index * 137.5 + 40) % 360} 45% var(--fill))`;
const laneLine = (index) => `hsl(${(index * 137.5 + 40) % 360} 45% var(--edge))`;
