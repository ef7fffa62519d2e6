// The legend: the colours with their values, in the lower left corner. It is drawn, so that screenshots have it, too.

import { short } from "./numbers";
import { byId } from "./page";
import { levels, PALETTES, position } from "./scale";
import type { Viewer } from "./viewer";

const [WIDTH, BAR] = [132, 16];
const [TOP, BOTTOM, LEFT] = [30, 12, 12];
/** Height of the whole, on a desk and on a phone. */
const [TALL, SHORT] = [264, 190];

/** What the values are, and how the unit is called. */
function title(viewer: Viewer): string {
  switch (viewer.palette) {
    case "error":
      return viewer.settings.relativeError ? "Std. error [%]" : "Std. error [lx]";
    case "difference":
      return "Difference [lx]";
    default:
      return "Illuminance [lx]";
  }
}

export class Legend {
  readonly canvas = byId<HTMLCanvasElement>("legend");

  constructor(private readonly viewer: Viewer) {
    viewer.drawn.push(() => this.draw());
  }

  private draw(): void {
    const { settings, scale } = this.viewer;
    const isLight = settings.mode === "light";
    this.canvas.hidden = isLight && !settings.lines;
    if (this.canvas.hidden) return;
    const values = levels(scale);
    const height = window.innerWidth < 700 ? SHORT : TALL;
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.canvas.width = WIDTH * ratio;
    this.canvas.height = height * ratio;
    this.canvas.style.width = `${WIDTH}px`;
    this.canvas.style.height = `${height}px`;
    this.canvas.setAttribute("aria-label", `${title(this.viewer)} from ${scale.low} to ${scale.high}`);
    const context = this.canvas.getContext("2d")!;
    context.scale(ratio, ratio);
    context.fillStyle = "rgba(20, 21, 23, 0.86)";
    context.beginPath();
    context.roundRect(0, 0, WIDTH, height, 8);
    context.fill();
    context.font = "600 11px system-ui, sans-serif";
    context.fillStyle = "#e8e8e6";
    context.fillText(title(this.viewer), LEFT, 19);
    const length = height - TOP - BOTTOM;
    const at = (value: number) => TOP + length * (1 - position(scale, value));
    if (!isLight) {
      for (let y = 0; y < length; y++) {
        context.fillStyle = PALETTES[this.viewer.palette](1 - (y + 0.5) / length);
        context.fillRect(LEFT, TOP + y, BAR, 1.5);
      }
    }
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    let above = Infinity;
    for (const value of values) {
      const y = at(value);
      context.fillStyle = isLight || settings.lines ? "#ffffff" : "#9a9a96";
      context.fillRect(isLight ? LEFT : LEFT + BAR - 4, y - 0.5, isLight ? BAR : 8, 1);
      // Where two would overlap only the lower one is written.
      if (above - y < 12) continue;
      context.fillStyle = "#c9c9c5";
      context.fillText(short(value), LEFT + BAR + 10, Math.min(Math.max(y, TOP + 2), height - BOTTOM - 2));
      above = y;
    }
  }
}
