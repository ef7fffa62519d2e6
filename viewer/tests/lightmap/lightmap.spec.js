// Lightmaps in three.js look like the engine's own pictures: all three carriers, in the Cornell box and in the office.
//
//     npx playwright test tests/lightmap
//
// Needs target/release/isolux (or ISOLUX) and a Chromium (CHROMIUM, /usr/bin/chromium). LIGHTMAP_PICTURES=folder keeps the pictures.

import { chromium, expect, test } from '@playwright/test';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize, resolve } from 'node:path';

const ROOT = resolve(import.meta.dirname, '../..');
const ISOLUX = process.env.ISOLUX ?? resolve(ROOT, '../target/release/isolux');
const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
const ARGUMENTS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.png': 'image/png' };
const WIDTH = 480;

let folder;
let server;
let browser;

/** Serves this project, and the files of the test below /out/. */
function serve() {
  return new Promise((done) => {
    const answer = (request, response) => {
      const path = normalize(new URL(request.url, 'http://localhost').pathname);
      const file = path.startsWith('/out/') ? join(folder, path.slice(5)) : join(ROOT, path);
      if (!existsSync(file)) return response.writeHead(404).end();
      response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' });
      response.end(readFileSync(file));
    };
    const made = createServer(answer).listen(0, '127.0.0.1', () => done(made));
  });
}

const isolux = (...args) => execFileSync(ISOLUX, args, { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] });

test.beforeAll(async () => {
  test.skip(!existsSync(ISOLUX) || !existsSync(CHROMIUM), `there is no ${ISOLUX}, or no ${CHROMIUM}`);
  folder = mkdtempSync(join(tmpdir(), 'lightmap-'));
  server = await serve();
  browser = await chromium.launch({ executablePath: CHROMIUM, args: ARGUMENTS });
});

test.afterAll(async () => {
  await browser?.close();
  server?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Differences of the picture of a baked scene from the engine's. */
async function compare(name, carrier, files, height) {
  const page = await browser.newPage();
  const errors = [];
  page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
  page.on('pageerror', (error) => errors.push(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/tests/lightmap/page.html`);
  await page.waitForFunction(() => window.ready);
  const found = await page.evaluate((options) => window.show(options), { ...files, width: WIDTH, height });
  expect(errors.filter((text) => !text.includes('favicon') && !text.includes('404'))).toEqual([]);
  await page.close();
  if (process.env.LIGHTMAP_PICTURES) {
    mkdirSync(process.env.LIGHTMAP_PICTURES, { recursive: true });
    for (const kind of ['shown', 'expected']) {
      const png = Buffer.from(found[kind].split(',')[1], 'base64');
      writeFileSync(join(process.env.LIGHTMAP_PICTURES, `${name}-${carrier}-${kind}.png`), png);
    }
  }
  console.log(`${name} ${carrier}: mean difference ${found.mean.toFixed(2)} of 255, ${(100 * found.far).toFixed(2)} % beyond 16`);
  return found;
}

// Bounds on the mean difference, in levels of 255, and on the share of pixels that differ by more than 16.
const SCENES = [
  { name: 'cornell-box', elements: '20k', rays: '5M', size: '1024', height: 480, mean: 1, far: 0.02 },
  { name: 'office', elements: '60k', rays: '10M', size: '2048', height: 270, mean: 3.5, far: 0.09 },
];

for (const { name, elements, rays, size, height, mean, far } of SCENES) {
  test.describe(name, () => {
    test.beforeAll(() => {
      const picture = ['--width', String(WIDTH), '--height', String(height)];
      const outputs = ['-o', `${name}.isolux`, '-o', `${name}.png`, '-o', `${name}.exr`];
      isolux('solve', name, '--elements', elements, '--rays', rays, ...picture, ...outputs);
      for (const carrier of ['unlit', 'MOZ_lightmap', 'sidecar']) {
        isolux('bake', `${name}.isolux`, '--carrier', carrier, '--size', size, '-o', `${name}-${carrier}.glb`);
      }
    });

    test('unlit', async () => {
      const found = await compare(name, 'unlit', { glb: `/out/${name}-unlit.glb`, reference: `/out/${name}.png` }, height);
      expect(found.mean).toBeLessThan(mean);
      expect(found.far).toBeLessThan(far);
    });

    test('MOZ_lightmap', async () => {
      const files = { glb: `/out/${name}-MOZ_lightmap.glb`, reference: `/out/${name}.exr` };
      const found = await compare(name, 'MOZ_lightmap', files, height);
      expect(found.mean).toBeLessThan(mean);
      expect(found.far).toBeLessThan(far);
    });

    test('sidecar', async () => {
      const map = `/out/${name}-sidecar.exr`;
      const files = { glb: `/out/${name}-sidecar.glb`, lightmap: map, reference: `/out/${name}.exr` };
      const found = await compare(name, 'sidecar', files, height);
      expect(found.mean).toBeLessThan(mean);
      expect(found.far).toBeLessThan(far);
    });

    test('a wrong intensity is seen', async () => {
      // Without the map a sidecar is dark but for its lamps.
      const files = { glb: `/out/${name}-sidecar.glb`, reference: `/out/${name}.exr` };
      expect((await compare(name, 'unattached', files, height)).mean).toBeGreaterThan(4 * mean);
    });
  });
}
