// The order in which triangles are drawn: those that face alike and lie near each other follow each other, so that many of them can be
// left out at once (chunks.ts).

import type { Batch } from "./surfaces";

/** Steps of the space-filling curve (Morton 1966) along each axis, as a power of two. */
const BITS = 9;
const STEPS = 1 << BITS;
/** More triangles than a batch has; with six directions and the curve a key is below 2^53. */
const MOST = 2 ** 23;

/** Numbers of all triangles, batch by batch. */
export function nearby(batches: Batch[], indices: Uint32Array, positions: Float32Array): Uint32Array {
  const order = new Uint32Array(indices.length / 3);
  for (const { first, count } of batches) {
    const keys = new Float64Array(count);
    const key = keyOf(indices.subarray(3 * first, 3 * (first + count)), positions);
    for (let t = 0; t < count; t++) keys[t] = key(t) * MOST + t;
    keys.sort().forEach((key, k) => (order[first + k] = first + (key % MOST)));
  }
  return order;
}

/** Which way a triangle faces, and where it lies on a curve through the box around all. */
function keyOf(indices: Uint32Array, positions: Float32Array): (t: number) => number {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const v of indices) {
    for (let c = 0; c < 3; c++) {
      low[c] = Math.min(low[c]!, positions[3 * v + c]!);
      high[c] = Math.max(high[c]!, positions[3 * v + c]!);
    }
  }
  const at = (t: number, k: number, c: number) => positions[3 * indices[3 * t + k]! + c]!;
  const step = (t: number, c: number) => {
    const middle = (at(t, 0, c) + at(t, 1, c) + at(t, 2, c)) / 3;
    return Math.min(STEPS - 1, Math.floor((STEPS * (middle - low[c]!)) / (high[c]! - low[c]! || 1)));
  };
  return (t) => direction([0, 1, 2].map((c) => cross(t, (c + 1) % 3, (c + 2) % 3))) * STEPS ** 3 + curve(step(t, 0), step(t, 1), step(t, 2));

  function cross(t: number, c: number, d: number): number {
    const [x, y] = [at(t, 0, c), at(t, 0, d)];
    return (at(t, 1, c) - x) * (at(t, 2, d) - y) - (at(t, 1, d) - y) * (at(t, 2, c) - x);
  }
}

/** The face of a cube to which a vector points. */
function direction(v: number[]): number {
  const sizes = v.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  return 2 * Math.max(axis, 0) + (v[axis]! < 0 ? 1 : 0);
}

/** Bits of three numbers in turn. */
function curve(x: number, y: number, z: number): number {
  let found = 0;
  for (let bit = BITS - 1; bit >= 0; bit--) found = 8 * found + 4 * ((x >> bit) & 1) + 2 * ((y >> bit) & 1) + ((z >> bit) & 1);
  return found;
}
