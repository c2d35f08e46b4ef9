// Measures how fast the page is, in Chromium without a window:
//   node speed.mjs BROWSER PAGE FILE.step ORBITED-FILE [FOLDER-OF-OCCT-IMPORT-JS]
// Prints the best and the median of several runs. occt-import-js is not fetched by the project: name its folder.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { basename } from 'node:path';
import { Tab, launch, serve } from './browser.mjs';

const [executable, folder, file, orbited, occt] = process.argv.slice(2);
const runs = 7;
const browser = await launch(executable), server = await serve(folder);
const report = (name, values, unit = 'ms') => {
  const sorted = [...values].sort((a, b) => a - b), at = (share) => sorted[Math.floor(share * (sorted.length - 1))].toFixed(1);
  console.log(`${name}: best ${at(0)}, median ${at(0.5)}, worst ${at(1)} ${unit}`);
};
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** From the drop to the first picture, in new tabs that have been open for `rest`. */
async function drops(rest) {
  const times = [], blocks = [];
  for (let k = 0; k < runs; ++k) {
    const tab = await Tab.open(browser, server.address);
    await watchBlocks(tab);
    await pause(rest);
    await tab.dropFile(file);
    await tab.shown(basename(file));
    times.push(await tab.evaluate(() => performance.getEntriesByName('picture')[0].duration));
    blocks.push(await longest(tab));
    await tab.page.close();
  }
  report(`drop to first picture of ${basename(file)}, after ${rest} ms`, times);
  report('  longest block of the main thread', blocks);
  return Math.min(...times);
}
const watchBlocks = (tab) => tab.evaluate(() => {
  window.blocks = [0];
  new PerformanceObserver((list) => window.blocks.push(...list.getEntries().map((each) => each.duration)))
    .observe({ type: 'longtask' });
});
const longest = (tab) => tab.evaluate(() => Math.max(...window.blocks));

/** Orbits by the mouse; the numbers of each plan, and how the main thread was blocked. */
async function orbit() {
  const tab = await Tab.open(browser, server.address);
  await pause(4000);
  await tab.dropFile(orbited);
  await tab.shown(basename(orbited));
  for (const round of ['first', 'second']) {
    await watchBlocks(tab);
    const plans = [];
    await tab.page.mouse.move(300, 400);
    await tab.page.mouse.down();
    for (let k = 1; k <= 90; ++k) {
      await tab.page.mouse.move(300 + 5 * k, 400 + (k % 30));
      await pause(16);
      plans.push(parseFloat((await tab.row('Plan')).replace(',', '')));
    }
    await tab.page.mouse.up();
    await tab.settled();
    console.log(`orbit of ${basename(orbited)}, ${await tab.row('Patches')} patches, ${await tab.row('Triangles')} triangles, ${round} time`);
    report('  plan, mesh and copies from the worker', plans);
    console.log(`  longest block of the main thread: ${(await longest(tab)).toFixed(1)} ms`);
  }
  await tab.page.close();
}

/** The same file by occt-import-js, in a page of this server's origin. */
async function occtTimes() {
  const other = createServer((request, response) => {
    const name = request.url.slice(1);
    if (!name) return response.writeHead(200, { 'Content-Type': 'text/html' }).end('<script src=occt-import-js.js></script>');
    try {
      response.writeHead(200, { 'Content-Type': name.endsWith('.wasm') ? 'application/wasm' : 'text/javascript' });
      return response.end(readFileSync(name === 'file' ? file : join(occt, 'dist', name)));
    } catch {
      return response.end();
    }
  });
  await new Promise((resolve) => other.listen(0, '127.0.0.1', resolve));
  const page = await browser.newPage();
  await page.goto(`http://localhost:${other.address().port}/`);
  const times = await page.evaluate(async (count) => {
    const occtImport = await window.occtimportjs(), bytes = new Uint8Array(await (await fetch('/file')).arrayBuffer());
    const found = [];
    for (let k = 0; k < count; ++k) {
      const start = performance.now();
      if (!occtImport.ReadStepFile(bytes, null).success) throw new Error('occt-import-js fails');
      found.push(performance.now() - start);
    }
    return found;
  }, 4);
  report(`occt-import-js reads and meshes ${basename(file)}, without a picture`, times);
  other.close();
  return Math.min(...times);
}

const cold = await drops(150), warm = await drops(4000);
await orbit();
if (occt) {
  const theirs = await occtTimes();
  console.log(`occt-import-js takes ${(theirs / cold).toFixed(1)} times as long as a picture at once, ${(theirs / warm).toFixed(1)} times later`);
}
await browser.close();
server.close();
