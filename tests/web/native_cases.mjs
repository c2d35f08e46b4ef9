// The duties of `tessera view` towards the page; each case passes without the native program.
import { spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Tab, modelAt } from './browser.mjs';

/** Serves a file by `tessera view`. Returns { address, end() }; end() gives the signal that it ended by. */
async function viewed(native, folder, file) {
  const program = spawn(native, ['view', file, '--web', folder, '--no-browser', '--json'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const ended = new Promise((resolve) => program.on('exit', (code, signal) => resolve(signal ?? code)));
  let said = '';
  for await (const part of program.stdout) if ((said += part).includes('\n')) break;
  return {
    address: JSON.parse(said).address,
    end: () => (program.kill('SIGINT'), ended),
  };
}

async function viewsAFile({ assert, browser, native, folder }) {
  if (!native) return;
  const own = mkdtempSync(join(tmpdir(), 'tessera-view-')), name = 'a part #1 50%é.step';
  copyFileSync(modelAt('bearing_block.step'), join(own, name));
  const server = await viewed(native, folder, join(own, name));
  try {
    const tab = await Tab.open(browser, server.address);
    await tab.shown(name);
    assert.equal(await tab.page.$eval('#error', (element) => element.hidden), true);
    assert.equal(await tab.row('Faces'), '78');
    assert.equal(await tab.evaluate(() => crossOriginIsolated), true);
    assert.deepEqual(tab.faults, []);  // not the policy of contents either
    await tab.page.close();
  } finally {
    assert.equal(await server.end(), 'SIGINT');
    rmSync(own, { recursive: true });
  }
}

export const nativeCases = { viewsAFile };
