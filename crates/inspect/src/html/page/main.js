// Tabs, search and the selection.

// {pass}, {resource}, {path, title} (the passes of a pixel) or null.
let chosen = null;

const VIEWS = [...(frame.live ? [liveView] : []), graphView, timelineView, memoryView, passesView, texturesView, logView, ...frame.tables.map(tableView)];
const tabs = [];
const panels = [];

function show(name, detail) {
  const index = Math.max(0, VIEWS.findIndex((view) => view.name === name));
  tabs.forEach((tab, at) => {
    tab.setAttribute('aria-selected', at === index);
    tab.tabIndex = at === index ? 0 : -1;
    panels[at].hidden = at !== index;
  });
  const [view, panel] = [VIEWS[index], panels[index]];
  if (!panel.childElementCount) view.build(panel);
  else view.chosen();
  view.reveal?.(detail);
  remember(view.name);
}

const shownView = () => VIEWS[panels.findIndex((panel) => !panel.hidden)];

function choose(what) {
  chosen = what;
  drawDetails();
  shownView().chosen();
  remember(shownView().name);
}

// Stores the view and the selection in the address, so that they can be linked to.
function remember(name) {
  const what = chosen?.pass != null ? `/pass/${chosen.pass}` : chosen?.resource != null ? `/resource/${chosen.resource}` : '';
  history.replaceState(null, '', `#${name.toLowerCase().replaceAll(' ', '-')}${what}`);
}

function fromAddress() {
  const [name, kind, number] = decodeURIComponent(location.hash.slice(1)).split('/');
  const index = Number.parseInt(number, 10);
  if (kind === 'pass' && passes[index]) chosen = { pass: index };
  if (kind === 'resource' && resources[index]) chosen = { resource: index };
  const view = VIEWS.find((known) => known.name.toLowerCase().replaceAll(' ', '-') === name);
  drawDetails();
  show(view?.name ?? VIEWS[0].name);
  if (chosen) shownView().chosen();
}

function tableView(table) {
  return {
    name: table.title,
    build(panel) {
      panel.append(h('div', { class: 'scroll' }, h('table', {},
        h('thead', {}, h('tr', {}, table.columns.map((column) => h('th', { scope: 'col' }, column)))),
        h('tbody', {}, table.rows.map((row) => h('tr', {}, row.map((cell) => h('td', {}, cell))))))));
    },
    chosen() {},
  };
}

function find(text) {
  const wanted = text.trim().toLowerCase();
  const list = document.getElementById('found');
  if (!wanted) return list.replaceChildren();
  const matches = (name) => name.toLowerCase().includes(wanted);
  const found = [
    ...passes.map((_, pass) => ({ what: { pass }, name: passPath(pass), kind: passes[pass].place ? 'pass' : 'culled' })),
    ...resources.map((resource, index) => ({ what: { resource: index }, name: resourceName(index), kind: resource.buffer ? 'buffer' : 'texture' })),
  ].filter((item) => matches(item.name)).sort((a, b) => a.name.length - b.name.length);
  const take = (item) => {
    document.getElementById('query').value = '';
    list.replaceChildren();
    choose(item.what);
    document.getElementById('details').focus();
  };
  return list.replaceChildren(...(found.length ? found.slice(0, 40).map((item) => h('li', {}, h('button', { onclick: () => take(item) },
    h('span', { class: 'tag' }, item.kind), item.name))) : [h('li', {}, h('span', { class: 'tag' }, 'nothing found'))]));
}

function start() {
  document.getElementById('summary').textContent = frame.summary;
  VIEWS.forEach((view, index) => {
    const tab = h('button', { role: 'tab', id: `tab-${index}`, 'aria-controls': `panel-${index}`, onclick: () => show(view.name) }, view.name);
    const panel = h('section', { role: 'tabpanel', id: `panel-${index}`, 'aria-labelledby': `tab-${index}`, hidden: true });
    tabs.push(tab);
    panels.push(panel);
  });
  document.getElementById('tabs').append(...tabs);
  document.getElementById('views').append(...panels);
  document.getElementById('tabs').addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = (tabs.findIndex((tab) => tab.getAttribute('aria-selected') === 'true') + step + tabs.length) % tabs.length;
    show(VIEWS[next].name);
    tabs[next].focus();
  });
  const query = document.getElementById('query');
  query.addEventListener('input', () => find(query.value));
  query.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') document.querySelector('#found button')?.click();
  });
  document.addEventListener('keydown', (event) => {
    const typing = event.target instanceof HTMLInputElement;
    if (event.key === '/' && !typing) {
      event.preventDefault();
      query.focus();
    } else if (event.key === 'Escape' && !document.querySelector('dialog[open]')) {
      query.value = '';
      find('');
      choose(null);
    }
  });
  window.addEventListener('resize', () => { if (shownView() === graphView) graphView.fit(graphView.all); });
  window.addEventListener('hashchange', fromAddress);
  fromAddress();
}

start();
