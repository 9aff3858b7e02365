// A table of all passes that can be sorted and filtered.

const COLUMNS = [
  { name: 'Step', value: (pass) => passes[pass].place?.order ?? Infinity, cell: (pass) => passes[pass].place?.step ?? '–', number: true },
  { name: 'Node', value: (pass) => nodePath(passes[pass].node), cell: (pass) => nodePath(passes[pass].node).slice(0, -1) },
  { name: 'Pass', value: (pass) => passes[pass].name, cell: (pass) => h('button', { class: 'link', onclick: () => choose({ pass }) }, passes[pass].name) },
  { name: 'Kind', value: (pass) => passes[pass].kind, cell: (pass) => passes[pass].kind },
  { name: 'CPU ms', value: (pass) => passes[pass].time?.cpu_ms ?? -1, cell: (pass) => milliseconds(passes[pass].time?.cpu_ms), number: true },
  {
    name: 'GPU ms', value: (pass) => passes[pass].time?.gpu_ms ?? -1, number: true,
    cell: (pass) => gpuCell(pass),
  },
  { name: 'Draws', value: (pass) => passes[pass].time?.draws ?? -1, cell: (pass) => passes[pass].time?.draws ?? '–', number: true },
  { name: 'Triangles', value: (pass) => passes[pass].time?.triangles ?? -1, cell: (pass) => passes[pass].time?.triangles?.toLocaleString('en') ?? '–', number: true },
  { name: 'Attachments, loads and stores', value: (pass) => attachments(pass).length, cell: (pass) => attachments(pass).map((line) => h('div', {}, line)) },
];

// The GPU time of merged passes is shown once, at the first of them.
function gpuCell(pass) {
  const { time, place } = passes[pass];
  if (!(time?.shared_by > 1)) return milliseconds(time?.gpu_ms);
  return place.within ? 'with the first' : `${milliseconds(time.gpu_ms)} for all ${time.shared_by}`;
}

const milliseconds = (value) => (value == null ? '–' : value.toFixed(3));

function attachments(pass) {
  return passes[pass].accesses.filter((access) => access.load).map((access) => {
    const part = access.part ? ` (${access.part})` : '';
    const [[load, why], [store, reason]] = [access.load, access.store];
    const begin = [`begins: ${load}, ${why}`, ...(access.clear ? [access.clear.join(', ')] : [])];
    return `${resourceName(access.resource)}${part} – ${begin.join('; ')}; ends: ${store}, ${reason}`;
  });
}

// The total time of some passes.
function timeSum(of) {
  const sum = (time) => of.reduce((all, pass) => (time(passes[pass]) == null ? all : (all ?? 0) + time(passes[pass])), null);
  const [cpu, gpu] = [sum(({ time }) => time?.cpu_ms), sum(({ time }) => (time?.gpu_ms == null ? null : time.gpu_ms / Math.max(1, time.shared_by)))];
  return `${cpu == null ? '' : `; CPU ${milliseconds(cpu)} ms`}${gpu == null ? '' : `, GPU ${milliseconds(gpu)} ms`}`;
}

const passesView = {
  name: 'Passes',
  by: COLUMNS[0],
  down: false,
  query: '',

  build(panel) {
    this.body = h('tbody');
    this.count = h('span', { class: 'hint', 'aria-live': 'polite' });
    // Empty columns are left out.
    this.columns = COLUMNS.filter((column) => !['CPU ms', 'GPU ms', 'Draws', 'Triangles'].includes(column.name) || passes.some((_, pass) => column.value(pass) >= 0));
    this.heads = this.columns.map((column) => h('th', { scope: 'col' }, h('button', { onclick: () => this.sort(column) }, column.name)));
    panel.append(
      h('div', { class: 'bar' },
        h('input', { type: 'search', placeholder: 'Filter', 'aria-label': 'Filter passes', oninput: (event) => {
          this.query = event.target.value.toLowerCase();
          this.draw();
        } }), this.count),
      h('div', { class: 'scroll' }, h('table', { id: 'pass-table' }, h('thead', {}, h('tr', {}, this.heads)), this.body)));
    this.draw();
  },

  sort(column) {
    this.down = this.by === column ? !this.down : Boolean(column.number && column.name !== 'Step');
    this.by = column;
    this.draw();
  },

  draw() {
    const text = (pass) => `${passPath(pass)} ${passes[pass].kind} ${passes[pass].accesses.map((access) => resourceName(access.resource)).join(' ')}`.toLowerCase();
    const shown = passes.map((_, pass) => pass).filter((pass) => text(pass).includes(this.query));
    const sign = this.down ? -1 : 1;
    const compare = (a, b) => (a < b ? -1 : a > b ? 1 : 0);
    shown.sort((a, b) => sign * compare(this.by.value(a), this.by.value(b)) || rank[a] - rank[b]);
    this.heads.forEach((head, index) => head.setAttribute('aria-sort', this.columns[index] !== this.by ? 'none' : this.down ? 'descending' : 'ascending'));
    this.rows = new Map(shown.map((pass) => [pass, h('tr', { class: passes[pass].place ? null : 'culled' },
      this.columns.map((column) => h('td', { class: column.number ? 'number' : null }, column.cell(pass))))]));
    this.body.replaceChildren(...this.rows.values());
    this.chosen();
    this.count.textContent = `${shown.length} of ${counted(passes.length, 'pass', 'passes')}${timeSum(shown)}`;
  },

  chosen() {
    this.row?.classList.remove('chosen');
    this.row = this.rows.get(chosen?.pass);
    this.row?.classList.add('chosen');
  },
};
