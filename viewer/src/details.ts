// The triangles of surfaces at every level of detail, as they are drawn: their vertices' numbers, and chunks of them.

import { BufferAttribute } from "three";
import { Chunks } from "./chunks";
import { coarser, type Level } from "./levels";
import { finish, type Pieces } from "./pieces";
import type { Surfaces } from "./surfaces";

/** Cells of the coarsest level at most, in radii of the scene. */
const LARGEST = 0.25;

/** A level of detail. */
interface Detail {
  index: BufferAttribute;
  chunks: Chunks;
}

export class Details {
  /** From the finest, which has all triangles, to the coarsest that is known. */
  private readonly details: Detail[];

  /** Those of surfaces whose triangles have provoking vertices in `indices`. */
  constructor(private readonly surfaces: Surfaces, indices: Uint32Array) {
    const { positions, header: { batches } } = surfaces;
    const all = { batches, indices: surfaces.indices };
    this.details = [{ index: new BufferAttribute(indices, 1), chunks: finish(Chunks.of(positions, all)) }];
  }

  /** Number of the levels that are known. */
  get count(): number {
    return this.details.length;
  }

  /** The level of this number, or the coarsest. */
  level(number: number): Detail {
    return this.details[Math.min(number, this.details.length - 1)]!;
  }

  /** Finds the coarser levels, once; of the light at the vertices of the surfaces they show what is usual. */
  *find(lux: Float32Array): Pieces<void> {
    if (this.details.length > 1) return;
    const { positions, indices, header: { batches, bounds } } = this.surfaces;
    const add = function* (details: Detail[], level: Level): Pieces<void> {
      const chunks = yield* Chunks.of(positions, level);
      details.push({ index: new BufferAttribute(level.indices, 1), chunks });
    };
    for (const level of coarser(positions, { batches, indices }, lux, LARGEST * bounds.radius)) {
      if (level) yield* add(this.details, level);
      else yield;
    }
  }
}

/** How many triangles all of these have, level by level. */
export function triangles(all: Set<Details>): number[] {
  const levels = Math.max(...[...all].map(({ count }) => count));
  return Array.from({ length: levels }, (_, k) => [...all].reduce((sum, details) => sum + details.level(k).index.count / 3, 0));
}
