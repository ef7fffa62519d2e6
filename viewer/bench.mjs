// How long a page takes to draw while its camera orbits, by software, as a table: node bench.mjs PAGE.html
//
// The script's share is what stays where a graphics card draws. For the whole a pixel is read back, which waits for it.

import { chromium } from "@playwright/test";
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const FRAMES = 8;
const SIZES = [[1280, 720], [320, 180]];
const page = process.argv[2];
if (!page || !existsSync(page)) throw new Error("which page? node bench.mjs PAGE.html");
const executablePath = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((path) => path && existsSync(path));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });

console.log("| window | camera | draws | triangles | script [ms] | frame [ms] | frame, standing [ms] |\n|---|---|---|---|---|---|---|");
for (const [width, height] of SIZES) {
  const tab = await browser.newPage({ viewport: { width, height } });
  await tab.goto(pathToFileURL(resolve(page)).href);
  await tab.locator("body.ready").waitFor({ timeout: 300_000 });
  // The picture alone.
  await tab.keyboard.press("h");
  for (const camera of ["scene", "overview"]) {
    const { calls, triangles, script, whole, standing } = await tab.evaluate(orbit, { camera, frames: FRAMES });
    const ms = (value) => value.toFixed(value < 10 ? 1 : 0);
    console.log(`| ${width} x ${height} | ${camera} | ${calls.toFixed(0)} | ${triangles.toFixed(0)} | ${ms(script)} | ${ms(whole)} | ${ms(standing)} |`);
  }
  await tab.close();
}
await browser.close();

/** In the page: means over the frames of a full turn about the point ahead, and of a camera that stands. */
function orbit({ camera, frames }) {
  const { viewer } = window.isolux;
  const gl = viewer.renderer.getContext();
  const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  viewer.takeCamera(camera === "scene" ? 0 : viewer.after.surfaces.header.cameras.length - 1);
  const eye = viewer.camera.camera;
  const target = viewer.ahead();
  const from = eye.position.clone().sub(target);
  const sum = { calls: 0, triangles: 0, script: 0, whole: 0, standing: 0 };
  const draw = (isDraft) => {
    const start = performance.now();
    viewer.draw(isDraft);
    const told = performance.now();
    finish();
    return { script: told - start, whole: performance.now() - start, ...viewer.work };
  };
  draw(true);
  for (let k = 0; k < frames; k++) {
    eye.position.copy(from).applyAxisAngle(eye.up, (2 * Math.PI * k) / frames).add(target);
    eye.lookAt(target);
    const moving = draw(true);
    for (const name of ["calls", "triangles", "script", "whole"]) sum[name] += moving[name];
    sum.standing += draw(false).whole;
  }
  return Object.fromEntries(Object.entries(sum).map(([name, value]) => [name, value / frames]));
}
