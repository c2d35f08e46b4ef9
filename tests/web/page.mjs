// Tests the page in Chromium:  node page.mjs BROWSER PAGE [NATIVE-TESSERA]
import assert from 'node:assert/strict';
import { launch, serve } from './browser.mjs';
import { cases as casesOfPage } from './cases.mjs';
import { nativeCases } from './native_cases.mjs';

const [executable, folder, native] = process.argv.slice(2);
const cases = { ...casesOfPage, ...nativeCases };
const browser = await launch(executable);
const server = await serve(folder);
let failed = 0;
for (const [name, test] of Object.entries(cases)) {
  const start = performance.now();
  try {
    await test({ assert, browser, server, folder, native });
    console.log(`ok ${name} (${Math.round(performance.now() - start)} ms)`);
  } catch (error) {
    ++failed;
    console.error(`FAILED ${name}: ${error.stack}`);
  }
  // A case that fails leaves its tabs.
  for (const page of (await browser.pages()).slice(1)) await page.close();
}
await browser.close();
server.close();
console.log(failed ? `${failed} of ${Object.keys(cases).length} failed` : `all ${Object.keys(cases).length} passed`);
process.exitCode = failed ? 1 : 0;
