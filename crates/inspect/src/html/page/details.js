// Details of the selected pass or resource.

function passDetails(pass) {
  const { place, culled, live, kind, notes = [], waits, accesses, time, keep } = passes[pass];
  const lines = (list) => h('ul', {}, list.map((item) => h('li', {}, item)));
  return [
    h('h2', {}, passPath(pass)),
    h('p', {}, `${kind} pass${keep ? ', kept even if nothing needs what it writes' : ''}`),
    place ? h('p', {}, 'Runs: ', h('span', { class: 'why' }, live)) : h('p', {}, h('strong', {}, 'Does not run: '), culled),
    place && [
      h('p', {}, `Step ${place.step}, of steps 0 to ${stepCount - 1}: `, h('span', { class: 'why' }, place.why)),
      h('p', {}, place.within ? 'Merged with the previous pass: ' : 'Not merged: ', h('span', { class: 'why' }, place.merged)),
      place.of > 1 && h('p', {}, `Pass ${place.within + 1} of ${place.of} in this render pass.`),
      waits.length > 0 && [h('h3', {}, 'Waits for'), lines(waits)],
    ],
    notes.map((note) => h('p', {}, note)),
    time && h('p', {}, describeTime(time)),
    h('h3', {}, 'Accesses'),
    h('ul', {}, accesses.map((access) => h('li', {},
      `${access.does} `, access.part ? `${access.part} of ` : '', resourceLink(access.resource), ` ${versionOf(access)}${access.as}`,
      access.note ? h('span', { class: 'why' }, ` – ${access.note}`) : '',
      [access.load, access.clear, access.store].filter(Boolean).map(([action, why]) => h('div', { class: 'why' }, `${action}: ${why}`))))),
    neighbours('Needs', before[pass], 'before'),
    neighbours('Needed by', after[pass], 'after'),
  ];
}

function describeTime(time) {
  const shared = time.shared_by > 1 ? ` for all ${time.shared_by} merged passes` : '';
  return [`CPU ${milliseconds(time.cpu_ms)} ms`, time.gpu_ms != null && `GPU ${milliseconds(time.gpu_ms)} ms${shared}`,
    time.draws != null && `${time.draws} draws`, time.triangles != null && `${time.triangles.toLocaleString('en')} triangles`].filter(Boolean).join(', ');
}

function neighbours(title, list, end) {
  if (!list.length) return '';
  return [h('h3', {}, title), h('ul', {}, list.map((link) => h('li', {}, passLink(link[end]), h('span', { class: 'why' }, ` ${linkLabel(link)}`))))];
}

function resourceDetails(index) {
  const resource = resources[index];
  const snapshots = frame.snapshots.filter((snapshot) => snapshot.resource === index);
  return [
    h('h2', {}, resourcePath(index)),
    h('p', {}, `${resource.shape}, ${bytes(resource.bytes)}`),
    h('p', {}, `It ${resource.origin}.`),
    (resource.notes ?? []).map((note) => h('p', {}, note)),
    h('p', {}, resource.slot == null ? 'No slot: ' : `Slot ${resource.slot}${resource.steps ? `, steps ${resource.steps[0]} to ${resource.steps[1]}` : ''}: `, h('span', { class: 'why' }, resource.why)),
    resource.slot != null && slots[resource.slot].resources.length > 1 && h('p', {}, 'Shares the slot with ',
      slots[resource.slot].resources.filter((other) => other !== index).flatMap((other) => [resourceLink(other), ' '])),
    h('h3', {}, 'Accessed by'),
    h('ul', {}, users[index].map(({ pass, access }) => h('li', {}, `${versionOf(access)}: `, passLink(pass), ` ${access.does}${access.as}`,
      access.part ? ` (${access.part})` : '', passes[pass].place ? '' : ' (culled)'))),
    resource.usages.length > 0 && [h('h3', {}, 'Usages'), h('ul', {}, resource.usages.map((usage) => h('li', {}, usage)))],
    snapshots.length > 0 && h('p', {}, h('button', { onclick: () => show('Textures', index) }, `${snapshots.length} captured versions`)),
  ];
}

function drawDetails() {
  const panel = document.getElementById('details');
  const content = chosen?.pass != null ? passDetails(chosen.pass) : chosen?.resource != null ? resourceDetails(chosen.resource)
    : chosen?.path ? [h('h2', {}, chosen.title), h('p', { class: 'why' }, 'The passes that contributed to it, from the image back:'),
      h('ol', {}, chosen.path.map((pass) => h('li', {}, passLink(pass))))]
    : [h('h2', {}, 'Nothing selected'), h('p', { class: 'why' }, 'Select a pass or a resource, in any view or by its name.'),
      frame.notes.length > 0 && h('ul', {}, frame.notes.map((note) => h('li', {}, note)))];
  panel.replaceChildren(...[content].flat(4).filter(Boolean));
  panel.scrollTop = 0;
}
