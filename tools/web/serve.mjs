// Serves the page on this machine alone:  node serve.mjs [--port 8080] [part.step]
import { randomBytes } from 'node:crypto';
import { createReadStream, existsSync, readFileSync, realpathSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, dirname, extname, join, resolve, sep } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8',
  '.mjs': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8',
  '.json': 'application/json', '.svg': 'image/svg+xml', '.wasm': 'application/wasm',
};
const headers = {
  // With both of these a page has SharedArrayBuffer.
  'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp',
  'Cross-Origin-Resource-Policy': 'same-origin', 'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer',
  'Cache-Control': 'no-cache',
};

/** Folders of the page by the beginnings of their addresses: all in one when built, and spread in the sources. */
export function foldersOf(root = here) {
  if (existsSync(join(root, 'tessera/tessera.wasm'))) return [['/', root]];
  const three = join(root, 'node_modules/three');
  return [['/tessera/', resolve(root, '../../build/wasm/npm')], ['/three/addons/', join(three, 'examples/jsm')],
    ['/three/', join(three, 'build')], ['/models/', resolve(root, '../models')], ['/', root]];
}

/** The file of an address, or null: nothing outside the folders, and nothing hidden. */
function fileOf(folders, path) {
  const [start, folder] = folders.find(([begin]) => path.startsWith(begin));
  const rest = path.slice(start.length) || 'index.html';
  if (rest.split(/[\\/]/).some((part) => part.startsWith('.')) || rest.includes('\0')) return null;
  const file = join(folder, rest);
  if (!existsSync(file) || !statSync(file).isFile()) return null;
  return realpathSync(file).startsWith(realpathSync(folder) + sep) ? file : null;
}

/** Sends a page that may use this server alone: its scripts are marked by a number that nobody else knows. */
function sendPage(response, file, type) {
  const nonce = randomBytes(16).toString('hex');
  const policy = `default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'nonce-${nonce}'; worker-src 'self'; ` +
    "connect-src 'self'; style-src 'self'; img-src 'self' blob:; base-uri 'none'; form-action 'none'; " +
    "frame-ancestors 'none'";
  response.writeHead(200, { ...headers, 'Content-Type': type, 'Content-Security-Policy': policy });
  response.end(readFileSync(file, 'utf8').replaceAll('<script', `<script nonce="${nonce}"`));
}

/** The address of the page that shows /model/NAME: the page decodes its query once, and the server the path in it. */
const addressOf = (name) => `?model=${encodeURIComponent(`/model/${encodeURIComponent(name)}`)}`;

/** The file of /model/NAME, or null. */
const modelOf = (model, path) => (model && path === `/model/${basename(model)}` ? model : null);

/** Makes the server. `model`: a file that is served as /model/NAME. */
export function serverOf({ folders = foldersOf(), model = null } = {}) {
  const serve = (request, response) => {
    const answer = (status, text) => response.writeHead(status, { ...headers, 'Content-Type': 'text/plain' }).end(text);
    // Another site whose name leads to this machine is not served.
    const isOwn = /^(localhost|127\.0\.0\.1|\[::1\])(:\d+)?$/.test(request.headers.host ?? '');
    if (!isOwn) return answer(403, 'another host\n');
    if (request.method !== 'GET' && request.method !== 'HEAD') return answer(405, 'only GET and HEAD\n');
    let path;
    try {
      path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    } catch {
      return answer(400, 'no address\n');
    }
    const isModel = path.startsWith('/model/');
    const file = isModel ? modelOf(model, path) : fileOf(folders, path);
    if (!file) return answer(404, 'no such file\n');
    const size = statSync(file).size, type = types[extname(file).toLowerCase()] ?? 'application/octet-stream';
    if (type.startsWith('text/html')) return sendPage(response, file, type);
    response.writeHead(200, { ...headers, 'Content-Type': type, 'Content-Length': size });
    if (request.method === 'HEAD') return response.end();
    return createReadStream(file).on('error', () => response.destroy()).pipe(response);
  };
  return createServer((request, response) => {
    try {
      serve(request, response);
    } catch {  // a file that went meanwhile, or an address without a path
      if (!response.headersSent) response.writeHead(404, headers);
      response.end();
    }
  });
}

function main(words) {
  const use = 'usage: npm start -- [--port NUMBER] [FILE]';
  let port = 8080, model = null;
  for (let k = 0; k < words.length; ++k) {
    if (words[k] === '--port') port = Number(words[++k]);
    else if (words[k].startsWith('-') || model) return console.error(use), 2;
    else model = resolve(words[k]);
  }
  if (!(Number.isInteger(port) && port >= 0 && port < 65536)) return console.error(use), 2;
  if (model && !(existsSync(model) && statSync(model).isFile()))
    return console.error(`${model}: there is no such file`), 1;
  const folders = foldersOf(), lacking = folders.find(([, folder]) => !existsSync(folder));
  if (lacking) return console.error(`${lacking[1]} is not there: run npm ci, and build the target tessera_npm`), 1;
  const server = serverOf({ folders, model });
  server.on('error', (error) => {
    console.error(error.code === 'EADDRINUSE' ? `port ${port} is in use: name another by --port` : error.message);
    process.exitCode = 1;
  });
  server.listen(port, '127.0.0.1', () => {
    const query = model ? addressOf(basename(model)) : '';
    console.log(`http://localhost:${server.address().port}/${query}`);
  });
  return 0;
}
if (process.argv[1] && realpathSync(process.argv[1]) === fileURLToPath(import.meta.url))
  process.exitCode = main(process.argv.slice(2));
