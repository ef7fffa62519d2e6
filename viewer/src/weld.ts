// Which vertices belong together: those of a smooth surface, which triangles join, and those that lie at one point.

import { PIECE, type Pieces } from "./pieces";

/** No number. */
export const NONE = -1;

/** The smooth surface of every vertex: vertices that triangles join have the same number, that of one of them. */
export function* smoothSurfaces(vertices: number, indices: Uint32Array): Pieces<Uint32Array> {
  // A forest; the trees are kept flat by halving every way that is gone (Tarjan & van Leeuwen 1984).
  const above = Uint32Array.from({ length: vertices }, (_, v) => v);
  const root = (v: number) => {
    while (above[v] !== v) v = above[v] = above[above[v]!]!;
    return v;
  };
  for (let t = 0; t < indices.length; t += 3) {
    const a = root(indices[t]!);
    above[root(indices[t + 1]!)] = a;
    above[root(indices[t + 2]!)] = a;
    if (t % PIECE === 0) yield;
  }
  for (let v = 0; v < vertices; v++) above[v] = root(v);
  return above;
}

/** The point of every vertex: vertices at the same place have the same number, that of the first of them. */
export function* points(positions: Float32Array): Pieces<Uint32Array> {
  const pointOf = new Uint32Array(positions.length / 3);
  const size = 2 ** Math.ceil(Math.log2(2 * pointOf.length + 1));
  const table = new Int32Array(size).fill(NONE);
  const bits = new Int32Array(positions.buffer, positions.byteOffset, positions.length);
  for (let v = 0; v < pointOf.length; v++) {
    let at = hash(bits[3 * v]!, bits[3 * v + 1]!, bits[3 * v + 2]!) & (size - 1);
    while (table[at] !== NONE && !isSame(table[at]!, v)) at = (at + 1) & (size - 1);
    if (table[at] === NONE) table[at] = v;
    pointOf[v] = table[at]!;
    if (v % PIECE === 0) yield;
  }
  return pointOf;

  function isSame(v: number, w: number): boolean {
    return bits[3 * v] === bits[3 * w] && bits[3 * v + 1] === bits[3 * w + 1] && bits[3 * v + 2] === bits[3 * w + 2];
  }
}

/** 32 bits that look random, of three numbers. */
export function hash(x: number, y: number, z: number): number {
  let h = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca77) ^ Math.imul(z, 0xc2b2ae3d);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return h ^ (h >>> 15);
}
