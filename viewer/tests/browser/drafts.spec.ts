// What is drawn while the camera moves, and that nothing of it stays.

import type { Page } from "@playwright/test";
import { expect, open, picture, test } from "./page";

/** Makes frames take so many times as long, as the page sees it. */
const slow = (page: Page, times: number) => page.addInitScript((times) => {
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (then) => request((now) => then(times * now));
}, times);

/** Opens the page of many triangles, and waits for its levels of detail. */
async function openFine(page: Page): Promise<number> {
  await open(page, "fine.html");
  const count = () => page.evaluate(() => (window as any).isolux.viewer.after.details.count as number);
  await expect.poll(count).toBeGreaterThan(1);
  await page.waitForTimeout(1000);
  return count();
}

/** Pixels for each of the page, level of detail and triangles of the last picture. */
const drawn = (page: Page) => page.evaluate(() => {
  const { viewer } = (window as any).isolux;
  return { pixels: viewer.renderer.getPixelRatio() as number, level: viewer.work.level as number, triangles: viewer.work.triangles as number };
});

test("while the camera moves by software there are fewer pixels, and all of them once it stands", async ({ page }) => {
  await open(page, "room.html");
  expect((await drawn(page)).pixels).toBe(2);
  await page.mouse.move(400, 300);
  await page.mouse.down();
  await page.mouse.move(480, 320, { steps: 2 });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  expect((await drawn(page)).pixels).toBeLessThanOrEqual(0.5);
  await page.mouse.up();
  await expect.poll(async () => (await drawn(page)).pixels).toBe(2);
});

test("where frames take long a camera that moves sees coarser surfaces, and the picture that stands is what it was", async ({ page }) => {
  await slow(page, 20);
  const levels = await openFine(page);
  const before = await picture(page);
  const whole = await drawn(page);
  expect(whole).toMatchObject({ pixels: 2, level: 0 });
  await page.mouse.move(400, 300);
  await page.mouse.down();
  let coarsest = whole;
  for (let k = 0; k < 60 && (coarsest.level < levels - 1 || coarsest.pixels > 0.5); k++) {
    await page.mouse.move(400 + 3 * k, 300 + k);
    await page.evaluate(() => new Promise(requestAnimationFrame));
    coarsest = await drawn(page);
  }
  expect(coarsest.level).toBe(levels - 1);
  expect(coarsest.pixels).toBeLessThan(0.5);
  expect(coarsest.triangles).toBeLessThan(0.4 * whole.triangles);
  await page.mouse.up();
  await expect.poll(() => drawn(page)).toMatchObject({ pixels: 2, level: 0 });
  await page.keyboard.press("r");
  expect((await picture(page)).equals(before)).toBe(true);
});

test("every level looks like the whole, in every mode", async ({ page }) => {
  const levels = await openFine(page);
  /** The picture at a level in so many columns: channels of their mean colours. */
  const at = (level: number, columns: number) => page.evaluate(({ level, columns }) => {
    const { viewer } = (window as any).isolux;
    viewer.draw({ pixels: 1, level });
    const { width, height } = viewer.renderer.domElement;
    const rows = Math.round((columns * height) / width);
    const context = new OffscreenCanvas(columns, rows).getContext("2d")!;
    context.imageSmoothingQuality = "high";
    context.drawImage(viewer.renderer.domElement, 0, 0, columns, rows);
    return [...context.getImageData(0, 0, columns, rows).data];
  }, { level, columns });
  // Values of single elements are noisy, and fewer are seen: their means are alike.
  for (const [key, columns, most] of [["1", 320, 2], ["2", 320, 2], ["v", 20, 6], ["3", 20, 10]] as const) {
    await page.keyboard.press(key);
    const whole = await at(0, columns);
    for (let level = 1; level < levels; level++) {
      const coarse = await at(level, columns);
      const apart = whole.reduce((sum, v, k) => sum + Math.abs(v - coarse[k]!), 0) / (0.75 * whole.length);
      expect(apart, `${key} ${level}`).toBeLessThan(most);
    }
  }
});

test("what is picked is of the whole surfaces, whatever is drawn", async ({ page }) => {
  await openFine(page);
  const [whole, coarse] = await page.evaluate(() => {
    const { viewer } = (window as any).isolux;
    const points = [[300, 300], [500, 200], [700, 400], [400, 600], [600, 640]];
    const pick = () => points.map(([x, y]) => viewer.pick(x, y)?.element as number);
    viewer.draw();
    const whole = pick();
    viewer.draw({ pixels: 0.35, level: 9 });
    return [whole, pick()];
  });
  expect(whole!.every((element) => element >= 0)).toBe(true);
  expect(coarse).toEqual(whole);
});
