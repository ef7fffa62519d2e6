// Values on isolux lines, as on maps: where a line is straight enough for its number and lies on one surface. They are sought when the camera
// stands, and go with their surfaces while it moves.

import type { Vector3 } from "three";
import { LuxMap, STEP } from "./luxmap";
import { short } from "./numbers";
import { byId } from "./page";
import { MOST_PIXELS, type Viewer } from "./viewer";

const FONT = "600 11px system-ui, sans-serif";
/** Pixels of the page between labels, and between those of the same value. */
const [APART, SAME_APART] = [52, 200];
/** Height of a label in pixels, and what is left free at its ends. */
const [HEIGHT, MARGIN] = [14, 5];
/** What a line may stray below its label, in steps between lines; and how crowded lines may be, in steps within a sample. */
const [STRAY, CROWDED] = [0.25, 0.4];
/** How far three points of a surface may be from a straight line, in its length. */
const BENT = 0.04;

/** A value on a line. */
export interface Label {
  lux: number;
  /** Where it is, and a point farther along the line. */
  position: Vector3;
  along: Vector3;
}

/** A place for a label: in samples of the map, with the direction of the line, and how far the line strays below it. */
interface Place extends Label {
  x: number;
  y: number;
  stray: number;
}

export class Labels {
  readonly canvas = byId<HTMLCanvasElement>("labels");
  found: Label[] = [];
  private readonly map = new LuxMap();
  private readonly context = this.canvas.getContext("2d")!;

  constructor(private readonly viewer: Viewer) {
    viewer.drawn.push(() => this.draw());
    viewer.stood.push(() => this.find());
  }

  /** Looks for places anew. */
  private find(): void {
    const { lines } = this.viewer;
    this.found = [];
    if (lines.length > 0) {
      this.map.take(this.viewer);
      const places = lines.flatMap((lux, k) => this.places(lux, Math.min(lux - (lines[k - 1] ?? 0), (lines[k + 1] ?? Infinity) - lux)));
      places.sort((a, b) => a.stray - b.stray);
      const chosen: Place[] = [];
      for (const place of places) {
        const isFree = chosen.every(({ x, y, lux }) => STEP * Math.hypot(x - place.x, y - place.y) > (lux === place.lux ? SAME_APART : APART));
        if (isFree) chosen.push(place);
      }
      this.found = chosen;
    }
    this.draw();
  }

  /** Where the line of `lux` could have its label; the next line is `step` [lux] away. */
  private places(lux: number, step: number): Place[] {
    this.context.font = FONT;
    const half = (0.5 * this.context.measureText(short(lux)).width + MARGIN) / STEP;
    const places: Place[] = [];
    for (let y = 1; y < this.map.height - 1; y++) {
      for (let x = 1; x < this.map.width - 1; x++) {
        const place = this.place(x, y, lux, step, half);
        if (place) places.push(place);
      }
    }
    return places;
  }

  private place(x: number, y: number, lux: number, step: number, half: number): Place | undefined {
    const { map } = this;
    const right = 0.5 * (map.lux(x + 1, y) - map.lux(x - 1, y));
    const down = 0.5 * (map.lux(x, y + 1) - map.lux(x, y - 1));
    const slope = Math.hypot(right, down);
    // A comparison with what is no number is false.
    if (!(Math.abs(map.lux(x, y) - lux) <= 0.5 * slope && slope < CROWDED * step)) return undefined;
    const [alongX, alongY] = [(-down / slope) * half, (right / slope) * half];
    const strays = [-1, -0.5, 0.5, 1].map((part) => Math.abs(map.lux(x + part * alongX, y + part * alongY) - lux) / step);
    const stray = Math.max(...strays);
    if (!(stray < STRAY)) return undefined;
    // On one surface, both along the line and across.
    const across = [(2 * right) / slope, (2 * down) / slope] as const;
    if (this.isBent(x, y, alongX, alongY) || this.isBent(x, y, ...across)) return undefined;
    return { lux, position: map.position(x, y), along: map.position(x + alongX, y + alongY), x, y, stray };
  }

  /** Whether three samples in a row are not in a row on the surfaces. */
  private isBent(x: number, y: number, wayX: number, wayY: number): boolean {
    const [one, middle, other] = [-1, 0, 1].map((part) => this.map.position(x + part * wayX, y + part * wayY)) as [Vector3, Vector3, Vector3];
    const way = other.sub(one);
    return middle.sub(one).cross(way).length() > BENT * way.lengthSq();
  }

  /** Writes them where their points are now. */
  private draw(): void {
    const { canvas, context, viewer } = this;
    const { clientWidth: width, clientHeight: height } = viewer.renderer.domElement;
    const ratio = Math.min(window.devicePixelRatio, MOST_PIXELS);
    [canvas.width, canvas.height] = [width * ratio, height * ratio];
    if (viewer.lines.length === 0) return;
    context.scale(ratio, ratio);
    context.font = FONT;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    for (const { lux, position, along } of this.found) {
      const [at, to] = [position, along].map((point) => point.clone().project(viewer.camera.camera)) as [Vector3, Vector3];
      if (Math.abs(at.z) > 1) continue;
      const slope = Math.atan2(-(to.y - at.y) * height, (to.x - at.x) * width);
      context.save();
      context.translate((0.5 + 0.5 * at.x) * width, (0.5 - 0.5 * at.y) * height);
      // Not upside down.
      context.rotate(Math.abs(slope) > Math.PI / 2 ? slope + Math.PI : slope);
      context.lineWidth = HEIGHT / 4;
      context.strokeStyle = "rgba(0, 0, 0, 0.8)";
      context.strokeText(short(lux), 0, 0);
      context.fillStyle = "#ffffff";
      context.fillText(short(lux), 0, 0);
      context.restore();
    }
  }
}
