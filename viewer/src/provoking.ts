// One number for every triangle, without vertices of its own for each of its corners.
//
// Values that are flat over a triangle are those of one of its vertices, the provoking one: OpenGL's last, or the first. So
// every triangle needs a vertex that no triangle of another element provokes with. A closed mesh has two triangles a vertex, so about every
// second triangle has to get one more; three of its own would be six times as many.

/** Triangles with provoking vertices. */
export interface Provoked {
  indices: Uint32Array;
  /** Of which earlier vertex each vertex is a copy. */
  source: Uint32Array;
  /** Element of the triangles that each vertex provokes. */
  element: Uint32Array;
}

const NONE = 0xffffffff;

/** Turns every triangle, its orientation kept, so that its `corner` (0 or 2) is a vertex that has its element. */
export function provoke(indices: Uint32Array, elementOf: Uint32Array, vertices: number, corner: 0 | 2): Provoked {
  const element = new Uint32Array(vertices + elementOf.length).fill(NONE);
  const copies: number[] = [];
  const turned = new Uint32Array(indices.length);
  for (let t = 0; t < elementOf.length; t++) {
    const e = elementOf[t]!;
    const corners = [indices[3 * t]!, indices[3 * t + 1]!, indices[3 * t + 2]!];
    let k = corners.findIndex((v) => element[v] === e);
    if (k < 0) k = corners.findIndex((v) => element[v] === NONE);
    if (k < 0) {
      k = 0;
      copies.push(corners[0]!);
      corners[0] = vertices + copies.length - 1;
    }
    element[corners[k]!] = e;
    for (let c = 0; c < 3; c++) turned[3 * t + ((c - k + corner + 3) % 3)] = corners[c]!;
  }
  // What provokes nothing has a number, too, for triangles of other levels of detail.
  for (let k = 0; k < turned.length; k++) {
    if (element[turned[k]!] === NONE) element[turned[k]!] = elementOf[Math.floor(k / 3)]!;
  }
  const source = new Uint32Array(vertices + copies.length);
  for (let v = 0; v < source.length; v++) source[v] = v < vertices ? v : copies[v - vertices]!;
  return { indices: turned, source, element: element.slice(0, source.length) };
}

/** Records of `size` floats of the vertices that were copied. */
export function gather(records: Float32Array, size: number, source: Uint32Array): Float32Array {
  const found = new Float32Array(size * source.length);
  for (let v = 0, to = 0; v < source.length; v++) {
    for (let k = 0, from = size * source[v]!; k < size; k++) found[to++] = records[from++]!;
  }
  return found;
}
