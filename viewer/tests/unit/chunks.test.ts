import { PerspectiveCamera, Vector3 } from "three";
import { expect, test } from "vitest";
import { Chunks } from "../../src/chunks";
import { nearby } from "../../src/nearby";
import type { Level } from "../../src/levels";
import { finish } from "../../src/pieces";
import type { Batch } from "../../src/surfaces";

/** Balls of n x n squares seen from outside, in two batches, their triangles in no order. */
function balls(n: number): Level & { positions: Float32Array } {
  const positions: number[] = [];
  const indices: number[] = [];
  for (const center of [[0, 0, 0], [3, 1, 0], [-2, 0, 4], [0, 5, -3]] as const) {
    const first = positions.length / 3;
    for (let i = 0; i <= n; i++) {
      for (let j = 0; j <= n; j++) {
        const [a, b] = [(Math.PI * i) / n, (2 * Math.PI * j) / n];
        positions.push(center[0] + Math.sin(a) * Math.cos(b), center[1] + Math.cos(a), center[2] - Math.sin(a) * Math.sin(b));
        if (i === n || j === n) continue;
        const at = first + i * (n + 1) + j;
        indices.push(at, at + n + 1, at + 1, at + 1, at + n + 1, at + n + 2);
      }
    }
  }
  const count = indices.length / 3;
  const shuffled = Array.from({ length: count }, (_, t) => (t * 7919) % count);
  const mixed = Uint32Array.from(shuffled.flatMap((t) => indices.slice(3 * t, 3 * t + 3)));
  const batches = [{ first: 0, count: 1000 }, { first: 1000, count: count - 1000 }] as Batch[];
  const order = nearby(batches, mixed, Float32Array.from(positions));
  expect([...order].sort((a, b) => a - b)).toEqual(Array.from({ length: count }, (_, t) => t));
  expect(Math.max(...order.slice(0, 1000))).toBe(999);
  const sorted = Uint32Array.from([...order].flatMap((t) => [...mixed.subarray(3 * t, 3 * t + 3)]));
  return { batches, positions: Float32Array.from(positions), indices: sorted };
}

test("all that is seen is drawn, and much of what is not is left out", () => {
  const surfaces = balls(100);
  const chunks = finish(Chunks.of(surfaces.positions, surfaces));
  const count = surfaces.indices.length / 3;
  const corner = (t: number, k: number) => new Vector3().fromArray(surfaces.positions, 3 * surfaces.indices[3 * t + k]!);
  let drawn = 0;
  for (let view = 0; view < 6; view++) {
    const camera = new PerspectiveCamera(50, 1.5, 0.001, 100);
    // From outside, and from just above the first ball.
    camera.position.set(Math.cos(view), 0.3 * Math.sin(3 * view), Math.sin(view)).setLength(view % 2 === 0 ? 6 : 1.02);
    camera.lookAt(0, 1, 0);
    camera.updateMatrixWorld();
    const runs = chunks.seenBy(camera);
    const isDrawn = new Uint8Array(count);
    for (const { start, count, materialIndex } of runs) {
      expect(start >= 3000).toBe(materialIndex === 1);
      for (let k = start; k < start + count; k += 3) isDrawn[k / 3] = 1;
    }
    for (let t = 0; t < count; t++) {
      drawn += isDrawn[t]!;
      const [a, b, c] = [0, 1, 2].map((k) => corner(t, k)) as [Vector3, Vector3, Vector3];
      const normal = b.clone().sub(a).cross(c.clone().sub(a));
      const isFront = normal.dot(camera.position.clone().sub(a)) > 1e-6 * normal.length();
      const isInside = [a, b, c].some((corner) => corner.clone().project(camera).toArray().every((v) => Math.abs(v) <= 1));
      if (isFront && isInside) expect(isDrawn[t], `triangle ${t} of view ${view}`).toBe(1);
    }
  }
  expect(drawn).toBeLessThan(0.6 * 6 * count);
}, 60_000);

test("between two floors the lower one is seen, and below both nothing is", () => {
  const floor = (y: number) => [[-1, y, -1], [-1, y, 1], [1, y, -1]].flat();
  const positions = Float32Array.from([...floor(0), ...floor(1)]);
  const floors = { batches: [{ first: 0, count: 2 }], indices: Uint32Array.from([0, 1, 2, 3, 4, 5]) };
  const camera = new PerspectiveCamera(90, 1, 0.01, 100);
  const seenFrom = (y: number) => {
    camera.position.set(0, y, 1);
    camera.lookAt(0, 0.4, 0);
    return finish(Chunks.of(positions, floors)).seenBy(camera).length;
  };
  expect([2, 0.3, 0.01].map(seenFrom)).toEqual([1, 1, 1]);
  expect([-0.01, -1].map(seenFrom)).toEqual([0, 0]);
});
