// Wedges: what a smooth surface has of a point (Hoppe 1998). Inside a surface a point has one; at creases, at seams of textures and where
// objects touch it has several, each with light of its own.
//
// A wedge faces along its normal. Where its surface ends it has a rim, too: the direction in which the end runs on, with the surface on the left.

import { PIECE, type Pieces } from "./pieces";
import { NONE, points, smoothSurfaces } from "./weld";

/** How far apart directions that are alike may be, squared: 45 degrees. */
const ALIKE = 0.59;
/** A surface ends at a point if the edges about it leave open as much as this, in the root of twice the area between them. */
const GAP = 0.05;

export class Wedges {
  /** Point and wedge of every vertex: the number of the first vertex there. So a point has the number of its first wedge. */
  readonly pointOf: Uint32Array;
  readonly wedgeOf: Uint32Array;
  /** After every wedge the next one of its point, or NONE. */
  private readonly next: Int32Array;
  /** Unit vectors of every wedge; a rim is 0 inside a surface. */
  private readonly rims: Float32Array;

  private constructor(private readonly positions: Float32Array, private readonly surfaceOf: Uint32Array, pointOf: Uint32Array, private readonly normals: Float32Array) {
    this.pointOf = pointOf;
    this.wedgeOf = new Uint32Array(pointOf.length);
    this.next = new Int32Array(pointOf.length).fill(NONE);
    this.rims = new Float32Array(normals.length);
  }

  /** Finds those of triangles. */
  static *of(positions: Float32Array, indices: Uint32Array): Pieces<Wedges> {
    const surfaceOf = yield* smoothSurfaces(positions.length / 3, indices);
    const wedges = new Wedges(positions, surfaceOf, yield* points(positions), yield* normalsOf(positions, indices));
    for (let v = 0; v < positions.length / 3; v++) {
      wedges.add(v);
      if (v % PIECE === 0) yield;
    }
    yield* wedges.findRims(positions, indices);
    return wedges;
  }

  /**
   * Whether point `p` can become `q`: its surfaces are there, too, and it moves along all of them, and along the crease or border it lies on, but for
   * `stray`. So a crease stays one, and a corner stays where it is.
   */
  canBecome(p: number, q: number, stray: number): boolean {
    for (let w = p; w !== NONE; w = this.next[w]!) {
      let x = q;
      while (x !== NONE && !(this.surfaceOf[w] === this.surfaceOf[x] && this.isAlike(w, x))) x = this.next[x]!;
      if (x === NONE || !this.isAlong(w, q, stray)) return false;
    }
    return true;
  }

  /** What point `q` has of the surface of wedge `w`, facing most alike. */
  counterpart(w: number, q: number): number {
    let best = q, least = Infinity;
    for (let x = q; x !== NONE; x = this.next[x]!) {
      const apart = this.surfaceOf[w] === this.surfaceOf[x] ? distance(this.normals, w, x) : Infinity;
      if (apart < least) [best, least] = [x, apart];
    }
    return best;
  }

  /** Vertex `v` belongs to a wedge that is there, or is a new one. */
  private add(v: number): void {
    let last = NONE;
    for (let w = this.pointOf[v]!; w !== NONE && w !== v; last = w, w = this.next[w]!) {
      if (this.surfaceOf[w] !== this.surfaceOf[v] || this.cosine(w, v) < 0.8) continue;
      for (let c = 0; c < 3; c++) this.normals[3 * w + c]! += this.normals[3 * v + c]!;
      this.wedgeOf[v] = w;
      return;
    }
    this.wedgeOf[v] = v;
    if (last !== NONE) this.next[last] = v;
  }

  private *findRims(positions: Float32Array, indices: Uint32Array): Pieces<void> {
    const { rims, normals } = this;
    // Around a wedge the edges that lie opposite to it end where the first began, or at the other side of the gap.
    for (let k = 0; k < indices.length; k += 3) {
      for (let corner = 0; corner < 3; corner++) {
        const [v, from, to] = [indices[k + corner]!, indices[k + ((corner + 1) % 3)]!, indices[k + ((corner + 2) % 3)]!];
        const w = this.wedgeOf[v]!;
        for (let c = 0; c < 3; c++) rims[3 * w + c]! += positions[3 * from + c]! - positions[3 * to + c]!;
      }
      if (k % PIECE === 0) yield;
    }
    for (let w = 0; w < this.wedgeOf.length; w++) {
      const gap = length(rims, w), area = length(normals, w);
      scale(rims, w, gap > GAP * Math.sqrt(area) ? 1 / gap : 0);
      scale(normals, w, area > 0 ? 1 / area : 0);
      if (w % PIECE === 0) yield;
    }
  }

  /** Whether wedge `x` faces as `w` does, and ends as it does, if it ends. */
  private isAlike(w: number, x: number): boolean {
    return distance(this.normals, w, x) < ALIKE && (this.hasNoRim(w) || distance(this.rims, w, x) < ALIKE);
  }

  /** Whether the way from wedge `w` to point `q` is along the surface, or its end. */
  private isAlong(w: number, q: number, stray: number): boolean {
    const { positions, normals, rims } = this;
    const x = positions[3 * q]! - positions[3 * w]!, y = positions[3 * q + 1]! - positions[3 * w + 1]!, z = positions[3 * q + 2]! - positions[3 * w + 2]!;
    if (Math.abs(x * normals[3 * w]! + y * normals[3 * w + 1]! + z * normals[3 * w + 2]!) > stray) return false;
    const along = x * rims[3 * w]! + y * rims[3 * w + 1]! + z * rims[3 * w + 2]!;
    return this.hasNoRim(w) || x * x + y * y + z * z - along * along <= stray * stray;
  }

  private hasNoRim(w: number): boolean {
    return this.rims[3 * w] === 0 && this.rims[3 * w + 1] === 0 && this.rims[3 * w + 2] === 0;
  }

  /** Whether point `p` lies inside one surface. */
  isInside(p: number): boolean {
    return this.next[p] === NONE && this.hasNoRim(p);
  }

  /** Of the angle between two normals of any length. */
  private cosine(w: number, x: number): number {
    const { normals } = this;
    const product = normals[3 * w]! * normals[3 * x]! + normals[3 * w + 1]! * normals[3 * x + 1]! + normals[3 * w + 2]! * normals[3 * x + 2]!;
    return product / (length(normals, w) * length(normals, x) || 1);
  }
}

/** Normals of the triangles about every vertex, each as long as twice their area. */
function* normalsOf(positions: Float32Array, indices: Uint32Array): Pieces<Float32Array> {
  const normals = new Float32Array(positions.length);
  for (let k = 0; k < indices.length; k += 3) {
    const [a, b, c] = [3 * indices[k]!, 3 * indices[k + 1]!, 3 * indices[k + 2]!];
    for (let i = 0; i < 3; i++) {
      const [j, l] = [(i + 1) % 3, (i + 2) % 3];
      const [x, y] = [positions[a + j]!, positions[a + l]!];
      const cross = (positions[b + j]! - x) * (positions[c + l]! - y) - (positions[b + l]! - y) * (positions[c + j]! - x);
      normals[a + i]! += cross;
      normals[b + i]! += cross;
      normals[c + i]! += cross;
    }
    if (k % PIECE === 0) yield;
  }
  return normals;
}

const length = (v: Float32Array, n: number) => Math.sqrt(v[3 * n]! ** 2 + v[3 * n + 1]! ** 2 + v[3 * n + 2]! ** 2);
const distance = (v: Float32Array, n: number, m: number) =>
  (v[3 * n]! - v[3 * m]!) ** 2 + (v[3 * n + 1]! - v[3 * m + 1]!) ** 2 + (v[3 * n + 2]! - v[3 * m + 2]!) ** 2;

function scale(v: Float32Array, n: number, factor: number): void {
  for (let c = 0; c < 3; c++) v[3 * n + c]! *= factor;
}
