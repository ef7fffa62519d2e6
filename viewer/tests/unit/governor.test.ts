import { expect, test } from "vitest";
import { steps } from "../../src/drafts";
import { Governor } from "../../src/governor";

/** Milliseconds of a frame on a screen of 60 Hz, whose steps take so long. */
const onScreen = (ms: number) => Math.ceil(ms / 16.7) * 16.7;

/** The steps of so many frames on a machine whose steps take so many milliseconds; times arrive two frames late. */
function drive(governor: Governor, cost: number[], frames: number): number[] {
  const found: number[] = [];
  for (let k = 0; k < frames; k++) {
    found.push(governor.step);
    governor.took(onScreen(cost[found[Math.max(0, k - 2)]!]!));
  }
  return found;
}

const changes = (found: number[]) => found.filter((step, k) => k > 0 && step !== found[k - 1]).length;

test("a machine that holds 30 frames a second draws the whole picture", () => {
  for (const ms of [1, 8, 16, 33]) expect(drive(new Governor(8), Array(8).fill(ms), 5000).every((step) => step === 0)).toBe(true);
});

test("a frame that takes long now and then is no reason", () => {
  const governor = new Governor(8);
  for (let k = 0; k < 1000; k++) {
    governor.took(k % 10 === 0 ? 300 : 16.7);
    expect(governor.step).toBe(0);
  }
});

test("a slow machine soon draws what it can", () => {
  const cost = [400, 200, 100, 50, 25, 20, 18];
  const found = drive(new Governor(7), cost, 2000);
  expect(found.findIndex((step) => step >= 3)).toBeLessThan(8);
  // Most frames are in time.
  expect(found.filter((step) => cost[step]! <= 33).length).toBeGreaterThan(0.95 * found.length);
});

test("it does not flicker between two steps", () => {
  // The finer step is too slow, the coarser one leaves room.
  const found = drive(new Governor(4), [60, 50, 15, 10], 20_000);
  expect(changes(found)).toBeLessThan(40);
  // The longer it has been in vain, the rarer it is tried.
  expect(changes(found.slice(10_000))).toBeLessThan(changes(found.slice(0, 10_000)));
});

test("where there is room again, it draws more again", () => {
  const governor = new Governor(6);
  drive(governor, [400, 200, 100, 50, 25, 20], 500);
  expect(governor.step).toBeGreaterThanOrEqual(4);
  drive(governor, Array(6).fill(10), 5000);
  expect(governor.step).toBe(0);
});

test("the last step is the last", () => {
  expect(drive(new Governor(3), [900, 900, 900], 1000).at(-1)).toBe(2);
});

test("frames that were on their way before a pause do not count", () => {
  const governor = new Governor(4);
  for (let k = 0; k < 100; k++) {
    governor.pause();
    governor.took(900);
    governor.took(900);
    governor.took(16.7);
  }
  expect(governor.step).toBe(0);
});

test("steps begin with the whole picture, and take pixels and triangles in turns", () => {
  const triangles = [1_600_000, 400_000, 100_000, 25_000];
  const found = steps(2, 1280 * 720, triangles);
  expect(found[0]).toEqual({ pixels: 2, level: 0 });
  for (const [k, { pixels, level }] of found.entries()) {
    if (k === 0) continue;
    const before = found[k - 1]!;
    expect([pixels / before.pixels, level - before.level].map((v) => v.toFixed(3))).toEqual(level > before.level ? ["1.000", "1.000"] : ["0.707", "0.000"]);
  }
  expect(found.at(-1)!.level).toBe(3);
  expect(found.at(-1)!.pixels).toBeGreaterThan(0.3);
  expect(found.at(-1)!.pixels).toBeLessThan(0.5);
  // Without levels there are pixels still.
  expect(steps(1, 1280 * 720, [5000]).map(({ pixels }) => pixels.toFixed(2))).toEqual(["1.00", "0.71", "0.50", "0.35"]);
});
