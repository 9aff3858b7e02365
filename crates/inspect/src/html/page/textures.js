// Contents of textures after each pass that wrote them, and plots.

// Texels of a snapshot, in rows from the top: bytes or floats. Decoded once.
async function texelsOf(snapshot) {
  snapshot.texels ??= (async () => {
    const packed = Uint8Array.from(atob(snapshot.data), (char) => char.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    const buffer = await new Response(stream).arrayBuffer();
    return snapshot.floats ? new Float32Array(buffer) : new Uint8Array(buffer);
  })();
  return snapshot.texels;
}

// The range that is mapped to greys: all finite values; for depth, without the clear value.
function rangeOf(snapshot, texels, only = null) {
  let [low, high] = [Infinity, -Infinity];
  const step = only == null ? 1 : snapshot.channels;
  for (let at = only ?? 0; at < texels.length; at += step) {
    const value = texels[at];
    if (!Number.isFinite(value) || (snapshot.depth && value === 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [0, 1];
}

const encode = (light) => 255 * (light <= 0.0031308 ? light * 12.92 : 1.055 * light ** (1 / 2.4) - 0.055);

const stretch = (value, [low, high]) => 40 + (215 * (value - low)) / (high - low || 1);

// `only` is a single channel to show, as greys over its range.
function paintTexels(canvas, snapshot, texels, opaque, only = null) {
  const { width, height, channels } = snapshot;
  canvas.width = width;
  canvas.height = height;
  const image = new ImageData(width, height);
  const grey = channels === 1 || snapshot.depth || only != null;
  // Light is tone mapped; other values are stretched, each channel over its own range.
  const light = snapshot.floats && !grey && channels > 2 && !snapshot.integers && texels.every((value) => !(value < 0));
  const wanted = (channel) => snapshot.floats && !light && (grey ? channel === 0 : channel < channels);
  const ranges = [0, 1, 2].map((channel) => (wanted(channel) ? rangeOf(snapshot, texels, grey ? only : channel) : null));
  for (let index = 0; index < width * height; index += 1) {
    const at = (channel) => texels[index * channels + channel];
    const out = image.data.subarray(index * 4, index * 4 + 4);
    out[3] = 255;
    for (let channel = 0; channel < 3; channel += 1) {
      const value = at(grey ? only ?? 0 : channel);
      if (!grey && channel >= channels) out[channel] = 0;
      else if (!snapshot.floats) out[channel] = value;
      else if (Number.isNaN(value)) [out[0], out[1], out[2]] = [255, 0, 255];
      else if (!light) out[channel] = value === 0 && snapshot.depth ? 0 : stretch(value, ranges[grey ? 0 : channel]);
      // Unbounded light (Reinhard et al., 2002).
      else out[channel] = encode(Math.max(0, value) / (1 + Math.max(0, value)));
    }
    if (!opaque && channels === 4 && !snapshot.floats && only == null) out[3] = at(3);
  }
  canvas.getContext('2d').putImageData(image, 0, 0);
}

// Describes the texel under the pointer.
function valueAt(snapshot, texels, canvas, event) {
  const box = canvas.getBoundingClientRect();
  const scale = Math.min(box.width / snapshot.width, box.height / snapshot.height);
  const [left, top] = [(box.width - snapshot.width * scale) / 2, (box.height - snapshot.height * scale) / 2];
  const [x, y] = [Math.floor((event.clientX - box.left - left) / scale), Math.floor((event.clientY - box.top - top) / scale)];
  if (x < 0 || y < 0 || x >= snapshot.width || y >= snapshot.height) return '';
  const texel = (at, size, axis) => snapshot.origin[axis] + Math.floor(((at + 0.5) * snapshot.full[axis]) / size);
  const values = Array.from(texels.slice((y * snapshot.width + x) * snapshot.channels, (y * snapshot.width + x + 1) * snapshot.channels));
  const shown = values.map((value) => (snapshot.floats ? Number(value.toPrecision(6)) : value)).join(', ');
  const tile = (snapshot.tiles ?? []).find((box) => {
    const [u, v] = [texel(x, snapshot.width, 0), texel(y, snapshot.height, 1)];
    return u >= box.x && v >= box.y && u < box.x + box.width && v < box.y + box.height;
  });
  return `texel ${texel(x, snapshot.width, 0)}, ${texel(y, snapshot.height, 1)}: ${shown}${snapshot.floats ? '' : ' of 255'}${tile ? `   ${tile.name}` : ''}`;
}

const versionsOf = ({ since, version }) => (since < version ? `v${since} to v${version} in adjacent rectangles` : `v${version}`);
const captionOf = (snapshot) => `${versionsOf(snapshot)}${snapshot.part ? `, ${snapshot.part}` : ''}, ${snapshot.pass == null ? 'at the end of the frame' : `after ${passPath(snapshot.pass)}`}`;

const texturesView = {
  name: 'Textures',

  build(panel) {
    this.value = h('span', { class: 'value', 'aria-live': 'off' });
    const byResource = new Map();
    frame.snapshots.forEach((snapshot) => byResource.set(snapshot.resource, [...(byResource.get(snapshot.resource) ?? []), snapshot]));
    const blocks = [...byResource].map(([resource, list]) => h('section', { class: 'textures', id: `textures-${resource}` },
      h('h2', {}, resourceLink(resource), h('span', { class: 'why' }, ` ${resources[resource].shape}`)), list.map((snapshot) => this.card(snapshot))));
    panel.append(
      h('div', { class: 'bar' }, frame.snapshots.length
        ? [h('span', { class: 'hint' }, 'Point at a texture for the value of a texel; click it to enlarge it.'), this.value]
        : h('span', { class: 'hint' }, 'No textures were captured for this page.')),
      h('div', { class: 'scroll', id: 'all-textures' }, frame.drawings.map(drawing), blocks));
  },

  card(snapshot) {
    const caption = h('figcaption', {}, captionOf(snapshot));
    if (snapshot.missing) return h('figure', {}, h('p', { class: 'why' }, `No snapshot: ${snapshot.missing}.`), caption);
    const canvas = h('canvas', { role: 'img', tabindex: '0', 'aria-label': `${resourceName(snapshot.resource)}, ${captionOf(snapshot)}`, ...press(() => this.open(snapshot)) });
    texelsOf(snapshot).then((texels) => {
      paintTexels(canvas, snapshot, texels, false);
      canvas.dataset.drawn = 'yes';
      canvas.addEventListener('pointermove', (event) => { this.value.textContent = valueAt(snapshot, texels, canvas, event); });
    });
    const names = snapshot.tiles.length ? s('svg', { class: 'tiles', 'aria-hidden': 'true', viewBox: `0 0 ${snapshot.full[0]} ${snapshot.full[1]}` }) : '';
    if (names) drawTiles(names, snapshot, snapshot.full[0] / snapshot.width);
    return h('figure', {}, h('div', { class: 'stage' }, canvas, names), caption);
  },

  async open(snapshot) {
    const texels = await texelsOf(snapshot);
    const canvas = h('canvas');
    const value = h('div', { class: 'value' });
    const names = s('svg', { style: 'position:absolute;left:0;top:0;pointer-events:none' });
    let scale = Math.max(1, Math.floor(Math.min((innerWidth * 0.9) / snapshot.width, (innerHeight * 0.75) / snapshot.height)));
    let opaque = false;
    let only = null;
    const range = h('span', { class: 'why' });
    const draw = () => {
      paintTexels(canvas, snapshot, texels, opaque, only);
      range.textContent = ` ${describeRange(snapshot, texels, only)}`;
      canvas.style.width = `${snapshot.width * scale}px`;
      canvas.style.height = `${snapshot.height * scale}px`;
      names.setAttribute('width', snapshot.width * scale);
      names.setAttribute('height', snapshot.height * scale);
      drawTiles(names, snapshot, scale);
    };
    canvas.addEventListener('pointermove', (event) => { value.textContent = valueAt(snapshot, texels, canvas, event); });
    const size = (by) => () => {
      scale = Math.max(1, Math.min(32, scale * by));
      draw();
    };
    const dialog = h('dialog', { 'aria-label': `${resourceName(snapshot.resource)}, ${captionOf(snapshot)}`, onclose: () => dialog.remove() },
      h('h2', {}, `${resourceName(snapshot.resource)}: ${captionOf(snapshot)}`),
      h('div', {}, h('button', { onclick: size(2), 'aria-label': 'Larger' }, '+'), ' ', h('button', { onclick: size(0.5), 'aria-label': 'Smaller' }, '−'), ' ',
        snapshot.channels === 4 && !snapshot.floats ? h('label', {}, h('input', { type: 'checkbox', onchange: (event) => {
          opaque = event.target.checked;
          draw();
        } }), ' without alpha ') : '',
        snapshot.channels > 1 && h('select', { 'aria-label': 'Channels', onchange: (event) => {
          only = event.target.value === '' ? null : Number(event.target.value);
          draw();
        } }, ['all channels', 'red', 'green', 'blue', 'alpha'].slice(0, snapshot.channels + 1).map((name, index) => h('option', { value: index ? index - 1 : '' }, name))),
        ' ', h('button', { onclick: () => dialog.close() }, 'Close (Esc)'), range),
      value, h('div', { class: 'stage' }, canvas, names));
    document.body.append(dialog);
    draw();
    dialog.showModal();
  },

  reveal(resource) {
    if (resource != null) document.getElementById(`textures-${resource}`)?.scrollIntoView();
  },

  chosen() {},
};

function describeRange(snapshot, texels, only) {
  const whole = `${snapshot.full[0]} x ${snapshot.full[1]} texels, every ${(snapshot.full[0] / snapshot.width).toFixed(1)}th shown`;
  if (!snapshot.floats) return whole;
  const [low, high] = rangeOf(snapshot, texels, only);
  return `${whole}; values ${Number(low.toPrecision(5))} to ${Number(high.toPrecision(5))}${snapshot.depth ? ', black where nothing was drawn' : ''}${snapshot.integers ? ', integers' : ''}`;
}

// Outlines and names of the rectangles that passes drew into. `scale` is the size of a shown texel.
function drawTiles(svg, snapshot, scale) {
  const letter = Math.max(12, (snapshot.width * scale) / (svg.classList.contains('tiles') ? 20 : 60));
  const across = (snapshot.width / snapshot.full[0]) * scale;
  const parts = (snapshot.tiles ?? []).flatMap((tile) => [
    s('rect', {
      x: tile.x * across, y: tile.y * across, width: tile.width * across, height: tile.height * across, fill: 'none', stroke: 'var(--mark)',
      'stroke-width': 1.5, 'vector-effect': 'non-scaling-stroke',
    }),
    // Names that do not fit are shown with the value under the pointer.
    tile.width * across > letter * 2.5 && s('text', { class: 'label', x: tile.x * across + letter * 0.4, y: tile.y * across + letter * 1.2, style: `font-size:${letter}px;stroke-width:${letter / 3}px` },
      clip(tile.name, Math.max(3, Math.floor((tile.width * across) / letter / 0.6)))),
  ]);
  svg.replaceChildren(...parts.filter(Boolean));
}

// Named outlines on a plane, x to the right and y down, with a list of names that zooms in on each.
function drawing(plot) {
  const boxOf = (points) => {
    const [xs, ys] = [points.map((point) => point[0]), points.map((point) => point[1])];
    const [x, y] = [Math.min(...xs), Math.min(...ys)];
    return { x, y, width: Math.max(...xs) - x || 1, height: Math.max(...ys) - y || 1 };
  };
  const color = (index) => `hsl(${hueOf(plot.outlines[index].name)} 60% 50%)`;
  const shapes = plot.outlines.map((outline, index) => s('polygon', {
    points: outline.points.map((point) => point.join(',')).join(' '), 'vector-effect': 'non-scaling-stroke',
    style: `fill:${color(index)};fill-opacity:.07;stroke:${color(index)};stroke-width:1.5`, ...hint(outline.name),
  }));
  const svg = s('svg', { style: 'background:none', role: 'img', 'aria-label': `${plot.title}: ${plot.outlines.map((outline) => outline.name).join(', ')}` }, shapes);
  const look = (points) => {
    const { x, y, width, height } = boxOf(points);
    svg.setAttribute('viewBox', `${x - width * 0.1} ${y - height * 0.1} ${width * 1.2} ${height * 1.2}`);
  };
  const emphasis = (shape, strong) => () => { shape.style.fillOpacity = strong ? 0.35 : 0.07; };
  const entry = (outline, index) => h('li', {}, h('button', {
    class: 'link', onclick: () => look(outline.points), onpointerenter: emphasis(shapes[index], true), onpointerleave: emphasis(shapes[index], false),
    onfocus: emphasis(shapes[index], true), onblur: emphasis(shapes[index], false),
  }, h('span', { style: `color:${color(index)}` }, '■ '), outline.name));
  const all = plot.outlines.flatMap((outline) => outline.points);
  look(all);
  return h('figure', { class: 'drawing' }, h('h2', {}, plot.title), svg,
    h('ul', {}, plot.outlines.map(entry), h('li', {}, h('button', { class: 'link', onclick: () => look(all) }, 'show all'))), h('figcaption', {}, plot.caption));
}
