// How fast a page is drawn by software while its camera orbits, as two tables: node bench.mjs PAGE.html
//
// The first: the whole picture, frame by frame. The script's share is what stays where a graphics card draws. For the whole a pixel is read back,
// which waits for it. The second: what one sees, frames a second of a camera that moves, after the governor has found what it can draw.

import { chromium } from "@playwright/test";
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const FRAMES = 8;
/** Seconds of a full turn, and turns: the first is for the governor. */
const [TURN, TURNS] = [8, 2];
const SIZES = [[1280, 720], [320, 180]];
const page = process.argv[2];
if (!page || !existsSync(page)) throw new Error("which page? node bench.mjs PAGE.html");
const executablePath = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((path) => path && existsSync(path));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const ms = (value) => value.toFixed(value < 10 ? 1 : 0);

const moving = ["| window | camera | pixels along a side | level | draws | triangles | script [ms] | frames a second | 19 of 20 frames within [ms] |\n|---|---|---|---|---|---|---|---|---|"];
console.log("| window | camera | draws | triangles | script [ms] | frame, one pixel each [ms] | frame, standing [ms] |\n|---|---|---|---|---|---|---|");
for (const [width, height] of SIZES) {
  const tab = await browser.newPage({ viewport: { width, height } });
  const start = performance.now();
  await tab.goto(pathToFileURL(resolve(page)).href);
  await tab.locator("body.ready").waitFor({ timeout: 300_000 });
  const ready = performance.now();
  // Levels come one after the other: the last is there when no other has come for a while.
  const count = () => tab.evaluate(() => window.isolux.viewer.after.details.count);
  for (let round = 0, before = 0, now = 1; round < 6 && (now === 1 || now > before); round++) {
    await tab.waitForTimeout(10_000);
    [before, now] = [now, await count()];
  }
  if (width === SIZES[0][0]) moving.unshift(`Opened in ${((ready - start) / 1000).toFixed(1)} s; triangles of the levels: ${await tab.evaluate(levels)}\n`);
  // The picture alone.
  await tab.keyboard.press("h");
  for (const camera of ["scene", "overview"]) {
    const whole = await tab.evaluate(orbit, { camera, frames: FRAMES });
    console.log(`| ${width} x ${height} | ${camera} | ${whole.calls.toFixed(0)} | ${whole.triangles.toFixed(0)} | ${ms(whole.script)} | ${ms(whole.whole)} | ${ms(whole.standing)} |`);
    const { pixels, level, calls, triangles, script, rate, within } = await tab.evaluate(move, { camera, turn: TURN, turns: TURNS });
    moving.push(`| ${width} x ${height} | ${camera} | ${pixels.toFixed(2)} | ${level} | ${calls} | ${triangles} | ${ms(script)} | ${rate.toFixed(0)} | ${ms(within)} |`);
  }
  await tab.close();
}
console.log(`\n${moving.join("\n")}`);
await browser.close();

/** In the page: how many triangles each level has. */
function levels() {
  const { details } = window.isolux.viewer.after;
  return Array.from({ length: details.count }, (_, k) => details.level(k).index.count / 3).join(", ");
}

/** In the page: means over the frames of a full turn about the point ahead, whole and with a pixel for each of the page, and of a camera that stands. */
function orbit({ camera, frames }) {
  const { viewer } = window.isolux;
  const gl = viewer.renderer.getContext();
  const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  viewer.takeCamera(camera === "scene" ? 0 : viewer.after.surfaces.header.cameras.length - 1);
  const eye = viewer.camera.camera;
  const target = viewer.ahead();
  const from = eye.position.clone().sub(target);
  const sum = { calls: 0, triangles: 0, script: 0, whole: 0, standing: 0 };
  const draw = (draft) => {
    const start = performance.now();
    viewer.draw(draft);
    const told = performance.now();
    finish();
    return { script: told - start, whole: performance.now() - start, ...viewer.work };
  };
  const whole = { pixels: 1, level: 0 };
  draw(whole);
  for (let k = 0; k < frames; k++) {
    eye.position.copy(from).applyAxisAngle(eye.up, (2 * Math.PI * k) / frames).add(target);
    eye.lookAt(target);
    const moving = draw(whole);
    for (const name of ["calls", "triangles", "script", "whole"]) sum[name] += moving[name];
    sum.standing += draw().whole;
  }
  return Object.fromEntries(Object.entries(sum).map(([name, value]) => [name, value / frames]));
}

/** In the page: the last of some full turns about the point ahead, as fast as the browser draws. */
function move({ camera, turn, turns }) {
  const { viewer } = window.isolux;
  viewer.takeCamera(camera === "scene" ? 0 : viewer.after.surfaces.header.cameras.length - 1);
  const eye = viewer.camera.camera;
  const target = viewer.ahead();
  const from = eye.position.clone().sub(target);
  const times = [], scripts = [];
  const draw = viewer.draw.bind(viewer);
  viewer.draw = (draft) => {
    const start = performance.now();
    draw(draft);
    scripts.push(performance.now() - start);
  };
  return new Promise((done) => {
    let start, last;
    const frame = (now) => {
      start ??= now;
      const turned = (now - start) / 1000 / turn;
      if (turned > turns) {
        viewer.draw = draw;
        const [sorted, mean] = [times.sort((a, b) => a - b), (values) => values.reduce((sum, value) => sum + value, 0) / values.length];
        const { renderer, work } = viewer;
        return done({
          pixels: renderer.getPixelRatio(), ...work, script: mean(scripts.slice(-times.length)), rate: 1000 / mean(times), within: sorted[Math.floor(0.95 * times.length)],
        });
      }
      if (turned > turns - 1) times.push(now - last);
      last = now;
      eye.position.copy(from).applyAxisAngle(eye.up, 2 * Math.PI * turned).add(target);
      eye.lookAt(target);
      viewer.move();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  });
}
