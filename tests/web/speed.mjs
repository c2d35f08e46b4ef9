// Measures how fast the page is, in Chromium without a window:
//   node speed.mjs BROWSER PAGE FILE.step ORBITED-FILE [FOLDER-OF-OCCT-IMPORT-JS]
// Prints the best, the median and the worst of several runs. The blocks of the main thread are the longest tasks of a
// run, by the clock and by the time that the thread itself ran, which other programs do not lengthen.
// occt-import-js is not fetched by the project: name its folder.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, join } from 'node:path';
import { Tab, launch, serve } from './browser.mjs';

const [executable, folder, file, orbited, occt] = process.argv.slice(2);
const runs = 7;
const browser = await launch(executable);
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

function report(name, values) {
  const sorted = [...values].sort((a, b) => a - b), at = (share) => Math.floor(share * (sorted.length - 1));
  const [best, median, worst] = [0, 0.5, 1].map((share) => sorted[at(share)].toFixed(1));
  console.log(`${name}: best ${best}, median ${median}, worst ${worst} ms`);
}

/** Runs `work`; returns the longest task of the page's main thread meanwhile, [by the clock, of the thread]. */
async function longestTask(tab, work) {
  await tab.page.tracing.start({ categories: ['toplevel', '__metadata'] });
  await work();
  const { traceEvents } = JSON.parse(new TextDecoder().decode(await tab.page.tracing.stop()));
  const threads = traceEvents.filter(({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain')
    .map(({ pid, tid }) => `${pid}:${tid}`);
  const tasks = traceEvents.filter(({ name, pid, tid }) => /RunTask/.test(name) && threads.includes(`${pid}:${tid}`));
  return ['dur', 'tdur'].map((time) => Math.max(0, ...tasks.map((task) => (task[time] ?? 0) / 1000)));
}
async function withFile(server, name) {
  const tab = await Tab.open(browser, server.address);
  await tab.evaluate(async (model) => {
    window.file = new File([await (await fetch(`model/${model}`)).arrayBuffer()], model);
  }, name);
  return tab;
}
async function drop(tab, name) {
  await tab.evaluate(() => {
    const transfer = new DataTransfer();
    transfer.items.add(window.file);
    document.getElementById('stage').dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
  });
  await tab.shown(name);
}

/** From the drop to the first picture, in new tabs that have been open for `rest`. */
async function drops(rest) {
  const times = [], again = [], name = basename(file), server = await serve(folder, file);
  for (let k = 0; k < runs; ++k) {
    const tab = await withFile(server, name);
    await pause(rest);
    await drop(tab, name);
    await pause(500);
    await drop(tab, name);
    await tab.wait(() => performance.getEntriesByName('picture').length === 2);
    const [first, second] = await tab.evaluate(() => performance.getEntriesByName('picture').map((each) => each.duration));
    times.push(first);
    again.push(second);
    await tab.page.close();
  }
  report(`drop to first picture of ${name}, after ${rest} ms`, times);
  report('  dropped once more', again);
  const blocks = [];
  for (let k = 0; k < 3; ++k) {
    const tab = await withFile(server, name);
    await pause(rest);
    blocks.push(await longestTask(tab, () => drop(tab, name)));
    await tab.page.close();
  }
  report('  longest task of the main thread', blocks.map(([clock]) => clock));
  report('  longest task, time of the thread', blocks.map(([, thread]) => thread));
  server.close();
  return Math.min(...times);
}

/** Orbits by the mouse: the times of plan and mesh, and how the main thread is blocked. */
async function orbit() {
  const name = basename(orbited), server = await serve(folder, orbited), tab = await withFile(server, name);
  await pause(3000);
  await drop(tab, name);
  console.log(`orbit of ${name}: ${await tab.row('Patches')} patches, ${await tab.row('Triangles')} triangles`);
  for (let round = 0; round < 3; ++round) {
    const plans = [];
    const [clock, thread] = await longestTask(tab, async () => {
      await tab.page.mouse.move(300, 400);
      await tab.page.mouse.down();
      for (let k = 1; k <= 60; ++k) {
        await tab.page.mouse.move(300 + 5 * k, 400 + (k % 30));
        await pause(16);
        plans.push(parseFloat((await tab.row('Plan')).replace(',', '')));
      }
      await tab.page.mouse.up();
      await tab.settled();
    });
    report('  plan, mesh and copies from the worker', plans);
    console.log(`  longest task of the main thread: ${clock.toFixed(1)} ms, of the thread ${thread.toFixed(1)} ms`);
  }
  server.close();
  await tab.page.close();
}

/** Measures occt-import-js with that file, in new pages that have been open as long, without a picture. */
async function occtTime() {
  const other = createServer((request, response) => {
    const name = request.url.slice(1), end = name.split('.').at(-1);
    const type = { wasm: 'application/wasm', js: 'text/javascript' }[end];
    response.writeHead(200, { 'Content-Type': type ?? 'text/html' });
    if (!name) return response.end('<script src=occt-import-js.js></script>');
    try {
      return response.end(readFileSync(name === 'file' ? file : join(occt, 'dist', basename(name))));
    } catch {
      return response.end();
    }
  });
  await new Promise((resolve) => other.listen(0, '127.0.0.1', resolve));
  const times = [], again = [];
  for (let k = 0; k < 3; ++k) {
    const page = await browser.newPage();
    await page.goto(`http://localhost:${other.address().port}/`);
    const [first, second] = await page.evaluate(async (rest) => {
      const reader = await window.occtimportjs(), bytes = new Uint8Array(await (await fetch('/file')).arrayBuffer());
      await new Promise((resolve) => setTimeout(resolve, rest));
      return [1, 2].map(() => {
        const start = performance.now();
        if (!reader.ReadStepFile(bytes, null).success) throw new Error('occt-import-js fails');
        return performance.now() - start;
      });
    }, 3000);
    times.push(first);
    again.push(second);
    await page.close();
  }
  report(`occt-import-js reads and meshes ${basename(file)} in a new page, without a picture`, times);
  report('  the same once more in that page', again);
  other.close();
  return Math.min(...times);
}

const cold = await drops(300), warm = await drops(3000);
await orbit();
if (occt) {
  const theirs = await occtTime();
  console.log(`occt-import-js takes ${(theirs / cold).toFixed(1)} and ${(theirs / warm).toFixed(1)} times as long`);
}
await browser.close();
process.exit(0);
