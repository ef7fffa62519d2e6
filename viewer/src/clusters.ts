// Clusters: points that lie in one cell of a grid and can become one of them (Rossignac & Borrel 1993).

import { PIECE, type Pieces } from "./pieces";
import { hash, NONE } from "./weld";
import type { Wedges } from "./wedges";

/** How far a point may stray from its surface when it becomes another, in cells. */
const STRAY = 0.15;
/** Where the grid begins, in cells: so that walls and floors, which lie at round numbers, are on no face of a cell. */
const ORIGIN = [0.31, 0.41, 0.27] as const;

/**
 * Clusters `points` in cells of `size`, and writes into `becomes` which point each becomes: one that is near the middle of the cell, and
 * about as bright as the cluster, of which `lux` tells. Returns the points that stay.
 */
export function* cluster(
  points: Uint32Array,
  positions: Float32Array,
  lux: Float32Array,
  wedges: Wedges,
  size: number,
  becomes: Uint32Array,
): Pieces<Uint32Array> {
  const stray = STRAY * size;
  const step = (p: number, c: number) => positions[3 * p + c]! / size + ORIGIN[c]!;
  const cell = (p: number, c: number) => Math.floor(step(p, c));
  const buckets = new Int32Array(2 ** Math.ceil(Math.log2(points.length + 1))).fill(NONE);
  // Of every cluster: its first point, and the next cluster in its bucket; how many points it has, and the sum of their light.
  const first: number[] = [], next: number[] = [], count: number[] = [], light: number[] = [];
  const clusterOf = new Uint32Array(points.length);
  // Points of creases and borders come first: those inside a surface can become one of them, but not the other way round.
  for (const isInside of [false, true]) {
    for (let n = 0; n < points.length; n++) {
      if (n % PIECE === 0) yield;
      const p = points[n]!;
      if (wedges.isInside(p) !== isInside) continue;
      const [x, y, z] = [cell(p, 0), cell(p, 1), cell(p, 2)];
      const bucket = hash(x, y, z) & (buckets.length - 1);
      const isHere = (q: number) => cell(q, 0) === x && cell(q, 1) === y && cell(q, 2) === z && wedges.canBecome(p, q, stray);
      let k = buckets[bucket]!;
      while (k !== NONE && !isHere(first[k]!)) k = next[k]!;
      if (k === NONE) {
        k = first.push(p) - 1;
        next.push(buckets[bucket]!);
        count.push(0);
        light.push(0);
        buckets[bucket] = k;
      }
      clusterOf[n] = k;
      count[k]!++;
      light[k]! += lux[p]!;
    }
  }

  const chosen = Uint32Array.from(first);
  const least = new Float32Array(first.length).fill(Infinity);
  for (let n = 0; n < points.length; n++) {
    if (n % PIECE === 0) yield;
    const p = points[n]!, k = clusterOf[n]!;
    const far = [0, 1, 2].reduce((sum, c) => sum + (step(p, c) - cell(p, c) - 0.5) ** 2, 0);
    const unlike = Math.log((lux[p]! * count[k]! + 1e-6) / (light[k]! + 1e-6)) ** 2;
    if (far + unlike < least[k]! && wedges.canBecome(first[k]!, p, stray)) [chosen[k], least[k]] = [p, far + unlike];
  }
  for (let n = 0; n < points.length; n++) becomes[points[n]!] = chosen[clusterOf[n]!]!;
  return chosen;
}
