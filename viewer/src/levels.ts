// Levels of detail: the same surfaces in ever fewer triangles, for cameras that move where all of them take too long (governor.ts).
//
// Vertices are clustered in cells that are twice as long from level to level, and become one of them: so light, colours and numbers of elements
// are those that a vertex has, and levels need no vertices of their own. It is points that are clustered, with all surfaces that meet there: both
// sides of a crease stay together, and no cracks open. Creases, borders and corners stay, for points inside a surface do not become points of them.

import { cluster } from "./clusters";
import { PIECE, type Pieces } from "./pieces";
import { NONE } from "./weld";
import { Wedges } from "./wedges";

/** So many triangles are few enough. */
const FEWEST = 12_000;
/** Triangles of a level, at most, as a share of those of the one before. */
const WORTH = 0.5;
/** Cells of the first level, in lengths of an edge. */
const FIRST = 2;

/** Triangles, three vertices each, and how many of them each batch has. */
export interface Level {
  batches: { first: number; count: number }[];
  indices: Uint32Array;
}

/** Ever coarser levels of triangles, as they are found; none has cells larger than `largest`. */
export function* coarser(positions: Float32Array, finest: Level, lux: Float32Array, largest: number): Pieces<void, Level> {
  if (finest.indices.length / 3 <= FEWEST) return;
  const wedges = yield* Wedges.of(positions, finest.indices);
  const becomes = new Uint32Array(positions.length / 3);
  let level = finest;
  let points: Uint32Array = wedges.pointOf.filter((p, v) => p === v);
  const edge = yield* meanEdge(positions, finest.indices);
  for (let size = FIRST * edge; size < largest && level.indices.length / 3 > FEWEST; size *= 2) {
    const stay = yield* cluster(points, positions, lux, wedges, size, becomes);
    const next = yield* moved(positions, level, wedges, becomes);
    if (next.indices.length > WORTH * level.indices.length) continue;
    [level, points] = [next, stay];
    yield level;
  }
}

/**
 * The triangles of `level` whose corners are three points still, after each has become what it `becomes`. Those that have turned over are left out:
 * they lie on others, and belong to the other side.
 */
function* moved(positions: Float32Array, level: Level, wedges: Wedges, becomes: Uint32Array): Pieces<Level> {
  const { wedgeOf, pointOf } = wedges;
  const known = new Int32Array(wedgeOf.length).fill(NONE);
  const vertex = (v: number) => {
    const w = wedgeOf[v]!;
    if (known[w] === NONE) known[w] = wedges.counterpart(w, becomes[pointOf[w]!]!);
    return known[w]!;
  };
  const indices = new Uint32Array(level.indices.length);
  const batches: Level["batches"] = [];
  let corners = 0;
  for (const { first, count } of level.batches) {
    const begin = corners;
    for (let t = first; t < first + count; t++) {
      for (let k = 0; k < 3; k++) indices[corners + k] = vertex(level.indices[3 * t + k]!);
      const [p, q, r] = [0, 1, 2].map((k) => pointOf[indices[corners + k]!]!);
      if (p !== q && q !== r && r !== p && !areOpposite(cross(positions, indices, corners), cross(positions, level.indices, 3 * t))) corners += 3;
      if (t % PIECE === 0) yield;
    }
    batches.push({ first: begin / 3, count: (corners - begin) / 3 });
  }
  return { batches, indices: indices.slice(0, corners) };
}

/** The legs of a triangle of mean area whose legs are as long as each other. */
function* meanEdge(positions: Float32Array, indices: Uint32Array): Pieces<number> {
  let area = 0;
  for (let k = 0; k < indices.length; k += 3) {
    const [x, y, z] = cross(positions, indices, k);
    area += Math.sqrt(x * x + y * y + z * z);
    if (k % PIECE === 0) yield;
  }
  return Math.sqrt(area / (indices.length / 3));
}

type Vector = [number, number, number];

/** The normal of the triangle whose corners begin at `k`, twice as long as its area. */
function cross(positions: Float32Array, indices: Uint32Array, k: number): Vector {
  const [a, b, c] = [3 * indices[k]!, 3 * indices[k + 1]!, 3 * indices[k + 2]!];
  const way = (to: number, i: number) => positions[to + i]! - positions[a + i]!;
  const minor = (i: number, j: number) => way(b, i) * way(c, j) - way(b, j) * way(c, i);
  return [minor(1, 2), minor(2, 0), minor(0, 1)];
}

const product = (v: Vector, w: Vector) => v[0] * w[0] + v[1] * w[1] + v[2] * w[2];

/** Whether there are more than 120 degrees between two vectors. */
const areOpposite = (v: Vector, w: Vector) => product(v, w) < -0.5 * Math.sqrt(product(v, v) * product(w, w));
