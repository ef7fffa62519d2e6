// The picture: what is drawn, when, and with which scale.

import { Color, Vector3, WebGLRenderer } from "three";
import { Camera } from "./camera";
import { triangles } from "./details";
import { type Draft, Drafts } from "./drafts";
import { Drawing } from "./drawing";
import { Edges, type Strip } from "./edges";
import type { Light } from "./light";
import { type Picked, Picking } from "./picking";
import { drawsByProcessor } from "./processor";
import { automatic, levels, type PaletteName, type Scale, symmetric } from "./scale";
import { defaults, type Settings } from "./settings";
import type { Surfaces } from "./surfaces";
import { choices, paletteTexture, shared } from "./uniforms";

/** Pixels of the picture for each of the page, along each side, at most: more cost time and cannot be seen. */
export const MOST_PIXELS = 2;
/** The same where the processor draws and the camera stands. Multisampling would take three times as long. */
const STILL_PIXELS = 2;
/** Milliseconds after which a camera stands. */
const STILL = 400;

/** A solution to show. */
export interface Shown {
  surfaces: Surfaces;
  light: Light;
}

export class Viewer {
  readonly settings: Settings = defaults();
  readonly camera: Camera;
  readonly renderer: WebGLRenderer;
  /** The solution, and the one before, if there are two. */
  after!: Drawing;
  before: Drawing | undefined;
  sameElements = false;
  /** Called after the picture was drawn. */
  readonly drawn: (() => void)[] = [];
  /** Called when the camera stands again, or something else has changed while it stood. */
  readonly stood: (() => void)[] = [];
  /** Draw calls, triangles and level of detail of the last picture. */
  work = { calls: 0, triangles: 0, pictures: 0, level: 0 };
  private readonly picking: Picking;
  private readonly edges: Edges;
  private readonly canvas: HTMLCanvasElement;
  private readonly isSoftware: boolean;
  private isOld = true;
  private readonly drafts: Drafts;
  /** Whether the last picture was not the whole one, and whether how long it takes is measured. */
  private isDraft = false;
  private isMeasured = false;
  private moved = -Infinity;
  private seenStanding = 0;
  private last = 0;
  private scales = new Map<string, Scale>();

  private constructor(canvas: HTMLCanvasElement, surfaces: Surfaces) {
    this.canvas = canvas;
    this.isSoftware = drawsByProcessor();
    this.drafts = new Drafts(this.isSoftware);
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSoftware, powerPreference: "high-performance" });
    this.renderer.autoClear = false;
    this.renderer.setClearColor(new Color(0), 0);
    this.picking = new Picking(this.renderer);
    this.edges = new Edges(this.renderer);
    this.camera = new Camera(canvas, surfaces.header, () => this.move());
    new ResizeObserver(() => this.update()).observe(canvas);
    const loop = (now: number) => {
      if (this.isMeasured) this.drafts.took(now - this.last);
      this.isMeasured = false;
      if (this.camera.step(Math.min((now - this.last) / 1000, 0.1))) this.move();
      const isMoving = performance.now() - this.moved < STILL;
      if (this.isOld || (this.isDraft && !isMoving)) this.draw(isMoving ? this.due : undefined);
      if (!isMoving && this.seenStanding !== this.work.pictures) {
        this.seenStanding = this.work.pictures;
        this.stood.forEach((told) => told());
      }
      this.last = now;
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  /** Shows `after` on `canvas`, and `before` beside it; elements of both can be compared if they are the same. */
  static async make(canvas: HTMLCanvasElement, after: Shown, before?: Shown, sameElements = false): Promise<Viewer> {
    const viewer = new Viewer(canvas, after.surfaces);
    viewer.isOld = false;
    if (before) viewer.before = await Drawing.make(before.surfaces, before.light, viewer.renderer);
    const comparable = sameElements ? viewer.before : undefined;
    viewer.after = await Drawing.make(after.surfaces, after.light, viewer.renderer, comparable);
    viewer.sameElements = comparable !== undefined;
    viewer.takeCamera(after.light.header.camera);
    return viewer;
  }

  /** The picture has to be drawn again. */
  update(): void {
    this.isOld = true;
  }

  /** The camera has moved. */
  private move(): void {
    this.moved = performance.now();
    this.update();
  }

  /** The light has changed. */
  relight(drawing: Drawing): void {
    drawing.relight();
    this.scales.clear();
    this.update();
  }

  takeCamera(number: number): void {
    const { cameras } = this.after.surfaces.header;
    this.camera.take(cameras[number] ?? cameras[0]!);
    this.camera.setWalking(this.camera.isWalking, this.ahead());
    this.update();
  }

  /** The point of a surface straight ahead; a point in the middle of the scene if there is none. */
  ahead(): Vector3 {
    const { clientWidth, clientHeight } = this.canvas;
    const { center } = this.after.surfaces.header.bounds;
    return this.pick(clientWidth / 2, clientHeight / 2)?.position ?? new Vector3(...center);
  }

  /** What is at (x, y) of the canvas, in pixels of the page. */
  pick(x: number, y: number): (Picked & { drawing: Drawing }) | undefined {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const drawing = this.before && x < this.settings.divider * width && !this.isDifference ? this.before : this.after;
    this.camera.fit(width, height);
    const picked = this.picking.at(drawing, this.camera.camera, x, y, width, height);
    return picked && { ...picked, drawing };
  }

  /** Exposure in stops: luminance is multiplied by two to this power. */
  get stops(): number {
    return this.after.light.header.exposure_stops + this.settings.stops;
  }

  get isDifference(): boolean {
    return this.settings.mode === "difference";
  }

  /** The false colours in use: those of illuminance belong to the picture, too, for the sake of the lines. */
  get palette(): PaletteName {
    return this.settings.mode === "light" ? "illuminance" : this.settings.mode;
  }

  /** The scale in use: as somebody chose it, or as suits the values. */
  get scale(): Scale {
    const chosen = this.settings.ends[this.settings.mode === "light" ? "illuminance" : this.settings.mode];
    const scale = this.automaticScale();
    return chosen ? { ...scale, ...chosen } : scale;
  }

  /** Illuminances [lux] of the isolux lines that are drawn, rising. */
  get lines(): number[] {
    const { lines, mode } = this.settings;
    return lines && (mode === "light" || mode === "illuminance") ? levels(this.scale) : [];
  }

  private automaticScale(): Scale {
    const { logarithmic, relativeError } = this.settings;
    const key = `${this.palette} ${logarithmic} ${relativeError}`;
    const known = this.scales.get(key);
    if (known) return known;
    const { lux, errors, seen } = this.after;
    const before = this.before?.lux;
    let scale: Scale;
    if (this.palette === "difference" && before) scale = symmetric(lux.map((v, e) => v - before[e]!), seen);
    else if (this.palette === "error" && relativeError) {
      // Errors of what is dark are large, and hardly matter.
      scale = automatic(errors.map((v, e) => (100 * v) / lux[e]!), seen.map((area, e) => area * lux[e]!), logarithmic);
    } else scale = automatic(this.palette === "error" ? errors : lux, seen, logarithmic);
    this.scales.set(key, scale);
    return scale;
  }

  /** Pixels of the picture for each of the page, along each side. */
  private get pixels(): number {
    return Math.min(window.devicePixelRatio, MOST_PIXELS);
  }

  /** What is drawn while the camera moves. */
  private get due(): Draft {
    const { clientWidth, clientHeight } = this.canvas;
    const details = new Set([this.after, this.before ?? this.after].map(({ details }) => details));
    this.drafts.fit(this.pixels, clientWidth * clientHeight, triangles(details));
    return this.drafts.due;
  }

  /** Draws the picture now, or a draft. */
  draw(draft?: Draft): void {
    this.isOld = false;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.after || width === 0 || height === 0) return;
    const { pixels, level } = draft ?? { pixels: this.isSoftware ? STILL_PIXELS : this.pixels, level: 0 };
    this.renderer.setPixelRatio(pixels);
    this.renderer.setSize(width, height, false);
    this.setUniforms();
    this.camera.fit(width, height);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.info.autoReset = false;
    this.renderer.info.reset();
    const ratio = this.renderer.getPixelRatio();
    const parts = this.parts(width);
    const chosen = choices(this.settings, this.lines.length > 0);
    for (const { drawing, strip: [left, wide] } of parts) {
      this.renderer.setScissorTest(true);
      this.renderer.setScissor(left, 0, wide, height);
      drawing.choose(chosen);
      drawing.draw(this.renderer, this.camera.camera, null, level);
    }
    this.renderer.setScissorTest(false);
    if (this.settings.edges) {
      const inPixels = parts.map(({ drawing, strip }) => ({ drawing, strip: strip.map((v) => Math.floor(v * ratio)) as Strip }));
      this.edges.draw(inPixels, this.camera.camera, Math.floor(width * ratio), Math.floor(height * ratio), level);
    }
    const { calls, triangles } = this.renderer.info.render;
    this.isDraft = draft !== undefined && (level > 0 || this.isSoftware || pixels !== this.pixels);
    this.isMeasured = draft !== undefined;
    if (!draft) this.drafts.pause();
    this.work = { calls, triangles, pictures: this.work.pictures + 1, level };
    this.drawn.forEach((told) => told());
  }

  /** Which solution is drawn where. */
  parts(width: number): { drawing: Drawing; strip: Strip }[] {
    const left = this.before && !this.isDifference ? Math.round(this.settings.divider * width) : 0;
    const parts: { drawing: Drawing; strip: Strip }[] = [];
    if (this.before && left > 0) parts.push({ drawing: this.before, strip: [0, left] });
    if (left < width) parts.push({ drawing: this.after, strip: [left, width - left] });
    return parts;
  }

  private setUniforms(): void {
    const { settings, scale, lines } = this;
    shared.exposure.value = 2 ** this.stops;
    shared.relativeError.value = settings.relativeError;
    shared.palette.value = paletteTexture(this.palette);
    shared.range.value.set(scale.low, scale.high);
    shared.logarithmic.value = scale.logarithmic;
    shared.levelCount.value = lines.length;
    shared.levels.value.set(lines);
    shared.lineWidth.value = 1.6 * this.renderer.getPixelRatio();
  }
}
