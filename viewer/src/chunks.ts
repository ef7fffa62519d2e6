// Chunks: runs of neighbouring triangles of a batch. Those that lie beside the picture, or turn their backs to it, are not drawn.
//
// Elements are numbered along a space-filling curve, so triangles that follow each other lie near each other.

import { Box3, Frustum, Matrix4, type PerspectiveCamera, Vector3 } from "three";
import type { Level } from "./levels";
import type { Pieces } from "./pieces";

/** Triangles of a chunk at most: few, so that little is drawn in vain, and enough to leave the processor little to do. */
const MOST = 512;

/** Triangles to draw in one go, as three.js says it: corners, and the number of the batch. */
export interface Run {
  start: number;
  count: number;
  materialIndex: number;
}

interface Chunk extends Run {
  box: Box3;
  behind: Cone | undefined;
}

/** Points that see nothing but backs: those in directions from `apex` whose angle with `axis` has a cosine of `cosine` at least. */
interface Cone {
  apex: Vector3;
  axis: Vector3;
  cosine: number;
}

export class Chunks {
  private readonly chunks: Chunk[] = [];

  private constructor() {}

  /** Those of the triangles of a level. */
  static *of(positions: Float32Array, { batches, indices }: Level): Pieces<Chunks> {
    const found = new Chunks();
    for (const [materialIndex, { first, count }] of batches.entries()) {
      for (let t = first; t < first + count; t += MOST) {
        const corners = cornersOf(positions, indices, t, Math.min(MOST, first + count - t));
        const box = new Box3().setFromArray(corners);
        found.chunks.push({ start: 3 * t, count: corners.length / 3, materialIndex, box, behind: behind(corners, box) });
        yield;
      }
    }
    return found;
  }

  /** What `camera` may see; chunks that follow each other are one run. */
  seenBy(camera: PerspectiveCamera): Run[] {
    camera.updateMatrixWorld();
    const frustum = new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const runs: Run[] = [];
    for (const { start, count, materialIndex, box, behind } of this.chunks) {
      if (!frustum.intersectsBox(box) || (behind && isIn(behind, eye))) continue;
      const last = runs.at(-1);
      if (last && last.start + last.count === start && last.materialIndex === materialIndex) last.count += count;
      else runs.push({ start, count, materialIndex });
    }
    return runs;
  }
}

/** Positions of the corners of some triangles. */
function cornersOf(positions: Float32Array, indices: Uint32Array, first: number, count: number): Float32Array {
  const corners = new Float32Array(9 * count);
  for (let k = 0; k < 3 * count; k++) {
    const from = 3 * indices[3 * first + k]!;
    for (let c = 0; c < 3; c++) corners[3 * k + c] = positions[from + c]!;
  }
  return corners;
}

/** Where all of these triangles are seen from behind, if that is so anywhere. */
function behind(corners: Float32Array, box: Box3): Cone | undefined {
  const planes: { point: Vector3; normal: Vector3 }[] = [];
  const axis = new Vector3();
  for (let k = 0; k < corners.length; k += 9) {
    const [point, b, c] = [0, 3, 6].map((corner) => new Vector3().fromArray(corners, k + corner)) as [Vector3, Vector3, Vector3];
    const normal = b.sub(point).cross(c.sub(point)).normalize();
    // What has no area is not seen.
    if (normal.lengthSq() === 0) continue;
    planes.push({ point, normal });
    axis.sub(normal);
  }
  axis.normalize();
  // How far normals are from being opposite to the axis.
  const least = planes.reduce((least, { normal }) => Math.min(least, -normal.dot(axis)), 1);
  if (planes.length === 0 || least <= 0) return undefined;
  // Along the axis until all planes are passed.
  const apex = box.getCenter(new Vector3());
  const way = planes.map(({ point, normal }) => point.clone().sub(apex).dot(normal) / normal.dot(axis));
  apex.addScaledVector(axis, way.reduce((most, w) => Math.max(most, w)));
  return { apex, axis, cosine: Math.sqrt(1 - least * least) };
}

function isIn({ apex, axis, cosine }: Cone, point: Vector3): boolean {
  const way = point.clone().sub(apex);
  return way.dot(axis) > cosine * way.length();
}
