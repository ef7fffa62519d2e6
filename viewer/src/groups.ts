// Light groups: a slider and a colour for each, which dim its lamps without solving again.

import { fromHex, type Rgb, toHex } from "./colour";
import { byId, make } from "./page";
import type { Drawing } from "./drawing";

/** What a slider reaches. */
const MOST = 2;

/** What one has set for a group: times so much, through a filter. */
interface Setting {
  level: number;
  filter: Rgb;
}

export class Groups {
  private settings: Setting[] = [];
  private isWaiting = false;
  private readonly list = byId("groups-list");

  /** Sliders for the groups of `drawing`; `changed` is called when they are moved. None, and no trace of them, if it has no groups. */
  constructor(private readonly drawing: Drawing, private readonly changed: () => void) {
    byId("groups").hidden = !drawing.light.header.has_groups;
    if (!drawing.light.header.has_groups) return;
    byId("groups-reset").addEventListener("click", () => {
      this.settings = this.asSolved();
      this.show();
      this.apply();
    });
    this.settings = this.asSolved();
    this.show();
  }

  /** Gives the light, which may be new, the factors that were set. */
  keep(): void {
    this.settings.forEach(({ level, filter }, g) => (this.drawing.light.factors[g] = filter.map((v) => v * level) as Rgb));
  }

  private asSolved(): Setting[] {
    return this.drawing.light.header.groups.map(({ factor }) => {
      const level = Math.max(...factor);
      return { level, filter: level > 0 ? (factor.map((v) => v / level) as Rgb) : [1, 1, 1] };
    });
  }

  private show(): void {
    const rows = this.settings.map((setting, g) => this.row(setting, this.drawing.light.header.groups[g]!.name, g));
    this.list.replaceChildren(...rows);
  }

  private row(setting: Setting, name: string, g: number): HTMLElement {
    const id = `group-${g}`;
    const value = make("output", { textContent: setting.level.toFixed(2) });
    const slider = make("input", { type: "range", id, min: "0", max: String(Math.max(MOST, setting.level)), step: "0.01" });
    slider.value = String(setting.level);
    const filter = make("input", { type: "color", value: toHex(setting.filter), title: `Colour filter of ${name}` });
    filter.setAttribute("aria-label", `Colour filter of ${name}`);
    slider.addEventListener("input", () => {
      setting.level = Number(slider.value);
      value.textContent = setting.level.toFixed(2);
      this.apply();
    });
    filter.addEventListener("input", () => {
      setting.filter = fromHex(filter.value);
      this.apply();
    });
    const label = make("label", { htmlFor: id, textContent: name, title: name });
    return make("div", { className: "group" }, label, slider, value, filter);
  }

  /** Lights the picture anew, once a frame however often a slider moves. */
  private apply(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.keep();
      this.changed();
    });
  }
}
