import { describe, expect, test } from "vitest";
import { luminance, type Rgb } from "../../src/colour";
import { Light, type LightHeader } from "../../src/light";
import type { Part } from "../../src/part";
import { studentsT } from "../../src/student";
import { significant, withMargin } from "../../src/numbers";

/** Student's t, two-sided 95 %, of 1 to 8 degrees of freedom (Abramowitz, Stegun 1964, table 26.10). */
const TABLE = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306];

/** Light of groups with one vertex and one element each: irradiance and standard error of the element, by channel. */
function light(groups: { factor: Rgb; value: Rgb; error: Rgb; freedom: number | null }[]): Light {
  const header = { groups: groups.map(({ factor, freedom }) => ({ name: "", factor, freedom })), students_t: TABLE };
  const floats = (name: string) => {
    const group = groups[Number(name.slice(-1))]!;
    return Float32Array.from(name.startsWith("std_error") ? group.error : group.value);
  };
  return new Light({ header, floats } as unknown as Part<LightHeader>);
}

describe("light", () => {
  test("of one group is that group, with Student's margin", () => {
    const reading = light([{ factor: [1, 1, 1], value: [3, 2, 1], error: [0.3, 0.2, 0.1], freedom: 7 }]).reading(0);
    expect(reading.irradiance).toEqual([3, 2, 1]);
    expect(reading.lux).toBeCloseTo(luminance(3, 2, 1), 6);
    expect(reading.margin).toBeCloseTo(2.365 * luminance(0.3, 0.2, 0.1), 6);
  });

  test("of groups adds up, errors in squares, as isolux mix has it", () => {
    const mixed = light([
      { factor: [0.5, 0, 2], value: [2, 1, 0], error: [0.3, 0.3, 0.3], freedom: 7 },
      { factor: [3, 3, 3], value: [1, 1, 1], error: [0.4, 0.4, 0.4], freedom: 7 },
    ]);
    const reading = mixed.reading(0);
    expect(reading.irradiance).toEqual([4, 3, 3]);
    expect([...mixed.atVertices()]).toEqual([4, 3, 3]);
    const error = luminance(Math.hypot(0.15, 1.2), 1.2, Math.hypot(0.6, 1.2));
    expect(reading.stdError).toBeCloseTo(error, 6);
    expect(mixed.errorsOnElements()[0]).toBeCloseTo(error, 6);
    expect(reading.margin / error).toBeGreaterThan(1.96);
    expect(reading.margin / error).toBeLessThan(2.365);
    expect(mixed.isAsSolved).toBe(true);
    mixed.factors[1] = [0, 0, 0];
    expect(mixed.isAsSolved).toBe(false);
    expect(mixed.reading(0).irradiance).toEqual([1, 0, 0]);
  });

  test("of a lamp that is off needs no error bar, and unknown errors stay unknown", () => {
    const known = { factor: [1, 1, 1] as Rgb, value: [1, 1, 1] as Rgb, error: [0.1, 0.1, 0.1] as Rgb, freedom: 7 };
    const unknown = { ...known, error: [NaN, NaN, NaN] as Rgb, freedom: null };
    expect(light([known, { ...unknown, factor: [0, 0, 0] }]).reading(0).margin).toBeCloseTo(0.2365, 5);
    expect(light([known, unknown]).reading(0).margin).toBeNaN();
  });
});

test("Student's t lies between its neighbours in the table", () => {
  expect(studentsT(TABLE, 7)).toBeCloseTo(2.365, 12);
  expect(studentsT(TABLE, 7.5)).toBeGreaterThan(2.306);
  expect(studentsT(TABLE, 7.5)).toBeLessThan(2.365);
  expect(studentsT(TABLE, 1e9)).toBeCloseTo(1.96, 3);
  expect(studentsT(TABLE, 30)).toBeCloseTo(2.042, 1);
  expect(studentsT(TABLE, NaN)).toBeNaN();
});

test("numbers are written as far as they are known", () => {
  expect(withMargin(262.04, 1.34)).toBe("262.0 ± 1.3");
  expect(withMargin(26204, 134)).toBe("26204 ± 134");
  expect(withMargin(0.01234, 0.00056)).toBe("0.01234 ± 0.00056");
  expect(withMargin(12.345678, NaN)).toBe("12.346");
  expect([significant(0, 3), significant(1234.5, 3), significant(0.00012345, 3), significant(NaN, 3)]).toEqual(["0", "1235", "0.000123", "?"]);
});
