// Light groups and two solutions: what one reads is what isolux mix computes.

import { type Page } from "@playwright/test";
import { table } from "./files";
import { difference, expect, open, picture, read, test } from "./page";

const POINTS: [number, number][] = [[500, 700], [430, 480], [300, 430], [800, 650]];

/** Moves a slider, or chooses a colour, as a hand would. */
async function set(page: Page, selector: string, value: string): Promise<void> {
  await page.locator(selector).evaluate((input: HTMLInputElement, to) => {
    input.value = to;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
}

test("sliders do what isolux mix does", async ({ page, browser }) => {
  const rows = table("evening.csv");
  await open(page, "day.html");
  const day = await picture(page);
  await expect(page.locator(".group")).toHaveCount(3);
  await set(page, "#group-0", "0.5");
  await set(page, "#group-1", "1.5");
  await set(page, ".group:nth-child(2) input[type=color]", "#ff8040");
  expect(await difference(browser, await picture(page), day)).toBeGreaterThan(3);
  for (const [x, y] of POINTS) {
    const { element, lux, error } = await read(page, x, y);
    expect(lux / Number(rows[element]!.irradiance_luminance)).toBeCloseTo(1, 5);
    expect(error / Number(rows[element]!.std_error_luminance)).toBeCloseTo(1, 2);
  }
  await page.locator("#groups-reset").click();
  expect(await difference(browser, await picture(page), day)).toBeLessThan(0.05);
});

test("a room without groups has no sliders", async ({ page }) => {
  await open(page, "room.html");
  await expect(page.locator("#groups")).toBeHidden();
  await expect(page.locator("#compare")).toBeHidden();
});

test("two solutions are shown beside each other, and subtracted", async ({ page, browser }) => {
  const rows = table("evening.csv");
  await open(page, "compared.html");
  const both = await picture(page);
  await page.keyboard.press("x");
  const before = await picture(page);
  await page.keyboard.press("x");
  const after = await picture(page);
  for (const [one, other] of [[both, before], [both, after], [before, after]] as const) {
    expect(await difference(browser, one, other)).toBeGreaterThan(1);
  }
  const [x, y] = POINTS[0]!;
  const { element, lux, text } = await read(page, x, y);
  expect(lux / Number(rows[element]!.irradiance_luminance)).toBeCloseTo(1, 5);
  expect(text).toContain("Before");

  await page.keyboard.press("4");
  await expect(page.locator("#legend")).toHaveAttribute("aria-label", /^Difference \[lx\] from -/);
  const change = await picture(page);
  expect(await difference(browser, change, after)).toBeGreaterThan(3);
  await page.keyboard.press("v");
  expect(await difference(browser, await picture(page), change)).toBeGreaterThan(0.1);
});

test("the divider is dragged, and moved by keys", async ({ page }) => {
  await open(page, "compared.html");
  const divider = page.locator("#divider");
  await expect(divider).toHaveAttribute("aria-valuenow", "50");
  const box = (await divider.boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, 500);
  await page.mouse.down();
  await page.mouse.move(245, 500, { steps: 3 });
  await page.mouse.up();
  await expect(divider).toHaveAttribute("aria-valuenow", "25");
  await divider.press("ArrowRight");
  await expect(divider).toHaveAttribute("aria-valuenow", "27");
});

test("solutions with different elements are compared by eye only", async ({ page }) => {
  await open(page, "unlike.html");
  await expect(page.locator("#compare-note")).toBeVisible();
  await expect(page.locator("#mode-difference")).toBeHidden();
  await page.keyboard.press("4");
  await expect(page.locator("#mode-light")).toBeChecked();
  for (const x of [400, 600]) expect((await read(page, x, 500)).text).not.toContain("Difference");
});
