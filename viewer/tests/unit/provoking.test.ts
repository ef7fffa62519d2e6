import { expect, test } from "vitest";
import { gather, provoke } from "../../src/provoking";

/** Triangles of a torus of n x n squares: every vertex has two, as in any closed mesh. */
function torus(n: number): Uint32Array {
  const at = (i: number, j: number) => (i % n) * n + (j % n);
  const squares = Array.from({ length: n * n }, (_, k) => [Math.floor(k / n), k % n] as const);
  return Uint32Array.from(squares.flatMap(([i, j]) => [
    at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1),
  ]));
}

/** Turned so that the smallest vertex is first: orientation is what is left. */
const turned = (t: number[]) => {
  const k = t.indexOf(Math.min(...t));
  return [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
};

for (const corner of [0, 2] as const) {
  test(`every triangle has its element at corner ${corner}, and is what it was`, () => {
    const n = 30;
    const indices = torus(n);
    const elementOf = Uint32Array.from({ length: 2 * n * n }, (_, t) => 1000 + Math.floor(t / 3));
    const { indices: found, source, element } = provoke(indices, elementOf, n * n, corner);
    for (let t = 0; t < elementOf.length; t++) {
      const corners = [...found.subarray(3 * t, 3 * t + 3)];
      expect(element[corners[corner]!]).toBe(elementOf[t]);
      const before = [...indices.subarray(3 * t, 3 * t + 3)];
      expect(turned(corners.map((v) => source[v]!))).toEqual(turned(before));
    }
    expect(source.length).toBeLessThanOrEqual(1.2 * 2 * n * n);
  });
}

test("records are gathered by their sources", () => {
  expect([...gather(Float32Array.of(1, 2, 3, 4), 2, Uint32Array.of(1, 0, 1))]).toEqual([3, 4, 1, 2, 3, 4]);
});
