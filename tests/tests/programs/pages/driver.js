// Appended to the page of a frame: uses the page as a reader would, and writes its findings into the page for the test to read.
// Computes the expected results from the page's data, independently of the page's own script.

window.addEventListener('load', async () => {
  const data = JSON.parse(document.getElementById('frame').textContent);
  const faults = [];
  const facts = {};
  const expect = (holds, words) => { if (!holds) faults.push(words); };
  const all = (selector, inside = document) => [...inside.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const wait = (ms) => new Promise((done) => { setTimeout(done, ms); });
  const key = (target, name) => target.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
  const click = (target) => target.dispatchEvent(new MouseEvent('click', { bubbles: true }));
  const panel = () => all('[role=tabpanel]').find((element) => !element.hidden);
  const open = async (name) => {
    click(all('[role=tab]').find((tab) => tab.textContent === name));
    await wait(30);
    return panel();
  };
  const details = () => one('#details').textContent;
  const path = (pass) => {
    const names = [data.passes[pass].name];
    for (let node = data.passes[pass].node; node != null; node = data.nodes[node].parent) names.unshift(data.nodes[node].name);
    return names.join('/');
  };

  // The graph opens first, with collapsed nodes.
  const graph = await open('Graph');
  const units = () => all('svg.canvas .unit', graph);
  const box = (element) => element.getBoundingClientRect();
  const overlapping = () => {
    const boxes = units().map((unit) => box(unit.querySelector('rect')));
    return boxes.filter((a, i) => boxes.some((b, j) => i < j && a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)).length;
  };
  const letters = () => Math.min(...units().map((unit) => box(unit.querySelector('text')).height));
  const readable = (when) => {
    expect(overlapping() === 0, `${when}: ${overlapping()} boxes lie over others`);
    expect(letters() >= 7, `${when}: letters are ${letters()} px high`);
  };
  const outermost = new Set(data.passes.filter((pass) => pass.node != null).map((pass) => {
    let node = pass.node;
    while (data.nodes[node].parent != null) node = data.nodes[node].parent;
    return node;
  }));
  const loose = data.passes.filter((pass) => pass.node == null).length;
  facts.boxes = units().length;
  expect(facts.boxes <= outermost.size + Math.max(40, Math.ceil(Math.sqrt(loose)) + 1), `${facts.boxes} boxes at first`);
  expect(facts.boxes > 0, 'no box is drawn');
  expect(all('svg.canvas .edge', graph).length > 0, 'no edge is drawn');
  readable('at first');
  click(one('#open-all'));
  await wait(60);
  readable('opened');
  // What is far outside is not drawn until it comes into view.
  click(one('#fit'));
  await wait(60);
  expect(units().length === data.passes.length, `fitted: ${units().length} boxes for ${data.passes.length} passes`);
  expect(all('.unit.culled', graph).length === data.passes.filter((pass) => !pass.place).length, 'culled passes are not all faint');
  expect(overlapping() === 0, `fitted: ${overlapping()} boxes lie over others`);
  const paper = box(one('svg.canvas'));
  const beyond = units().map((unit) => box(unit.querySelector('rect'))).filter((unit) =>
    unit.left < paper.left || unit.top < paper.top || unit.right > paper.right || unit.bottom > paper.bottom);
  expect(beyond.length === 0, `fitted, ${beyond.length} boxes are not visible`);
  click(one('#close-all'));
  await wait(60);
  expect(units().length === facts.boxes, 'closed again, there are other boxes');
  const closed = units().find((unit) => unit.textContent.includes('▸'));
  if (closed) {
    const before = graphView.note.textContent;
    key(closed, 'Enter');
    await wait(60);
    expect(graphView.note.textContent !== before, 'Enter does not expand a node');
  }

  // Search leads to a pass; the graph shows only this pass and those connected to it.
  const target = data.passes.findIndex((pass) => pass.place && data.edges.some((edge) => edge.after === data.passes.indexOf(pass)));
  const query = one('#query');
  key(document.body, '/');
  expect(document.activeElement === query, '/ does not lead to the search');
  query.value = path(target);
  query.dispatchEvent(new Event('input', { bubbles: true }));
  const found = all('#found button').find((button) => button.textContent.endsWith(path(target)));
  expect(found, `search does not find ${path(target)}`);
  click(found);
  await wait(60);
  expect(details().includes(path(target)), 'the details are not of what was found');
  expect(details().includes(data.passes[target].live), 'the details do not say why it runs');
  const near = new Set([target, ...data.edges.flatMap((edge) => (edge.after === target ? [edge.before] : edge.before === target ? [edge.after] : []))]);
  const shown = units().map((unit) => unit.dataset.name).sort();
  expect(JSON.stringify(shown) === JSON.stringify([...near].map((pass) => data.passes[pass].name).sort()), `around ${path(target)}: ${shown.length} passes, not ${near.size}`);
  expect(all('.unit.chosen', graph).length === 1, 'the selection is not marked');
  expect(all('svg.canvas .label', graph).some((label) => / v\d+$/.test(label.textContent)), 'no edge is labelled with resource and version');
  readable('around a pass');
  key(document.body, 'Escape');
  await wait(60);
  expect(one('#whole').hidden, 'Escape does not lead back to the whole frame');
  query.value = 'no such thing';
  query.dispatchEvent(new Event('input', { bubbles: true }));
  expect(one('#found').textContent.includes('nothing'), 'a search without results shows no message');
  key(query, 'Escape');

  // A culled pass has a reason.
  const culled = data.passes.findIndex((pass) => pass.culled);
  if (culled >= 0) {
    await open('Log');
    location.hash = `#graph/pass/${culled}`;
    await wait(100);
    expect(details().includes(data.passes[culled].culled), 'a culled pass does not say why');
    key(document.body, 'Escape');
  }

  // Tabs by arrow keys.
  one('[role=tab][aria-selected=true]').focus();
  key(one('[role=tab][aria-selected=true]'), 'ArrowRight');
  await wait(30);
  expect(panel() !== graph && document.activeElement.getAttribute('aria-selected') === 'true', 'arrow keys do not move between tabs');

  const timeline = await open('Timeline');
  const running = data.passes.filter((pass) => pass.place);
  const marks = running.reduce((sum, pass) => sum + pass.accesses.length, 0);
  expect(all('.col', timeline).length === running.length, 'timeline: not a column for each pass');
  expect(all('.row .unit[role=img]', timeline).length === marks, `timeline: not ${marks} marks`);

  const memory = await open('Memory');
  const used = data.slots.reduce((sum, slot) => sum + slot.resources.length, 0);
  expect(all('svg .row .unit', memory).length === used, `memory: not ${used} bars`);
  expect(/peak .* saved|saved .* peak/.test(one('#memory-facts').textContent), 'memory: no peak, or nothing of what is saved');

  const passes = await open('Passes');
  const rows = () => all('#pass-table tbody tr', passes);
  expect(rows().length === data.passes.length, 'passes: not a row for each pass');
  const head = all('th', passes).find((cell) => cell.textContent === 'Pass');
  click(head.querySelector('button'));
  const names = rows().map((row) => row.querySelector('button').textContent);
  expect(head.getAttribute('aria-sort') === 'ascending' && names.every((name, index) => !index || names[index - 1] <= name), 'passes do not sort by name');
  const filter = passes.querySelector('input');
  filter.value = path(target).toLowerCase();
  filter.dispatchEvent(new Event('input', { bubbles: true }));
  expect(rows().length >= 1 && rows().length <= data.passes.length && rows().every((row) => row.textContent.includes(data.passes[target].name) || data.passes.length < 3), 'passes do not filter');

  const textures = await open('Textures');
  const drawn = () => all('canvas', textures).every((canvas) => canvas.dataset.drawn === 'yes');
  for (let tries = 0; tries < 200 && !drawn(); tries += 1) await wait(20);
  const canvases = all('canvas', textures);
  const wanted = data.snapshots.filter((snapshot) => !snapshot.missing).length;
  expect(canvases.length === wanted, `${canvases.length} textures for ${wanted}`);
  expect(data.snapshots.length > 0 || textures.textContent.includes('No textures'), 'the page does not say that no textures were captured');
  for (const canvas of canvases.slice(0, 3)) {
    canvas.scrollIntoView();
    expect(canvas.dataset.drawn === 'yes', `${canvas.getAttribute('aria-label')} is not drawn`);
    const place = box(canvas);
    canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: place.left + place.width / 2, clientY: place.top + place.height / 2, bubbles: true }));
    expect(/^texel \d+, \d+: [-\d.]/.test(textures.querySelector('.value').textContent), `no value under the pointer: ${textures.querySelector('.value').textContent}`);
  }
  facts.colors = canvases.map((canvas) => {
    const { data: bytes } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(bytes.buffer)).size;
  });
  if (canvases.length) {
    click(canvases.at(-1));
    await wait(300);
    expect(one('dialog[open] canvas'), 'a texture does not open');
    one('dialog[open]')?.close();
  }

  const log = await open('Log');
  const sentences = all('#decisions li', log).map((item) => item.textContent);
  expect(sentences.length > data.passes.length, `${sentences.length} decisions`);
  expect(sentences.every((sentence) => /: \S|not used|usages|belongs/.test(sentence) || sentence.length > 12), 'a decision has no reason');
  facts.decisions = sentences.length;

  for (const table of data.tables) {
    const view = await open(table.title);
    expect(all('tbody tr', view).length === table.rows.length, `${table.title}: not all rows`);
  }
  // Every control has a name.
  for (const element of all('button, [role=button], [role=tab], [role=img], input, select')) {
    const label = element.getAttribute('aria-label') || element.textContent || element.closest('label')?.textContent;
    if (!label?.trim()) {
      faults.push(`an element without a name: ${element.outerHTML.slice(0, 80)}`);
      break;
    }
  }
  document.body.append(Object.assign(document.createElement('pre'), { id: 'result', textContent: JSON.stringify({ faults, facts }) }));
});
