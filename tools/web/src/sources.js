// Where files come from: dropped, chosen, pasted, an example, or the address of the page.
import { examples } from './examples.js';
import { element } from './format.js';

const ofBlob = (name, blob) => ({ name, bytes: async () => new Uint8Array(await blob.arrayBuffer()) });
function ofAddress(address, name) {
  return {
    name,
    bytes: async (signal) => {
      const response = await fetch(address, { signal });
      if (!response.ok) throw new Error(`${name}: the server has no such file, it answers ${response.status}`);
      return new Uint8Array(await response.arrayBuffer());
    },
  };
}

/** The name of a text that was pasted, by how it begins. */
function nameOfText(text) {
  if (/^\s*ISO-10303-21/.test(text)) return 'pasted.stp';
  if (/^\s*[{[]/.test(text)) return 'pasted.json';
  if (/^\s*\d+\s+1\s+0\s+\d+\s/.test(text)) return 'pasted.g2';
  return /^\s*\d+\s*$/m.test(text.split('\n', 1)[0]) ? 'pasted.bpt' : 'pasted.obj';
}

/** The file that the page's address asks for: /?model=/model/part.step, of this server alone. */
export function sourceOfAddress() {
  const asked = new URLSearchParams(location.search).get('model');
  if (!asked) return null;
  const refused = { name: asked, bytes: async () => { throw new Error(`${asked}: expected a file of this server`); } };
  try {
    const address = new URL(asked, location.href);
    if (address.origin !== location.origin) return refused;
    return ofAddress(address, decodeURIComponent(address.pathname.split('/').at(-1)));
  } catch {
    return refused;
  }
}

/** Calls `open(source)` for each file that comes, `say(sentence)` if what comes is none. */
export function listen({ stage, chooser, buttons, choice, tries, open, say }) {
  const take = (files) => {
    if (!files.length) return say('That is no file. Drop a STEP, JSON, g2, OBJ or bpt file.');
    if (files.length > 1) say(`${files.length} files came, the first is opened.`);
    open(ofBlob(files[0].name, files[0]));
  };
  let depth = 0;
  const drag = (change) => stage.classList.toggle('over', (depth = Math.max(0, depth + change)) > 0);
  addEventListener('dragenter', () => drag(1));
  addEventListener('dragleave', () => drag(-1));
  addEventListener('dragover', (event) => event.preventDefault());
  addEventListener('drop', (event) => {
    event.preventDefault();
    drag(-depth);
    take(event.dataTransfer?.files ?? []);
  });
  addEventListener('paste', (event) => {
    if (/^(INPUT|TEXTAREA)$/.test(event.target.tagName)) return;
    const files = event.clipboardData?.files ?? [], text = event.clipboardData?.getData('text/plain') ?? '';
    if (files.length) take(files);
    else if (text.trim()) open(ofBlob(nameOfText(text), new Blob([text])));
  });
  chooser.addEventListener('change', () => {
    if (chooser.files.length) take(chooser.files);
    chooser.value = '';
  });
  for (const button of buttons) button.addEventListener('click', () => chooser.click());
  choice.append(element('option', { value: '' }, 'Examples'),
    ...examples.map(([name, title]) => element('option', { value: name }, title)));
  const openExample = (name) => open(ofAddress(`models/${name}`, name));
  tries.append(...examples.map(([name, title]) =>
    element('button', { type: 'button', onclick: () => openExample(name) }, title.replace(/ \(.*/, ''))));
  choice.addEventListener('change', () => {
    if (choice.value) openExample(choice.value);
    choice.value = '';
  });
}
