import { describe, expect, test } from "vitest";
import { automatic, levels, position, symmetric, texels } from "../../src/scale";

const linear = { low: 0, high: 2000, logarithmic: false };
const logarithmic = { low: 2, high: 2000, logarithmic: true };

describe("a scale", () => {
  test("runs from 0 to 1", () => {
    expect([0, 500, 2000].map((v) => position(linear, v))).toEqual([0, 0.25, 1]);
    const thirds = [2, 20, 200, 2000].map((v) => position(logarithmic, v));
    thirds.forEach((t, k) => expect(t).toBeCloseTo(k / 3, 12));
    expect(position(logarithmic, 0)).toBeLessThan(0);
  });

  test("has round levels", () => {
    expect(levels(linear)).toEqual([0, 200, 400, 600, 800, 1000, 1200, 1400, 1600, 1800, 2000]);
    expect(levels({ ...linear, low: -0.3, high: 0.3 })).toEqual([-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3]);
    expect(levels(logarithmic)).toEqual([2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000]);
    expect(levels({ low: 0.15, high: 4.9, logarithmic: true })).toEqual([0.2, 0.5, 1, 2]);
    expect(levels({ low: 1e-4, high: 1e4, logarithmic: true })).toHaveLength(9);
  });

  test("suits the values and how much they weigh", () => {
    const values = Float32Array.from({ length: 1000 }, (_, k) => k);
    const even = new Float32Array(1000).fill(1);
    expect(automatic(values, even, false)).toEqual({ low: 0, high: 1000, logarithmic: false });
    expect(automatic(values, even, true)).toEqual({ low: 20, high: 1000, logarithmic: true });
    const dark = even.map((_, k) => (k < 50 ? 1e6 : 1));
    expect(automatic(values, dark, false).high).toBe(50);
    expect(automatic(new Float32Array(5), even, true).low).toBeGreaterThan(0);
    expect(automatic(values.map((v) => (v > 510 ? NaN : v)), even, false).high).toBe(500);
    expect(symmetric(values.map((v) => v - 700), even)).toEqual({ low: -800, high: 800, logarithmic: false });
  });
});

test("palettes have a colour for each place, and a middle", () => {
  const row = texels("difference", 256);
  const middle = [...row.subarray(4 * 128, 4 * 128 + 3)];
  expect(Math.min(...middle)).toBeGreaterThan(220);
  const viridis = texels("illuminance", 256);
  expect([...viridis.subarray(0, 4)]).toEqual([0x44, 0x01, 0x54, 255]);
  expect([...viridis.subarray(4 * 255)]).toEqual([0xfd, 0xe7, 0x25, 255]);
});
