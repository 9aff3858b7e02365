// Helpers that create elements.

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value == null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child != null && child !== false));
  return element;
}
const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);
const s = (tag, attributes, ...children) => fill(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);

// Calls `act` on a click, and on Enter or Space if the element has the focus.
function press(act) {
  return {
    onclick: act,
    onkeydown: (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      act(event);
    },
  };
}

const tip = document.getElementById('tip');
// Shows `text` next to the pointer and sets it as the label of the element.
function hint(text) {
  const move = (event) => {
    tip.textContent = text;
    tip.hidden = false;
    const [x, y] = [event.clientX + 14, event.clientY + 14];
    tip.style.left = `${Math.min(x, innerWidth - tip.offsetWidth - 8)}px`;
    tip.style.top = `${Math.min(y, innerHeight - tip.offsetHeight - 8)}px`;
  };
  return { 'aria-label': text, onpointermove: move, onpointerleave: () => { tip.hidden = true; } };
}

const passLink = (pass) => h('button', { class: 'link', onclick: () => choose({ pass }) }, passPath(pass));
const resourceLink = (resource) => h('button', { class: 'link', onclick: () => choose({ resource }) }, resourceName(resource));
const counted = (number, one, many) => `${number} ${number === 1 ? one : many}`;
const clip = (text, length) => (text.length > length ? `${text.slice(0, length - 1)}…` : text);
// Keeps the end of a path, which is the most specific.
const clipFront = (text, length) => (text.length > length ? `…${text.slice(1 - length)}` : text);
// A colour for a name, the same in every frame (FNV-1a, Fowler, Noll and Vo).
function hueOf(name) {
  let hash = 0x811c9dc5;
  for (const char of name) hash = Math.imul(hash ^ char.charCodeAt(0), 0x01000193);
  return (hash >>> 0) % 360;
}
const outermost = (node) => hueOf(nodes[around(node)[0]].name);
const hue = (node) => (node == null ? 'transparent' : `hsl(${outermost(node)} 45% var(--fill))`);
const hueLine = (node) => (node == null ? 'var(--line)' : `hsl(${outermost(node)} 45% var(--edge))`);
