// What one reads off a point of a surface: a card with numbers, and a mark on the point.

import type { Vector3 } from "three";
import type { Drawing } from "./drawing";
import { luminance } from "./colour";
import { significant, withMargin } from "./numbers";
import { byId, terms } from "./page";
import type { Picked } from "./picking";
import type { Viewer } from "./viewer";

/** Pixels that a pointer may move in a click. */
const STILL = 5;
/** Milliseconds that it may take. */
const SHORT = 600;

export class ReadingCard {
  /** What was clicked last. */
  picked: (Picked & { drawing: Drawing }) | undefined;
  private readonly card = byId("reading");
  private readonly mark = byId("mark");

  constructor(private readonly viewer: Viewer, private readonly canvas: HTMLCanvasElement) {
    let down = { x: 0, y: 0, time: 0, fingers: 0 };
    canvas.addEventListener("pointerdown", (event) => {
      down = { x: event.clientX, y: event.clientY, time: event.timeStamp, fingers: event.isPrimary ? 1 : 2 };
    });
    canvas.addEventListener("pointerup", (event) => {
      const far = Math.hypot(event.clientX - down.x, event.clientY - down.y);
      if (event.button === 0 && down.fingers === 1 && far < STILL && event.timeStamp - down.time < SHORT) {
        this.pick(event.offsetX, event.offsetY);
      }
    });
    canvas.addEventListener("dblclick", (event) => {
      const found = viewer.pick(event.offsetX, event.offsetY);
      if (found && !viewer.camera.isWalking) viewer.camera.lookAt(found.position);
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.key === "Enter") this.pick(canvas.clientWidth / 2, canvas.clientHeight / 2);
    });
    byId("reading-close").addEventListener("click", () => this.clear());
    viewer.drawn.push(() => this.place());
  }

  /** Reads what is at (x, y) of the canvas. */
  pick(x: number, y: number): void {
    this.picked = this.viewer.pick(x, y);
    this.write();
    this.place();
  }

  clear(): void {
    this.picked = undefined;
    this.write();
    this.place();
  }

  /** Reads the same point again, after the light has changed. */
  relit(): void {
    if (!this.picked) return;
    const { x, y } = this.picked.position.clone().project(this.viewer.camera.camera);
    const found = this.viewer.pick((0.5 + 0.5 * x) * this.canvas.clientWidth, (0.5 - 0.5 * y) * this.canvas.clientHeight);
    // If it is out of sight by now, what is interpolated there is not known any more; the element's value is.
    const isSame = found?.element === this.picked.element && found.drawing === this.picked.drawing;
    this.picked = { ...this.picked, irradiance: isSame ? found.irradiance : [NaN, NaN, NaN] };
    this.write();
  }

  /** Writes the card. */
  private write(): void {
    this.card.hidden = !this.picked;
    if (!this.picked) return;
    const { drawing, element: e, position, irradiance } = this.picked;
    const { surfaces, light } = drawing;
    const reading = light.reading(e);
    const object = surfaces.objectOf(e);
    const [r, g, b] = [0, 1, 2].map((c) => surfaces.reflectivities[3 * e + c]!) as [number, number, number];
    byId("reading-lux").textContent = `${withMargin(reading.lux, reading.margin)} lx`;
    byId("reading-note").textContent = Number.isNaN(reading.margin)
      ? "this element; how sure that is, is not known"
      : "this element, with 95 % confidence";
    const rows: [string, string][] = [];
    const here = luminance(...irradiance);
    if (!Number.isNaN(here)) rows.push(["Interpolated here", `${significant(here, 4)} lx`]);
    rows.push(...this.compared(drawing, e));
    rows.push(
      ["Object", surfaces.header.objects[object] || `number ${object}`],
      ["Material", surfaces.materialOf[object] || "without a name"],
      ["Reflectivity", `${significant(100 * luminance(r, g, b), 3)} %`],
      ["… red, green, blue", [r, g, b].map((v) => v.toFixed(2)).join(", ")],
      ["Irradiance, r g b", `${reading.irradiance.map((v) => significant(v, 3)).join(", ")} lx`],
      ["Element", `${e}, ${area(surfaces.areas[e]!)}`],
      ["Position", `${metres(position)} m`],
    );
    byId("reading-rows").replaceChildren(...terms(rows));
    this.card.dataset.element = String(e);
    this.card.dataset.lux = String(reading.lux);
    this.card.dataset.error = String(reading.stdError);
  }

  /** The same element in the other solution. */
  private compared(drawing: Drawing, e: number): [string, string][] {
    const { before, after, sameElements } = this.viewer;
    if (!before || !sameElements) return [];
    const [old, now] = [before.light.reading(e), after.light.reading(e)];
    const other: [string, string] = drawing === before
      ? ["After", `${withMargin(now.lux, now.margin)} lx`]
      : ["Before", `${withMargin(old.lux, old.margin)} lx`];
    return [other, ["Difference", `${withMargin(now.lux - old.lux, Math.hypot(now.margin, old.margin))} lx`]];
  }

  /** Puts the mark where the point is now. */
  private place(): void {
    const point = this.picked?.position.clone().project(this.viewer.camera.camera);
    const isSeen = point !== undefined && Math.abs(point.x) <= 1 && Math.abs(point.y) <= 1 && point.z <= 1;
    this.mark.hidden = !isSeen;
    if (!isSeen) return;
    this.mark.style.left = `${(0.5 + 0.5 * point.x) * this.canvas.clientWidth}px`;
    this.mark.style.top = `${(0.5 - 0.5 * point.y) * this.canvas.clientHeight}px`;
  }
}

function area(squareMetres: number): string {
  return squareMetres < 0.1 ? `${significant(1e4 * squareMetres, 3)} cm²` : `${significant(squareMetres, 3)} m²`;
}

function metres({ x, y, z }: Vector3): string {
  return [x, y, z].map((v) => v.toFixed(3)).join(", ");
}
