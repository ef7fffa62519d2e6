// False colours: which value gets which colour, and where the isolux lines run.

import { interpolateMagma, interpolatePuOr, interpolateViridis } from "d3-scale-chromatic";

/** From where to where, and how between. */
export interface Scale {
  low: number;
  high: number;
  logarithmic: boolean;
}

/** Colours that change evenly to the eye: of illuminance, of errors, and of differences, whose middle is nothing. */
export const PALETTES = {
  illuminance: interpolateViridis,
  error: interpolateMagma,
  difference: (t: number) => interpolatePuOr(1 - t),
};

export type PaletteName = keyof typeof PALETTES;

/** More lines than this do not help. */
export const MOST_LEVELS = 24;

/** Place of `value` on the scale: 0 at its low end, 1 at its high end. */
export function position({ low, high, logarithmic }: Scale, value: number): number {
  if (!logarithmic) return (value - low) / (high - low);
  return Math.log(Math.max(value, 1e-30) / low) / Math.log(high / low);
}

/** Round values on the scale, rising: 1, 2, 5, 10 ... on a logarithmic one, at equal distances on a linear one. */
export function levels({ low, high, logarithmic }: Scale): number[] {
  const found: number[] = [];
  if (!logarithmic) {
    const step = roundStep((high - low) / 11);
    for (let k = Math.ceil(low / step - 1e-6); k * step <= high * (1 + 1e-9) + step * 1e-6; k++) found.push(tidy(k * step));
    return found.slice(0, MOST_LEVELS);
  }
  const decades = Math.log10(high / low);
  const factors = decades > 7 ? [1] : decades > 4 ? [1, 3] : [1, 2, 5];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high) + 1; decade++) {
    for (const factor of factors) {
      const value = tidy(factor * 10 ** decade);
      if (value >= low * (1 - 1e-6) && value <= high * (1 + 1e-6)) found.push(value);
    }
  }
  return found.slice(-MOST_LEVELS);
}

/** 1, 2 or 5 times a power of ten, at least `least`. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return tidy(power * ([1, 2, 5].find((factor) => factor * power >= least * (1 - 1e-9)) ?? 10));
}

/** A round number that is at least `least`, and not much more. */
function roundUp(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return tidy(power * ([1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8].find((factor) => factor * power >= least * (1 - 1e-9)) ?? 10));
}

/** Without the dust of binary fractions. */
function tidy(value: number): number {
  return Number(value.toPrecision(9));
}

/**
 * A scale for `values` that count as much as `weights`: its ends are round, and leave out a twentieth below and
 * three hundredths above: lamps and window frames are not what the others are seen for. A logarithmic one has at most three decades.
 */
export function automatic(values: Float32Array, weights: Float32Array, logarithmic: boolean): Scale {
  const [bottom, top] = quantiles(values, weights, [0.05, 0.97]);
  if (!(top! > 0)) return { low: logarithmic ? 0.1 : 0, high: 1, logarithmic };
  const high = roundUp(top!);
  if (!logarithmic) return { low: 0, high, logarithmic };
  const low = Math.max(bottom!, high / 1000);
  const power = 10 ** Math.floor(Math.log10(low));
  const round = [5, 2, 1].find((factor) => factor * power <= low * (1 + 1e-9)) ?? 1;
  return { low: tidy(Math.min(round * power, high / 2)), high, logarithmic };
}

/** A scale that is as wide to either side of nothing. */
export function symmetric(values: Float32Array, weights: Float32Array): Scale {
  const [top] = quantiles(values.map(Math.abs), weights, [0.97]);
  const high = top! > 0 ? roundUp(top!) : 1;
  return { low: -high, high, logarithmic: false };
}

/** Values below which these `shares` of the weight are; values that are no numbers do not count. */
function quantiles(values: Float32Array, weights: Float32Array, shares: number[]): number[] {
  // A sample is enough of many.
  const stride = Math.ceil(values.length / 100_000);
  const sample: [number, number][] = [];
  for (let k = 0; k < values.length; k += stride) {
    if (Number.isFinite(values[k]!)) sample.push([values[k]!, weights[k]!]);
  }
  sample.sort((a, b) => a[0] - b[0]);
  const all = sample.reduce((sum, [, weight]) => sum + weight, 0);
  return shares.map((share) => {
    let below = 0;
    const found = sample.find(([, weight]) => (below += weight) >= share * all);
    return found?.[0] ?? 0;
  });
}

/** Texels of a palette, red green blue alpha, sRGB, from its low end. */
export function texels(palette: PaletteName, count: number): Uint8Array<ArrayBuffer> {
  const found = new Uint8Array(4 * count);
  for (let k = 0; k < count; k++) found.set([...rgb(PALETTES[palette](k / (count - 1))), 255], 4 * k);
  return found;
}

/** Channels of `#rrggbb` or `rgb(r, g, b)`. */
function rgb(text: string): number[] {
  if (text.startsWith("#")) return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
  return text.match(/\d+/g)!.slice(0, 3).map(Number);
}
