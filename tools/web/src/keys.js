// The keyboard, and clicks that pick, in the picture.
const step = Math.PI / 36, modes = ['shaded', 'edges', 'curvature', 'wireframe'];
const axes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** `on`: { pick(x, y), mode(name), clear(), hide(), showAll() }. */
export function listenForKeys(canvas, viewer, on) {
  const arrows = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
  };
  const actions = {
    '+': () => viewer.zoom(0.9), '=': () => viewer.zoom(0.9), '-': () => viewer.zoom(1 / 0.9),
    f: () => viewer.look(null), Home: () => viewer.look([0.62, -1, 0.62]),
    Enter: () => on.pick(0.5, 0.5), Escape: () => on.clear(),
    h: (event) => (event.shiftKey ? on.showAll() : on.hide()),
  };
  for (const [key, axis] of Object.entries(axes))
    actions[key] = (event) => viewer.look(axis.map((value) => (value || 1e-4 * (key === 'z')) * (event.shiftKey ? -1 : 1)));
  modes.forEach((mode, k) => { actions[k + 1] = () => on.mode(mode); });
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !viewer.object) return;
    const arrow = arrows[event.key], action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (arrow && event.shiftKey) viewer.pan(-0.04 * arrow[0], -0.04 * arrow[1]);
    else if (arrow) viewer.turn(-step * arrow[0], step * arrow[1]);
    else if (action) action(event);
    else return;
    event.preventDefault();
  });
}

/** A press that did not move is a pick. */
export function listenForPicks(canvas, pick) {
  let pressed = null, fingers = 0;
  canvas.addEventListener('pointerdown', (event) => {
    ++fingers;
    pressed = event.button === 0 && fingers === 1 ? { x: event.clientX, y: event.clientY } : null;
  });
  const end = (event) => {
    fingers = Math.max(0, fingers - 1);
    const reach = event.pointerType === 'touch' ? 10 : 4;
    if (event.type === 'pointerup' && pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < reach) {
      const box = canvas.getBoundingClientRect();
      pick((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    }
    pressed = null;
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
}
