// A page under test: it fails if the page says anything to the console.

import { type Browser, expect, type Page, test as base } from "@playwright/test";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { file } from "./files";

export { expect };

export const test = base.extend({
  page: async ({ page }, use) => {
    const said: string[] = [];
    page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => said.push(error.message));
    page.on("request", (request) => {
      if (!/^(file|data|blob):|^http:\/\/(127\.0\.0\.1|localhost):/.test(request.url())) said.push(`it asked for ${request.url()}`);
    });
    await use(page);
    // A server that has gone away is expected to be missed.
    expect(said.filter((line) => !line.includes("ERR_CONNECTION_REFUSED"))).toEqual([]);
  },
});

/** Opens a page from a file, or from an address, and waits until it shows something. */
export async function open(page: Page, name: string): Promise<void> {
  await page.goto(name.startsWith("http") ? name : pathToFileURL(file(name)).href);
  await expect(page.locator("body.ready")).toBeVisible();
}

/** The picture as it is now, a PNG. */
export async function picture(page: Page): Promise<Buffer> {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  // Without what lies over it.
  const style = "#reading, #legend, #labels, #mark, .side-name, #divider, #live { visibility: hidden; }";
  return page.locator("#picture").screenshot({ style });
}

/** What the card says of a point: element, illuminance [lux], and its standard error. */
export async function read(page: Page, x: number, y: number): Promise<{ element: number; lux: number; error: number; text: string }> {
  await page.locator("#picture").click({ position: { x, y } });
  const card = page.locator("#reading");
  await expect(card).toBeVisible();
  const number = async (name: string) => Number(await card.getAttribute(`data-${name}`));
  return { element: await number("element"), lux: await number("lux"), error: await number("error"), text: await card.innerText() };
}

/** Mean absolute difference of the channels of two PNG files of the same size, in codes of 255. */
export async function difference(browser: Browser, a: Buffer, b: Buffer): Promise<number> {
  const page = await browser.newPage();
  const found = await page.evaluate(async (files) => {
    const pixels = async (base64: string) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes]));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d")!;
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height);
    };
    const [one, other] = await Promise.all(files.map(pixels));
    if (one!.width !== other!.width || one!.height !== other!.height) return NaN;
    const sum = one!.data.reduce((total, v, k) => total + Math.abs(v - other!.data[k]!), 0);
    return sum / (0.75 * one!.data.length);
  }, [a.toString("base64"), b.toString("base64")]);
  await page.close();
  return found;
}

export const bytes = (name: string) => readFileSync(file(name));
