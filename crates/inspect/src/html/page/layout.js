// Boxes in layers from left to right, each to the right of the boxes that it depends on (after Sugiyama, Tagawa and Toda, 1981).

const BOX = { width: 196, height: 40, right: 92, down: 16 };

// `units` are in order of their first pass; `arrows` are {from, to} pairs of unit indices, from lower to higher. Sets x and y of
// each unit and `points` of each arrow; an arrow over more than `far` layers gets none.
function layOut(units, arrows, far) {
  for (const unit of units) unit.layer = 0;
  for (const arrow of [...arrows].sort((a, b) => a.to - b.to)) {
    units[arrow.to].layer = Math.max(units[arrow.to].layer, units[arrow.from].layer + 1);
  }
  const layers = [];
  const put = (vertex) => (layers[vertex.layer] ??= []).push(vertex);
  const vertices = units.map((unit) => ({ unit, layer: unit.layer, height: BOX.height, left: [], right: [] }));
  vertices.forEach(put);
  for (const arrow of arrows) {
    const [from, to] = [vertices[arrow.from], vertices[arrow.to]];
    arrow.chain = null;
    if (to.layer - from.layer > far) continue;
    arrow.chain = [from];
    for (let layer = from.layer + 1; layer < to.layer; layer += 1) {
      const bend = { layer, height: 10, left: [], right: [] };
      put(bend);
      arrow.chain.push(bend);
    }
    arrow.chain.push(to);
    arrow.chain.slice(1).forEach((vertex, index) => {
      vertex.left.push(arrow.chain[index]);
      arrow.chain[index].right.push(vertex);
    });
  }
  const number = (layer) => layer.forEach((vertex, index) => { vertex.place = index; });
  layers.forEach(number);
  const mean = (list, of) => list.reduce((sum, vertex) => sum + vertex[of], 0) / list.length;
  for (let sweep = 0; sweep < 8; sweep += 1) {
    const side = sweep % 2 ? 'right' : 'left';
    for (const layer of sweep % 2 ? [...layers].reverse() : layers) {
      for (const vertex of layer) vertex.target = vertex[side].length ? mean(vertex[side], 'place') : vertex.place;
      layer.sort((a, b) => a.target - b.target || a.place - b.place);
      number(layer);
    }
  }
  for (const layer of layers) {
    let y = 0;
    for (const vertex of layer) {
      vertex.y = y;
      y += vertex.height + BOX.down;
    }
  }
  for (let sweep = 0; sweep < 10; sweep += 1) {
    for (const layer of sweep % 2 ? [...layers].reverse() : layers) straighten(layer, mean);
  }
  const top = Math.min(0, ...vertices.map((vertex) => vertex.y));
  for (const vertex of vertices) {
    vertex.unit.x = vertex.layer * (BOX.width + BOX.right);
    vertex.unit.y = vertex.y - top;
  }
  for (const arrow of arrows) {
    arrow.points = arrow.chain?.map((vertex, index, chain) => ({
      x: vertex.layer * (BOX.width + BOX.right) + (index === 0 ? BOX.width : index === chain.length - 1 ? 0 : BOX.width / 2),
      y: vertex.y - top + vertex.height / 2,
      bend: !vertex.unit,
    }));
  }
}

// Moves the vertices of a layer towards their neighbours, without any overlap.
function straighten(layer, mean) {
  const targets = layer.map((vertex) => {
    const near = [...vertex.left, ...vertex.right];
    return near.length ? mean(near.map((other) => ({ at: other.y + other.height / 2 })), 'at') - vertex.height / 2 : vertex.y;
  });
  // Groups that would overlap share the mean of their targets (pool adjacent violators).
  const groups = [];
  layer.forEach((vertex, index) => {
    let group = { first: index, count: 1, size: vertex.height + BOX.down, at: targets[index] };
    while (groups.length && groups.at(-1).at + groups.at(-1).size > group.at) {
      const above = groups.pop();
      const at = (above.at * above.count + (group.at - above.size) * group.count) / (above.count + group.count);
      group = { first: above.first, count: above.count + group.count, size: above.size + group.size, at };
    }
    groups.push(group);
  });
  for (const group of groups) {
    let y = group.at;
    for (let index = group.first; index < group.first + group.count; index += 1) {
      layer[index].y = y;
      y += layer[index].height + BOX.down;
    }
  }
}

const pathOf = (points) => points.slice(1).reduce((path, to, index) => {
  const from = points[index];
  // The line is straight where it passes a box.
  const start = from.bend ? { x: from.x + BOX.width / 2, y: from.y } : from;
  const end = to.bend ? { x: to.x - BOX.width / 2, y: to.y } : to;
  const middle = (start.x + end.x) / 2;
  return `${path}${from.bend ? ` L${start.x} ${start.y}` : ''} C${middle} ${start.y} ${middle} ${end.y} ${end.x} ${end.y}`;
}, `M${points[0].x} ${points[0].y}`);
