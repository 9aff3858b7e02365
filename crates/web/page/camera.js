// Mouse, touch and keys move the camera of a viewer.

const RADIANS_PER_PIXEL = 0.006;
/** Directions of keys: right, up, ahead. */
const KEYS = {
  KeyW: [0, 0, 1], KeyS: [0, 0, -1], KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyE: [0, 1, 0], KeyQ: [0, -1, 0],
};
const TURNS = { ArrowLeft: [0.06, 0], ArrowRight: [-0.06, 0], ArrowUp: [0, -0.06], ArrowDown: [0, 0.06] };
const ZOOMS = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };

/** Lets a canvas move the camera; `changed` is called after each move. */
export function attachCamera(canvas, viewer, changed) {
  const pointers = new Map();
  const middle = () => {
    const all = [...pointers.values()];
    const sum = all.reduce((total, [x, y]) => [total[0] + x, total[1] + y], [0, 0]);
    return sum.map(value => value / all.length);
  };
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", event => {
    canvas.focus();
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", event => {
    if (!pointers.has(event.pointerId)) return;
    const [before, apart] = [middle(), pointers.size > 1 ? spread() : 0];
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const after = middle();
    const [x, y] = [after[0] - before[0], after[1] - before[1]];
    if (pointers.size > 1 || event.buttons & 6 || event.shiftKey) {
      viewer.shift(-x / canvas.clientHeight, y / canvas.clientHeight, 0);
      if (pointers.size > 1) viewer.zoom(apart / Math.max(spread(), 1));
    } else {
      viewer.turn(-x * RADIANS_PER_PIXEL, -y * RADIANS_PER_PIXEL);
    }
    changed();
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, event => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    viewer.zoom(Math.exp(Math.max(-100, Math.min(100, event.deltaY)) * 0.002));
    changed();
  }, { passive: false });
  canvas.addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [move, turn, zoom] = [KEYS[event.code], TURNS[event.key], ZOOMS[event.key]];
    if (move) viewer.shift(...move.map(part => part * (event.shiftKey ? 0.2 : 0.05)));
    else if (turn) viewer.turn(...turn);
    else if (zoom) viewer.zoom(zoom);
    else return;
    event.preventDefault();
    changed();
  });
}
