// What textures held, after each pass that wrote them; and drawings.

// Texels of a picture, in rows from the top: bytes, or floats. Read once.
async function texelsOf(picture) {
  picture.texels ??= (async () => {
    const packed = Uint8Array.from(atob(picture.data), (char) => char.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    const buffer = await new Response(stream).arrayBuffer();
    return picture.floats ? new Float32Array(buffer) : new Uint8Array(buffer);
  })();
  return picture.texels;
}

// The range that greys are stretched over: all finite values, for depth without those that nothing was drawn to.
function rangeOf(picture, texels, only = null) {
  let [low, high] = [Infinity, -Infinity];
  const step = only == null ? 1 : picture.channels;
  for (let at = only ?? 0; at < texels.length; at += step) {
    const value = texels[at];
    if (!Number.isFinite(value) || (picture.depth && value === 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [0, 1];
}

const encode = (light) => 255 * (light <= 0.0031308 ? light * 12.92 : 1.055 * light ** (1 / 2.4) - 0.055);

const stretch = (value, [low, high]) => 40 + (215 * (value - low)) / (high - low || 1);

// `only` is a channel that is shown alone, as greys over its range.
function paintPicture(canvas, picture, texels, opaque, only = null) {
  const { width, height, channels } = picture;
  canvas.width = width;
  canvas.height = height;
  const image = new ImageData(width, height);
  const grey = channels === 1 || picture.depth || only != null;
  // Light is toned down; all else is stretched, each channel over its own range.
  const light = picture.floats && !grey && channels > 2 && !picture.integers && texels.every((value) => !(value < 0));
  const wanted = (channel) => picture.floats && !light && (grey ? channel === 0 : channel < channels);
  const ranges = [0, 1, 2].map((channel) => (wanted(channel) ? rangeOf(picture, texels, grey ? only : channel) : null));
  for (let index = 0; index < width * height; index += 1) {
    const at = (channel) => texels[index * channels + channel];
    const out = image.data.subarray(index * 4, index * 4 + 4);
    out[3] = 255;
    for (let channel = 0; channel < 3; channel += 1) {
      const value = at(grey ? only ?? 0 : channel);
      if (!grey && channel >= channels) out[channel] = 0;
      else if (!picture.floats) out[channel] = value;
      else if (Number.isNaN(value)) [out[0], out[1], out[2]] = [255, 0, 255];
      else if (!light) out[channel] = value === 0 && picture.depth ? 0 : stretch(value, ranges[grey ? 0 : channel]);
      // Light without an upper end (Reinhard et al., 2002).
      else out[channel] = encode(Math.max(0, value) / (1 + Math.max(0, value)));
    }
    if (!opaque && channels === 4 && !picture.floats && only == null) out[3] = at(3);
  }
  canvas.getContext('2d').putImageData(image, 0, 0);
}

// The texel under the pointer, in words.
function valueAt(picture, texels, canvas, event) {
  const box = canvas.getBoundingClientRect();
  const scale = Math.min(box.width / picture.width, box.height / picture.height);
  const [left, top] = [(box.width - picture.width * scale) / 2, (box.height - picture.height * scale) / 2];
  const [x, y] = [Math.floor((event.clientX - box.left - left) / scale), Math.floor((event.clientY - box.top - top) / scale)];
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return '';
  const texel = (at, size, axis) => picture.origin[axis] + Math.floor(((at + 0.5) * picture.full[axis]) / size);
  const values = Array.from(texels.slice((y * picture.width + x) * picture.channels, (y * picture.width + x + 1) * picture.channels));
  const words = values.map((value) => (picture.floats ? Number(value.toPrecision(6)) : value)).join(', ');
  const tile = (picture.tiles ?? []).find((box) => {
    const [u, v] = [texel(x, picture.width, 0), texel(y, picture.height, 1)];
    return u >= box.x && v >= box.y && u < box.x + box.width && v < box.y + box.height;
  });
  return `texel ${texel(x, picture.width, 0)}, ${texel(y, picture.height, 1)}: ${words}${picture.floats ? '' : ' of 255'}${tile ? `   ${tile.name}` : ''}`;
}

const versionsOf = ({ since, version }) => (since < version ? `v${since} to v${version} beside each other` : `v${version}`);
const captionOf = (picture) => `${versionsOf(picture)}${picture.part ? `, ${picture.part}` : ''}, ${picture.pass == null ? 'at the end' : `after ${passPath(picture.pass)}`}`;

const picturesView = {
  name: 'Pictures',

  build(panel) {
    this.value = h('span', { class: 'value', 'aria-live': 'off' });
    const byResource = new Map();
    frame.pictures.forEach((picture) => byResource.set(picture.resource, [...(byResource.get(picture.resource) ?? []), picture]));
    const blocks = [...byResource].map(([resource, list]) => h('section', { class: 'pictures', id: `pictures-${resource}` },
      h('h2', {}, resourceLink(resource), h('span', { class: 'why' }, ` ${resources[resource].shape}`)), list.map((picture) => this.card(picture))));
    panel.append(
      h('div', { class: 'bar' }, frame.pictures.length
        ? [h('span', { class: 'hint' }, 'Point at a picture for a texel’s value; choose it for more.'), this.value]
        : h('span', { class: 'hint' }, 'There are no pictures: nothing was drawn for this page.')),
      h('div', { class: 'scroll', id: 'all-pictures' }, frame.drawings.map(drawing), blocks));
  },

  card(picture) {
    const caption = h('figcaption', {}, captionOf(picture));
    if (picture.missing) return h('figure', {}, h('p', { class: 'why' }, `No picture: ${picture.missing}.`), caption);
    const canvas = h('canvas', { role: 'img', tabindex: '0', 'aria-label': `${resourceName(picture.resource)}, ${captionOf(picture)}`, ...press(() => this.open(picture)) });
    texelsOf(picture).then((texels) => {
      paintPicture(canvas, picture, texels, false);
      canvas.dataset.drawn = 'yes';
      canvas.addEventListener('pointermove', (event) => { this.value.textContent = valueAt(picture, texels, canvas, event); });
    });
    const names = picture.tiles.length ? s('svg', { class: 'tiles', 'aria-hidden': 'true', viewBox: `0 0 ${picture.full[0]} ${picture.full[1]}` }) : '';
    if (names) drawTiles(names, picture, picture.full[0] / picture.width);
    return h('figure', {}, h('div', { class: 'stage' }, canvas, names), caption);
  },

  async open(picture) {
    const texels = await texelsOf(picture);
    const canvas = h('canvas');
    const value = h('div', { class: 'value' });
    const names = s('svg', { style: 'position:absolute;left:0;top:0;pointer-events:none' });
    let scale = Math.max(1, Math.floor(Math.min((innerWidth * 0.9) / picture.width, (innerHeight * 0.75) / picture.height)));
    let opaque = false;
    let only = null;
    const range = h('span', { class: 'why' });
    const draw = () => {
      paintPicture(canvas, picture, texels, opaque, only);
      range.textContent = ` ${rangeWords(picture, texels, only)}`;
      canvas.style.width = `${picture.width * scale}px`;
      canvas.style.height = `${picture.height * scale}px`;
      names.setAttribute('width', picture.width * scale);
      names.setAttribute('height', picture.height * scale);
      drawTiles(names, picture, scale);
    };
    canvas.addEventListener('pointermove', (event) => { value.textContent = valueAt(picture, texels, canvas, event); });
    const size = (by) => () => {
      scale = Math.max(1, Math.min(32, scale * by));
      draw();
    };
    const dialog = h('dialog', { 'aria-label': `${resourceName(picture.resource)}, ${captionOf(picture)}`, onclose: () => dialog.remove() },
      h('h2', {}, `${resourceName(picture.resource)}: ${captionOf(picture)}`),
      h('div', {}, h('button', { onclick: size(2), 'aria-label': 'Larger' }, '+'), ' ', h('button', { onclick: size(0.5), 'aria-label': 'Smaller' }, '−'), ' ',
        picture.channels === 4 && !picture.floats ? h('label', {}, h('input', { type: 'checkbox', onchange: (event) => {
          opaque = event.target.checked;
          draw();
        } }), ' without alpha ') : '',
        picture.channels > 1 && h('select', { 'aria-label': 'Channels', onchange: (event) => {
          only = event.target.value === '' ? null : Number(event.target.value);
          draw();
        } }, ['all channels', 'red', 'green', 'blue', 'alpha'].slice(0, picture.channels + 1).map((name, index) => h('option', { value: index ? index - 1 : '' }, name))),
        ' ', h('button', { onclick: () => dialog.close() }, 'Close (Esc)'), range),
      value, h('div', { class: 'stage' }, canvas, names));
    document.body.append(dialog);
    draw();
    dialog.showModal();
  },

  reveal(resource) {
    if (resource != null) document.getElementById(`pictures-${resource}`)?.scrollIntoView();
  },

  chosen() {},
};

function rangeWords(picture, texels, only) {
  const whole = `${picture.full[0]} x ${picture.full[1]} texels, every ${(picture.full[0] / picture.width).toFixed(1)}th shown`;
  if (!picture.floats) return whole;
  const [low, high] = rangeOf(picture, texels, only);
  return `${whole}; values ${Number(low.toPrecision(5))} to ${Number(high.toPrecision(5))}${picture.depth ? ', black where nothing was drawn' : ''}${picture.integers ? ', whole numbers' : ''}`;
}

// Outlines and names of the parts that passes drew into. `scale` is how large a shown texel is.
function drawTiles(svg, picture, scale) {
  const letter = Math.max(12, (picture.width * scale) / (svg.classList.contains('tiles') ? 20 : 60));
  const across = (picture.width / picture.full[0]) * scale;
  const parts = (picture.tiles ?? []).flatMap((tile) => [
    s('rect', {
      x: tile.x * across, y: tile.y * across, width: tile.width * across, height: tile.height * across, fill: 'none', stroke: 'var(--mark)',
      'stroke-width': 1.5, 'vector-effect': 'non-scaling-stroke',
    }),
    // What does not fit is told by the value under the pointer.
    tile.width * across > letter * 2.5 && s('text', { class: 'label', x: tile.x * across + letter * 0.4, y: tile.y * across + letter * 1.2, style: `font-size:${letter}px;stroke-width:${letter / 3}px` },
      clip(tile.name, Math.max(3, Math.floor((tile.width * across) / letter / 0.6)))),
  ]);
  svg.replaceChildren(...parts.filter(Boolean));
}

// Named outlines on a plane, x to the right and y down, with a list of them beside it that zooms in on each.
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
    h('ul', {}, plot.outlines.map(entry), h('li', {}, h('button', { class: 'link', onclick: () => look(all) }, 'all of them'))), h('figcaption', {}, plot.caption));
}
