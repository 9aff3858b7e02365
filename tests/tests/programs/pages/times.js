// Returns the longest time of each kind of action in ms, from the event until the next image is laid out and painted.
(async () => {
  const painted = () => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  const worst = {};
  const time = async (name, act) => {
    const begun = performance.now();
    act();
    await painted();
    worst[name] = Math.max(worst[name] ?? 0, Math.round(performance.now() - begun));
  };
  const some = (list, count) => list.map((_, index) => index).filter((index) => index % Math.ceil(list.length / count) === 0);
  const button = (id) => () => document.getElementById(id).click();
  await painted();
  for (const tab of tabs) {
    for (let round = 0; round < 2; round += 1) await time(`${round ? 'return to' : 'open'} ${tab.textContent}`, () => tab.click());
    for (const pass of some(passes, 8)) await time(`select a pass in ${tab.textContent}`, () => choose({ pass }));
  }
  tabs[0].click();
  for (const id of ['open-all', 'fit', 'close-all']) await time(id, button(id));
  for (const pass of some(passes, 20)) await time('select a pass', () => choose({ pass }));
  for (const resource of some(resources, 20)) await time('select a resource', () => choose({ resource }));
  graphView.reach = 99;
  for (const pass of some(passes, 20)) await time('all that is connected', () => choose({ pass }));
  for (const text of ['p', 'pass 12', 'nothing', '']) await time('search', () => find(text));
  return worst;
})()
