// A browser without a window, the page's server, and what tests do with the page.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const fromPage = createRequire(join(root, 'tools/web/package.json'));
export const puppeteer = (await import(pathToFileURL(fromPage.resolve('puppeteer-core')).href)).default;
export const axe = () => readFileSync(fromPage.resolve('axe-core/axe.min.js'), 'utf8');
export const modelAt = (name) => join(root, 'tools/models', name);

export function launch(executablePath) {
  const args = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
  return puppeteer.launch({ executablePath, args });
}

/** Serves the folder `page`; `model`: a file for /model/. Returns { address, close() }. */
export async function serve(page, model = null) {
  const { foldersOf, serverOf } = await import(pathToFileURL(join(page, 'serve.mjs')).href);
  const server = serverOf({ folders: foldersOf(page), model });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://localhost:${server.address().port}/`, close: () => server.close() };
}

/** A tab with the page. `faults`: what the console and the network complain of. */
export class Tab {
  faults = [];
  requests = [];

  static async open(browser, address, { width = 1280, height = 800, scheme = 'light', touch = false } = {}) {
    const tab = new Tab();
    const page = (tab.page = await browser.newPage());
    await page.setViewport({ width, height, hasTouch: touch, isMobile: touch });
    await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: scheme }]);
    page.on('pageerror', (error) => tab.faults.push(error.stack ?? String(error)));
    page.on('console', (message) => {
      // Chromium says this of its own software renderer.
      if (/GPU stall|GL Driver Message/.test(message.text())) return;
      if (['error', 'warn'].includes(message.type())) tab.faults.push(message.text());
    });
    page.on('request', (request) => tab.requests.push(request.url()));
    await page.goto(address);
    return tab;
  }
  evaluate(...values) { return this.page.evaluate(...values); }
  text(id) { return this.page.$eval(`#${id}`, (element) => element.textContent); }
  wait(test, ...values) { return this.page.waitForFunction(test, { timeout: 60000, polling: 20 }, ...values); }

  /** Drops a file on the picture. */
  async drop(name, bytes) {
    await this.evaluate((file, encoded) => {
      const data = Uint8Array.from(atob(encoded), (each) => each.charCodeAt(0)), transfer = new DataTransfer();
      transfer.items.add(new File([data], file));
      document.getElementById('stage')
        .dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }, name, Buffer.from(bytes).toString('base64'));
  }
  dropFile(file) { return this.drop(basename(file), readFileSync(file)); }
  /** Waits until a model of this name is shown and proven. */
  async shown(name) {
    await this.wait((title) => document.title === title || !document.getElementById('error').hidden, name);
    await this.settled();
  }
  /** Waits until the picture is proven and stays so. */
  async settled() {
    await this.wait(() => {
      const proof = document.getElementById('proof'), now = performance.now(), state = (window.settling ??= {});
      if (proof.dataset.proven !== 'true' || state.text !== proof.textContent) state.since = now;
      state.text = proof.textContent;
      return now - state.since > 150;
    });
  }
  /** A row of the lists beside the picture. */
  row(name) {
    return this.evaluate((term) => [...document.querySelectorAll('dt')].find((each) => each.textContent === term)
      ?.nextElementSibling.textContent ?? null, name);
  }
  /** The picture's pixels, to compare. */
  async picture() {
    const canvas = await this.page.$('#picture');
    return Buffer.from(await canvas.screenshot({ captureBeyondViewport: false })).toString('base64');
  }
  /** Whether the picture becomes this one within some seconds, which a busy machine may need to draw it. */
  async becomes(wanted) {
    for (let k = 0; k < 20; ++k) {
      if (await this.picture() === wanted) return true;
      await new Promise((resolve) => setTimeout(resolve, 250));
    }
    return false;
  }
  async key(name, shift = false) {
    await this.page.focus('#picture');
    if (shift) await this.page.keyboard.down('Shift');
    await this.page.keyboard.press(name);
    if (shift) await this.page.keyboard.up('Shift');
    await this.settled();
  }
}

/** The JSON of a .glb file, checked in its lengths. */
export function glbOf(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const isWhole = view.getUint32(0, true) === 0x46546c67 && view.getUint32(8, true) === bytes.length;
  if (!isWhole) throw new Error('this is no .glb file');
  return JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + view.getUint32(12, true))));
}
