// The frame, and functions for the views. Passes, resources and nodes are identified by their indices.

const frame = JSON.parse(document.getElementById('frame').textContent);
const { passes, resources, nodes, slots, edges } = frame;

const nodePath = (node) => (node == null ? '' : nodePath(nodes[node].parent) + nodes[node].name + '/');
const passPath = (pass) => nodePath(passes[pass].node) + passes[pass].name;
const resourcePath = (resource) => nodePath(resources[resource].node) + resources[resource].name;
// The shortest name that is unique.
const sameName = new Map();
for (const { name } of resources) sameName.set(name, (sameName.get(name) ?? 0) + 1);
const resourceName = (resource) => (sameName.get(resources[resource].name) > 1 ? resourcePath(resource) : resources[resource].name);
// The nodes around something, the outermost first.
const around = (node) => (node == null ? [] : [...around(nodes[node].parent), node]);

// The passes that run, in order.
const order = passes.map((_, pass) => pass).filter((pass) => passes[pass].place)
  .sort((a, b) => passes[a].place.order - passes[b].place.order);
const stepCount = order.length ? passes[order.at(-1)].place.step + 1 : 0;
const steps = Array.from({ length: stepCount }, () => []);
for (const pass of order) steps[passes[pass].place.step].push(pass);

// The version of a resource that a pass writes or reads.
const versionOf = (access) => `v${access.version + (access.writes ? 1 : 0)}`;

// Accesses of each resource, in order of declaration.
const users = resources.map(() => []);
passes.forEach((pass, index) => pass.accesses.forEach((access) => users[access.resource].push({ pass: index, access })));

// Edges of culled passes, derived from versions.
function culledEdges() {
  const found = [];
  for (const [resource, uses] of users.entries()) {
    for (const reader of uses) {
      for (const writer of uses) {
        const fits = writer.access.writes && writer.pass < reader.pass && !reader.access.covers
          && writer.access.version + 1 === reader.access.version;
        if (fits && (!passes[writer.pass].place || !passes[reader.pass].place)) {
          found.push({ before: writer.pass, after: reader.pass, resource, kind: 'faint' });
        }
      }
    }
  }
  return found;
}
const links = [...edges, ...culledEdges()];
const before = passes.map(() => []);
const after = passes.map(() => []);
for (const link of links) {
  before[link.after].push(link);
  after[link.before].push(link);
}

// Position of each pass among all; a culled pass follows the passes that it would have read from.
const rank = [];
passes.forEach((pass, index) => {
  rank[index] = pass.place?.order ?? before[index].reduce((last, link) => Math.max(last, rank[link.before]), -1) + 0.5;
});

function linkLabel(link) {
  if (link.resource == null) return 'after';
  const used = passes[link.after].accesses.find((access) => access.resource === link.resource);
  return `${resourceName(link.resource)} v${used ? used.version : '?'}`;
}

// Culled passes have no dependencies; these are the ones that they would have had.
const describeLink = ({ why, before, after, resource }) => why
  ?? `“${passPath(after)}” would read “${resourceName(resource)}” from “${passPath(before)}” if neither were culled`;

function bytes(count) {
  if (count < 1024) return `${count} B`;
  return count < 1048576 ? `${(count / 1024).toFixed(1)} KiB` : `${(count / 1048576).toFixed(1)} MiB`;
}
