import { expect, test } from "vitest";
import { coarser, type Level } from "../../src/levels";
import { finish } from "../../src/pieces";
import { Wedges } from "../../src/wedges";

type Vector = [number, number, number];
interface Mesh extends Level {
  positions: Float32Array;
}

const N = 100;

/** Patches of N x N squares, each a batch with vertices of its own: neighbours have corners at the same places. */
function patches(...places: ((u: number, v: number) => Vector)[]): Mesh {
  const positions: number[] = [], indices: number[] = [];
  for (const place of places) {
    const first = positions.length / 3;
    for (let i = 0; i <= N; i++) {
      for (let j = 0; j <= N; j++) {
        positions.push(...place(i / N, j / N));
        const at = first + i * (N + 1) + j;
        if (i < N && j < N) indices.push(at, at + N + 1, at + 1, at + 1, at + N + 1, at + N + 2);
      }
    }
  }
  const batches = places.map((_, k) => ({ first: 2 * N * N * k, count: 2 * N * N }));
  return { positions: Float32Array.from(positions), indices: Uint32Array.from(indices), batches };
}

/** The six sides of a cube, seen from outside. */
const SIDES: ((u: number, v: number) => Vector)[] = [
  (u, v) => [0, v, u], (u, v) => [1, u, v], (u, v) => [u, 0, v], (u, v) => [v, 1, u], (u, v) => [v, u, 0], (u, v) => [u, v, 1],
];
const cube = () => patches(...SIDES);

/** The levels of a mesh, in even light if none is given. */
function levelsOf({ positions, indices, batches }: Mesh, lux = new Float32Array(positions.length / 3).fill(1)): Level[] {
  return [...coarser(positions, { indices, batches }, lux, 1)].filter((level) => level !== undefined);
}

/** Corners of a triangle, and its normal that is as long as twice its area. */
function triangle({ positions }: Mesh, { indices }: Level, t: number): { corners: Vector[]; normal: Vector } {
  const corners = [0, 1, 2].map((k) => [...positions.subarray(3 * indices[3 * t + k]!, 3 * indices[3 * t + k]! + 3)] as Vector);
  const way = (k: number, c: number) => corners[k]![c]! - corners[0]![c]!;
  const minor = (c: number, d: number) => way(1, c) * way(2, d) - way(1, d) * way(2, c);
  return { corners, normal: [minor(1, 2), minor(2, 0), minor(0, 1)] };
}

const determinant = ([a, b, c]: Vector, [d, e, f]: Vector, [g, h, i]: Vector) => a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);

/** How often every edge is gone along more often one way than the other, by the places of its ends. */
function open(mesh: Mesh, level: Level): Map<string, number> {
  const edges = new Map<string, number>();
  for (let t = 0; t < level.indices.length / 3; t++) {
    const names = triangle(mesh, level, t).corners.map((corner) => corner.join());
    for (let k = 0; k < 3; k++) {
      const [from, to] = [names[k]!, names[(k + 1) % 3]!];
      const [name, way] = from < to ? [`${from} ${to}`, 1] : [`${to} ${from}`, -1];
      edges.set(name, (edges.get(name) ?? 0) + way);
    }
  }
  return new Map([...edges].filter(([, count]) => count !== 0));
}

test("each level has a fraction of the triangles of the one before, in the same batches", () => {
  const mesh = cube();
  const levels = levelsOf(mesh);
  expect(levels.length).toBeGreaterThan(1);
  let before: Level = mesh;
  for (const level of levels) {
    expect(level.indices.length).toBeLessThan(0.35 * before.indices.length);
    expect(level.batches.length).toBe(6);
    let first = 0;
    for (const batch of level.batches) {
      expect(batch.first).toBe(first);
      first += batch.count;
    }
    expect(3 * first).toBe(level.indices.length);
    before = level;
  }
});

test("a few triangles stay as they are", () => {
  const { positions, indices } = cube();
  const few = { positions, indices: indices.slice(0, 9000), batches: [{ first: 0, count: 3000 }] };
  expect(levelsOf(few)).toEqual([]);
});

test("a closed surface stays closed, and every side keeps its plane and its area", () => {
  const mesh = cube();
  for (const level of levelsOf(mesh)) {
    expect(open(mesh, level).size).toBe(0);
    level.batches.forEach(({ first, count }, side) => {
      const [axis, sign] = [[0, -1], [0, 1], [1, -1], [1, 1], [2, -1], [2, 1]][side]! as [number, number];
      let area = 0, strays = 0, turned = 0;
      for (let t = first; t < first + count; t++) {
        const { corners, normal } = triangle(mesh, level, t);
        strays += corners.filter((corner) => corner[axis] !== (sign < 0 ? 0 : 1)).length;
        turned += sign * normal[axis]! > 0 ? 0 : 1;
        area += 0.5 * sign * normal[axis]!;
      }
      expect([strays, turned]).toEqual([0, 0]);
      expect(area).toBeCloseTo(1, 5);
    });
  }
});

test("triangles use vertices of their own surface only", () => {
  const mesh = cube();
  for (const level of levelsOf(mesh)) {
    level.batches.forEach(({ first, count }, side) => {
      const sides = new Set([...level.indices.subarray(3 * first, 3 * (first + count))].map((v) => Math.floor(v / (N + 1) ** 2)));
      expect([...sides]).toEqual([side]);
    });
  }
});

test("from inside a ball, whose patches have creases between them, one sees no gaps", () => {
  const onBall = (place: (u: number, v: number) => Vector) => (u: number, v: number) => {
    const at = place(u, v).map((x) => 2 * x - 1);
    const length = Math.sqrt(at.map((x) => x * x).sort((x, y) => x - y).reduce((sum, x) => sum + x));
    return at.map((x) => x / length) as Vector;
  };
  const mesh = patches(...SIDES.map(onBall));
  expect(open(mesh, mesh).size).toBe(0);
  const levels = levelsOf(mesh);
  expect(levels.length).toBeGreaterThan(1);
  for (const level of levels) {
    const triangles = Array.from({ length: level.indices.length / 3 }, (_, t) => triangle(mesh, level, t).corners);
    for (let ray = 0; ray < 300; ray++) {
      // Evenly on a ball (Fibonacci).
      const z = (2 * ray + 1) / 300 - 1, turn = 2.39996 * ray;
      const way: Vector = [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn), z];
      expect(triangles.some(([a, b, c]) => [determinant(way, a!, b!), determinant(way, b!, c!), determinant(way, c!, a!)].every((d) => d >= 0)), `ray ${ray}`).toBe(true);
    }
  }
});

test("the border of a surface stays where it is, corners and all", () => {
  const strip = (y: number) => (u: number, v: number): Vector => [u, y, 0.05 * v];
  // Narrower than the cells of the later levels.
  const mesh = patches(strip(0), strip(0.5), strip(1));
  for (const level of levelsOf(mesh)) {
    level.batches.forEach(({ first, count }) => {
      let area = 0;
      for (let t = first; t < first + count; t++) area += 0.5 * Math.abs(triangle(mesh, level, t).normal[1]);
      expect(area).toBeCloseTo(0.05, 5);
    });
  }
});

test("a vertex that is unusually dark does not stand for those around it", () => {
  const mesh = cube();
  const lux = Float32Array.from({ length: mesh.positions.length / 3 }, (_, v) => (v % 7 === 3 ? 1 : 100));
  const share = (level: Level) => level.indices.reduce((sum, v) => sum + (lux[v] === 1 ? 1 : 0), 0) / level.indices.length;
  expect(share(mesh)).toBeGreaterThan(0.1);
  for (const level of levelsOf(mesh, lux)) expect(share(level)).toBeLessThan(0.1);
});

test("a point becomes another along its surface only", () => {
  // Crests and troughs face alike.
  const { positions, indices } = patches((u, v) => [u, 0.03 * Math.cos(4 * Math.PI * u), v]);
  const wedges = finish(Wedges.of(positions, indices));
  const at = (u: number, v: number) => u * N * (N + 1) + v * N;
  expect(wedges.canBecome(at(0.5, 0.2), at(0.5, 0.8), 0.01)).toBe(true);
  expect(wedges.canBecome(at(0.5, 0.2), at(0.25, 0.2), 0.01)).toBe(false);
  expect(wedges.canBecome(at(0.5, 0.2), at(0.25, 0.2), 0.1)).toBe(true);
  // Nor does the border become what is inside, though that can become the border.
  expect(wedges.canBecome(at(0.5, 0), at(0.5, 0.2), 1)).toBe(false);
  expect(wedges.canBecome(at(0.5, 0.2), at(0.5, 0), 0.01)).toBe(true);
});
