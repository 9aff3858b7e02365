// The log of all decisions, a sentence each.

function decisions() {
  const all = [];
  const add = (kind, subject, text) => all.push({ kind, subject, text });
  for (const pass of passes.map((_, index) => index).sort((a, b) => rank[a] - rank[b])) {
    const { place, culled, live, notes = [], accesses } = passes[pass];
    const subject = { pass };
    if (!place) add('culled', subject, `does not run: ${culled}`);
    else {
      add('kept', subject, `runs: ${live}`);
      add('placed', subject, `step ${place.step}: ${place.why}`);
      add('merged', subject, `${place.within ? 'merged with the previous pass' : 'not merged'}: ${place.merged}`);
    }
    for (const note of notes) add('note', subject, note);
    for (const access of accesses) {
      const name = `${access.part ? `${access.part} of ` : ''}“${resourceName(access.resource)}”`;
      if (access.load) add('load', subject, `${name}, ${access.load[0]}: ${access.load[1]}`);
      if (access.clear) add('clear', subject, `${name}, ${access.clear[0]}: ${access.clear[1]}`);
      if (access.store) add('store', subject, `${name}, ${access.store[0]}: ${access.store[1]}`);
    }
  }
  resources.forEach((resource, index) => {
    add('slot', { resource: index }, `${resource.slot == null ? 'no slot' : `slot ${resource.slot}`}: ${resource.why}`);
    for (const note of resource.notes ?? []) add('note', { resource: index }, note);
    for (const usage of resource.usages) add('usage', { resource: index }, usage);
  });
  return all;
}

const logView = {
  name: 'Log',
  query: '',
  kind: '',

  build(panel) {
    this.all = decisions();
    this.list = h('ol', { class: 'log', id: 'decisions' });
    this.count = h('span', { class: 'hint', 'aria-live': 'polite' });
    const kinds = [...new Set(this.all.map((decision) => decision.kind))];
    panel.append(
      h('div', { class: 'bar' },
        h('select', { 'aria-label': 'Kind of decision', onchange: (event) => this.filter({ kind: event.target.value }) },
          h('option', { value: '' }, 'every decision'), kinds.map((kind) => h('option', { value: kind }, kind))),
        h('input', { type: 'search', placeholder: 'Filter', 'aria-label': 'Filter decisions', oninput: (event) => this.filter({ query: event.target.value.toLowerCase() }) }),
        this.count),
      h('div', { class: 'scroll' }, this.list));
    this.draw();
  },

  filter(by) {
    Object.assign(this, by);
    this.draw();
  },

  draw() {
    const name = ({ pass, resource }) => (pass != null ? passPath(pass) : resourceName(resource));
    const shown = this.all.filter((decision) => (!this.kind || decision.kind === this.kind)
      && `${name(decision.subject)} ${decision.text}`.toLowerCase().includes(this.query));
    this.list.replaceChildren(...shown.map((decision) => h('li', {}, h('span', { class: 'tag' }, decision.kind),
      decision.subject.pass != null ? passLink(decision.subject.pass) : resourceLink(decision.subject.resource), ` ${decision.text}`)));
    this.count.textContent = `${shown.length} of ${this.all.length} decisions`;
  },

  chosen() {},
};
