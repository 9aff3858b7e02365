// A glTF file among files that were dropped or picked, and those next to it.

const isScene = path => /\.(glb|gltf)$/i.test(path);

/** Reads the scene and the files that it may refer to. */
async function read(files) {
  if (files.length === 0) throw new Error("no file was dropped");
  // A single file may have any name: its contents tell what it is.
  const scene = files.find(({ path }) => isScene(path)) ?? (files.length === 1 ? files[0] : undefined);
  if (!scene) throw new Error("none of these files ends with .glb or .gltf");
  const bytes = async file => new Uint8Array(await file.arrayBuffer());
  const folder = scene.path.slice(0, scene.path.lastIndexOf("/") + 1);
  const near = files.filter(file => file !== scene && file.path.startsWith(folder));
  const others = await Promise.all(near.map(async ({ path, file }) => [path.slice(folder.length), await bytes(file)]));
  return { name: scene.file.name, bytes: await bytes(scene.file), others };
}

/** Reads files that were picked. */
export async function picked(list) {
  return read([...list].map(file => ({ path: file.webkitRelativePath || file.name, file })));
}

/** Reads files and folders that were dropped. */
export async function dropped(transfer) {
  // Both lists end with the event.
  const entries = [...transfer.items].map(item => item.webkitGetAsEntry?.()).filter(Boolean);
  const files = [...transfer.files].map(file => ({ path: file.name, file }));
  return read(entries.length > 0 ? (await Promise.all(entries.map(walk))).flat() : files);
}

async function walk(entry) {
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    return [{ path: entry.fullPath.replace(/^\//, ""), file }];
  }
  const reader = entry.createReader();
  const found = [];
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return found;
    found.push(...(await Promise.all(some.map(walk))).flat());
  }
}
