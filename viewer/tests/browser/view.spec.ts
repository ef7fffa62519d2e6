// One solution: what is seen and read is what was computed.

import { readFileSync, writeFileSync } from "node:fs";
import { file, table } from "./files";
import { bytes, difference, expect, open, picture, read, test } from "./page";

/** Points all over the Cornell box. */
const POINTS: [number, number][] = [[200, 300], [500, 200], [700, 400], [400, 600], [600, 640], [490, 110], [300, 720], [520, 500],
  [450, 150], [620, 250], [640, 560], [350, 450]];

test("what is read is what the table says", async ({ page }) => {
  const rows = table("room.csv");
  await open(page, "room.html");
  const elements = new Set<number>();
  let nearestCount = 0;
  for (const [x, y] of POINTS) {
    const { element, lux, error, text } = await read(page, x, y);
    const row = rows[element]!;
    elements.add(element);
    expect(Number(row.element)).toBe(element);
    expect(lux / Number(row.irradiance_luminance)).toBeCloseTo(1, 5);
    expect(error / Number(row.std_error_luminance)).toBeCloseTo(1, 2);
    expect(text).toContain(row.object);
    const clicked = await page.evaluate(() => (window as any).isolux.reading.picked.position.toArray() as number[]);
    const far = (row: Record<string, string>) => Math.hypot(...["x", "y", "z"].map((axis, k) => Number(row[axis]) - clicked[k]!));
    expect(far(row)).toBeLessThan(1.2 * Math.sqrt(Number(row.area)) + 0.01);
    const nearest = rows.filter(({ object }) => object === row.object).reduce((best, other) => (far(other) < far(best) ? other : best));
    if (nearest === row) nearestCount++;
  }
  expect(elements.size).toBe(POINTS.length);
  // The middle of the element that was clicked is the nearest one, but for points close to an edge, which may be nearer to a neighbour's.
  expect(nearestCount).toBeGreaterThanOrEqual(0.5 * POINTS.length);
});

test("nothing is read where nothing is", async ({ page }) => {
  await open(page, "room.html");
  await page.locator("#picture").click({ position: { x: 5, y: 5 } });
  await expect(page.locator("#reading")).toBeHidden();
});

test("it looks like the picture of the engine", async ({ page, browser }) => {
  await page.setViewportSize({ width: 940, height: 640 });
  await open(page, "room.html");
  expect(await difference(browser, await picture(page), bytes("room.png"))).toBeLessThan(1.5);
  await page.keyboard.press("]");
  expect(await difference(browser, await picture(page), bytes("room.png"))).toBeGreaterThan(5);
});

test("every mode shows something else, and has its legend", async ({ page, browser }) => {
  await open(page, "room.html");
  const legend = page.locator("#legend");
  await expect(legend).toBeHidden();
  const seen = [await picture(page)];
  const press = async (key: string) => {
    await page.keyboard.press(key);
    const now = await picture(page);
    for (const before of seen) expect(await difference(browser, now, before), `after ${key}`).toBeGreaterThan(0.05);
    seen.push(now);
  };
  await press("i");
  await expect(legend).toHaveAttribute("aria-label", /^Illuminance \[lx\]/);
  await press("m");
  await press("2");
  await press("k");
  await press("v");
  await press("3");
  await expect(legend).toHaveAttribute("aria-label", /^Std. error \[%\]/);
  await page.getByText("lux", { exact: true }).click();
  await expect(legend).toHaveAttribute("aria-label", /^Std. error \[lx\]/);
});

test("the ends of the scale can be written, and nonsense is put right", async ({ page, browser }) => {
  await open(page, "room.html");
  await page.keyboard.press("2");
  const automatic = await picture(page);
  const [low, high] = [page.locator("#low"), page.locator("#high")];
  const before = await high.inputValue();
  await high.fill("0.5");
  await high.press("Enter");
  await expect(page.locator("#legend")).toHaveAttribute("aria-label", /to 0.5$/);
  expect(await difference(browser, await picture(page), automatic)).toBeGreaterThan(5);
  await low.fill("7");
  await low.press("Enter");
  await low.blur();
  await expect(low).toHaveValue("0");
  await page.locator("#range-auto").click();
  await expect(high).toHaveValue(before);
});

test("one can move, and go back", async ({ page, browser }) => {
  await open(page, "room.html");
  const first = await picture(page);
  const differs = async (what: string) => expect(await difference(browser, await picture(page), first), what).toBeGreaterThan(1);
  await page.mouse.move(500, 400);
  await page.mouse.down();
  await page.mouse.move(560, 380, { steps: 4 });
  await page.mouse.up();
  await differs("orbit");
  await expect(page.locator("#reading")).toBeHidden();
  await page.keyboard.press("r");
  expect(await difference(browser, await picture(page), first)).toBeLessThan(0.2);
  await page.keyboard.press("o");
  await expect(page.locator("#walk")).toBeChecked();
  await page.keyboard.down("w");
  await page.waitForTimeout(700);
  await page.keyboard.up("w");
  await differs("walk");
  await page.selectOption("#camera", { label: "Overview" });
  await differs("overview");
});

test("a screenshot is offered as a file", async ({ page, browser }) => {
  await open(page, "room.html");
  const download = page.waitForEvent("download");
  await page.locator("#screenshot").click();
  const saved = await download;
  expect(saved.suggestedFilename()).toBe("cornell-box.png");
  const content = readFileSync(await saved.path());
  expect(await difference(browser, content, await picture(page))).toBeLessThan(0.5);
});

test("help, keys and the fold work by keyboard", async ({ page }) => {
  await open(page, "room.html");
  await page.keyboard.press("?");
  await expect(page.locator("#help")).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(page.locator("#help")).toBeHidden();
  await page.keyboard.press("h");
  await expect(page.locator("#controls")).toBeHidden();
  await page.keyboard.press("h");
  await expect(page.locator("#controls")).toBeVisible();
});

test("on a phone the controls are a sheet, and fingers do what the mouse does", async ({ browser }) => {
  const context = await browser.newContext({ viewport: { width: 390, height: 780 }, hasTouch: true, deviceScaleFactor: 2 });
  const page = await context.newPage();
  await open(page, "room.html");
  await expect(page.locator("#controls")).toBeHidden();
  await page.locator("#picture").tap({ position: { x: 195, y: 300 } });
  await expect(page.locator("#reading")).toBeVisible();
  await page.locator("#panel-toggle").tap();
  await expect(page.locator("#controls")).toBeVisible();
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(wide).toBe(390);
  await context.close();
});

test("few draw calls show it all, and none while nothing changes", async ({ page }) => {
  await open(page, "room.html");
  const work = () => page.evaluate(() => (window as unknown as { isolux: { viewer: { work: { calls: number; pictures: number } } } }).isolux.viewer.work);
  await picture(page);
  const before = await work();
  expect(before.calls).toBeLessThan(6);
  await page.waitForTimeout(500);
  expect((await work()).pictures).toBe(before.pictures);
});

test("a damaged page says so", async ({ browser }) => {
  const whole = readFileSync(file("room.html"), "latin1");
  const at = whole.indexOf('id="light">') + 5000;
  const swapped = whole[at] === "A" ? "B" : "A";
  writeFileSync(file("damaged.html"), whole.slice(0, at) + swapped + whole.slice(at + 1), "latin1");
  writeFileSync(file("empty.html"), whole.replace(/<script type="application\/json"[^]*?<\/script>/, ""), "latin1");
  for (const name of ["damaged.html", "empty.html"]) {
    const page = await browser.newPage();
    await page.goto(`file://${file(name)}`);
    await expect(page.locator("#message")).toContainText("damaged");
    await expect(page.locator("#message")).toContainText("isolux view");
    await page.close();
  }
});

test("a browser without WebGL 2 gets advice", async ({ browser }) => {
  const page = await browser.newPage();
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await page.goto(`file://${file("room.html")}`);
  await expect(page.locator("#message")).toContainText("WebGL 2");
  await page.close();
});

test("isolux lines bear their values", async ({ page }) => {
  await open(page, "room.html");
  /** Labels: their values, what is interpolated there, and where they are, once the camera stands. */
  const labels = async () => {
    await page.waitForTimeout(1500);
    return page.evaluate(() => {
      const { viewer, labels } = (window as any).isolux;
      const { clientWidth: width, clientHeight: height } = viewer.renderer.domElement;
      return labels.found.map(({ lux, position }: any) => {
        const { x, y } = position.clone().project(viewer.camera.camera);
        const at = [(0.5 + 0.5 * x) * width, (0.5 - 0.5 * y) * height];
        const [r, g, b] = viewer.pick(...at).irradiance;
        return { lux, there: 0.2126 * r + 0.7152 * g + 0.0722 * b, at };
      }) as { lux: number; there: number; at: [number, number] }[];
    });
  };
  const written = () => page.evaluate(() => (window as any).isolux.labels.canvas.toDataURL() as string);
  expect(await labels()).toEqual([]);
  const blank = await written();
  await page.keyboard.press("i");
  const first = await labels();
  expect(first.length).toBeGreaterThan(5);
  const levels = await page.evaluate(() => (window as any).isolux.viewer.lines as number[]);
  const step = levels[1]! - levels[0]!;
  for (const [k, { lux, there, at }] of first.entries()) {
    expect(levels).toContain(lux);
    expect(Math.abs(there - lux)).toBeLessThan(0.3 * step);
    for (const other of first.slice(0, k)) expect(Math.hypot(at[0] - other.at[0], at[1] - other.at[1])).toBeGreaterThan(50);
  }
  expect(await written()).not.toBe(blank);

  // They go with the camera, and are sought anew where it stands.
  await page.mouse.move(400, 300);
  await page.mouse.down();
  await page.mouse.move(480, 320, { steps: 4 });
  await page.mouse.up();
  const second = await labels();
  expect(second.length).toBeGreaterThan(5);
  expect(second.map(({ at }) => at)).not.toEqual(first.map(({ at }) => at));
  for (const { lux, there } of second) expect(Math.abs(there - lux)).toBeLessThan(0.3 * step);

  await page.keyboard.press("i");
  expect(await labels()).toEqual([]);
  expect(await written()).toBe(blank);
});
