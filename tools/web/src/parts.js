// The tree of parts: shapes, their instances, and faces, each to select, to hide and to zoom to.
import { count, element } from './format.js';

const rowsAtOnce = 200;
let ids = 0;

/** A branch: { name, note, surfaces, children() }; `surfaces`: the faces below it. */
function branchesOf({ instances, shapes, faces }) {
  const surfacesOf = instances.map(() => []), free = [];
  faces.forEach((face, k) => (face.instance === null ? free : surfacesOf[face.instance]).push(k));
  const face = (k) => ({ name: faces[k].name || `Face ${k}`, note: faces[k].kind, surfaces: [k] });
  const instance = (k, name = instances[k].name) => ({
    name: name || `Part ${k}`, note: count(surfacesOf[k].length), surfaces: surfacesOf[k],
    children: () => surfacesOf[k].map(face),
  });
  const ofShapes = shapes.map(() => []);
  instances.forEach(({ shape }, k) => ofShapes[shape]?.push(k));
  const branches = ofShapes.flatMap((its, k) => {
    if (its.length === 1) return [instance(its[0], plainName(shapes[k].name) ?? instances[its[0]].name)];
    if (its.length === 0) return [];
    const surfaces = its.flatMap((each) => surfacesOf[each]);
    return [{ name: shapes[k].name || `Shape ${k}`, note: `× ${its.length}`, surfaces, children: () => its.map((each) => instance(each)) }];
  });
  return [...branches, ...free.map(face)];
}
const plainName = (name) => (name && name !== 'NONE' ? name : null);

export class Parts {
  #rows = [];  // { surfaces, row, box }

  /** `on`: { select(surfaces, name), hide(surfaces, isHidden), zoom(surfaces) }; `hidden`: as of ModelObject. */
  constructor(place, document, on) {
    Object.assign(this, { on, hidden: document.object.hidden });
    const branches = branchesOf(document);
    this.list = this.#listOf(branches);
    place.replaceChildren(this.list);
    if (branches.length === 1 && branches[0].children) this.list.querySelector('.twist')?.click();
  }

  #listOf(branches) {
    const list = element('ul', { className: 'tree' });
    const more = (from) => {
      list.append(...branches.slice(from, from + rowsAtOnce).map((branch) => this.#item(branch)));
      const left = branches.length - from - rowsAtOnce;
      if (left <= 0) return;
      const next = () => {
        item.remove();
        more(from + rowsAtOnce);
      };
      const item = element('li', {}, element('button', { type: 'button', onclick: next }, `${count(left)} more`));
      list.append(item);
    };
    more(0);
    return list;
  }

  #item(branch) {
    const { name, note, surfaces, children } = branch, id = `branch-${++ids}`;
    const box = element('input', { type: 'checkbox', checked: true, ariaLabel: `Show ${name}` });
    box.addEventListener('change', () => {
      this.on.hide(surfaces, !box.checked);
      this.refresh();
    });
    const button = element('button', { type: 'button', className: 'name', ariaPressed: 'false' },
      element('span', { className: 'title' }, name), element('span', { className: 'note' }, note));
    button.addEventListener('click', () => this.on.select(surfaces, name));
    const zoom = element('button', { type: 'button', className: 'zoom', ariaLabel: `Zoom to ${name}`, title: 'Zoom to it' });
    zoom.addEventListener('click', () => this.on.zoom(surfaces, name));
    const item = element('li', {}), row = element('div', { className: 'row' });
    row.append(children ? this.#twist(item, branch, id) : element('span', { className: 'twist' }), box, button, zoom);
    item.append(row);
    this.#rows.push({ surfaces, row, box, button });
    this.#refreshRow(this.#rows.at(-1));
    return item;
  }
  #twist(item, { name, children }, id) {
    const twist = element('button', { type: 'button', className: 'twist', ariaLabel: `Parts of ${name}`, ariaExpanded: 'false' });
    let list = null;
    twist.addEventListener('click', () => {
      if (!list) {
        list = this.#listOf(children());
        list.id = id;
        list.hidden = true;
        item.append(list);
        twist.setAttribute('aria-controls', id);
      }
      list.hidden = !list.hidden;
      twist.ariaExpanded = String(!list.hidden);
    });
    return twist;
  }

  #refreshRow({ surfaces, row, box }) {
    const isHidden = surfaces.every((each) => this.hidden[each]);
    box.checked = !isHidden;
    box.indeterminate = !isHidden && surfaces.some((each) => this.hidden[each]);
    row.classList.toggle('hidden-part', isHidden);
  }
  /** Follows what is hidden. */
  refresh() { this.#rows.forEach((each) => this.#refreshRow(each)); }
  /** Marks the rows of exactly these surfaces. */
  mark(surfaces) {
    for (const { row, button, surfaces: its } of this.#rows) {
      const isMarked = its.length === surfaces.length && its.length > 0 && its[0] === surfaces[0] && its.at(-1) === surfaces.at(-1);
      row.classList.toggle('marked', isMarked);
      button.ariaPressed = String(isMarked);
    }
  }
}
