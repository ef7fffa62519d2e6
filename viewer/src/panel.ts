// The panel: every control of the page, and the keys that do the same.

import { byId, isTyping, make } from "./page";
import type { Viewer } from "./viewer";
import type { Mode } from "./uniforms";

type Toggle = "textured" | "lines" | "edges" | "byElement" | "logarithmic";
const TOGGLES: [Toggle, string][] = [
  ["textured", "t"], ["lines", "i"], ["edges", "m"], ["byElement", "v"], ["logarithmic", "k"],
];
const MODE_KEYS: Record<string, Mode> = { 1: "light", 2: "illuminance", 3: "error", 4: "difference" };
/** What a key changes the exposure by [stops]. */
const STOP = 0.25;

/** What keys do that belong to other parts of the page. */
export interface Actions {
  screenshot: () => void;
  flip: () => void;
  clearReading: () => void;
}

export class Panel {
  private readonly exposure = byId<HTMLInputElement>("exposure");
  private readonly low = byId<HTMLInputElement>("low");
  private readonly high = byId<HTMLInputElement>("high");
  private readonly help = byId<HTMLDialogElement>("help");

  constructor(private readonly viewer: Viewer, private readonly actions: Actions) {
    this.connect();
    this.cameras();
    window.addEventListener("keydown", (event) => this.press(event));
    viewer.drawn.push(() => this.write());
  }

  setMode(mode: Mode): void {
    if (mode === "difference" && !this.viewer.sameElements) return;
    this.viewer.settings.mode = mode;
    byId<HTMLInputElement>(`mode-${mode}`).checked = true;
    this.viewer.update();
  }

  private setStops(stops: number): void {
    this.viewer.settings.stops = Math.min(Math.max(stops, -8), 8);
    this.viewer.update();
  }

  private toggle(name: Toggle): void {
    this.viewer.settings[name] = !this.viewer.settings[name];
    this.viewer.update();
  }

  private connect(): void {
    const { viewer } = this;
    const { settings } = viewer;
    for (const mode of Object.values(MODE_KEYS)) byId(`mode-${mode}`).addEventListener("change", () => this.setMode(mode));
    for (const [name] of TOGGLES) byId(name).addEventListener("change", () => this.toggle(name));
    this.exposure.addEventListener("input", () => this.setStops(Number(this.exposure.value)));
    byId("exposure-reset").addEventListener("click", () => this.setStops(0));
    for (const relative of [true, false]) {
      byId(relative ? "error-percent" : "error-lux").addEventListener("change", () => {
        settings.relativeError = relative;
        delete settings.ends.error;
        viewer.update();
      });
    }
    for (const field of [this.low, this.high]) {
      field.addEventListener("change", () => this.setEnds());
      field.addEventListener("blur", () => viewer.update());
    }
    byId("range-auto").addEventListener("click", () => {
      settings.ends = {};
      viewer.update();
    });
    byId("orbit").addEventListener("change", () => this.setWalking(false));
    byId("walk").addEventListener("change", () => this.setWalking(true));
    byId("screenshot").addEventListener("click", () => this.actions.screenshot());
    byId("help-open").addEventListener("click", () => this.help.showModal());
    byId("help-close").addEventListener("click", () => this.help.close());
    byId("panel-toggle").addEventListener("click", () => this.fold());
    if (window.innerWidth < 700) this.fold();
  }

  /** The ends of the scale as they are written; nonsense is put right. */
  private setEnds(): void {
    const { settings, scale } = this.viewer;
    const [low, high] = [Number(this.low.value), Number(this.high.value)];
    const fits = Number.isFinite(low) && Number.isFinite(high) && low < high && (low > 0 || !scale.logarithmic);
    const mode = settings.mode === "light" ? "illuminance" : settings.mode;
    if (fits) settings.ends[mode] = { low, high };
    this.viewer.update();
  }

  private cameras(): void {
    const select = byId<HTMLSelectElement>("camera");
    const { cameras } = this.viewer.after.surfaces.header;
    select.replaceChildren(...cameras.map(({ name }, k) => make("option", { textContent: name || `Camera ${k}`, value: String(k) })));
    select.value = String(this.viewer.after.light.header.camera);
    const take = () => this.viewer.takeCamera(Number(select.value));
    select.addEventListener("change", take);
    byId("camera-reset").addEventListener("click", take);
  }

  private setWalking(walking: boolean): void {
    byId<HTMLInputElement>(walking ? "walk" : "orbit").checked = true;
    this.viewer.camera.setWalking(walking, this.viewer.ahead());
    this.viewer.update();
  }

  /** Shows the panel, or its head alone. */
  private fold(): void {
    const isFolded = document.body.classList.toggle("folded");
    byId("panel-toggle").setAttribute("aria-expanded", String(!isFolded));
  }

  /** Writes into the controls what is set. */
  private write(): void {
    const { settings, scale, stops } = this.viewer;
    const sign = settings.stops < 0 ? "−" : "+";
    this.exposure.value = String(settings.stops);
    byId("exposure-value").textContent = settings.stops === 0 ? "automatic" : `${sign}${Math.abs(settings.stops).toFixed(2)} stops`;
    this.exposure.title = `Luminance times 2^${stops.toFixed(2)}; EV100 ${(-stops - Math.log2(1.2)).toFixed(1)}`;
    for (const [name] of TOGGLES) byId<HTMLInputElement>(name).checked = settings[name];
    for (const field of [this.low, this.high]) {
      if (document.activeElement !== field) field.value = String(field === this.low ? scale.low : scale.high);
    }
    const hasScale = settings.mode !== "light" || settings.lines;
    const show = (id: string, shown: boolean) => (byId(id).hidden = !shown);
    show("section-exposure", settings.mode === "light");
    show("section-scale", hasScale);
    show("section-error", settings.mode === "error");
    show("logarithmic-label", settings.mode !== "difference");
    show("textured-label", settings.mode === "light");
    show("lines-label", settings.mode === "light" || settings.mode === "illuminance");
    show("byElement-label", settings.mode !== "error");
  }

  private press(event: KeyboardEvent): void {
    if (this.help.open || isTyping(event) || event.ctrlKey || event.metaKey || event.altKey) return;
    const key = event.key.toLowerCase();
    const toggle = TOGGLES.find(([, of]) => of === key);
    if (toggle) this.toggle(toggle[0]);
    else if (key in MODE_KEYS) this.setMode(MODE_KEYS[key]!);
    else if (key === "[") this.setStops(this.viewer.settings.stops - STOP);
    else if (key === "]") this.setStops(this.viewer.settings.stops + STOP);
    else if (key === "o") this.setWalking(!this.viewer.camera.isWalking);
    else if (key === "r") byId("camera-reset").click();
    else if (key === "p") this.actions.screenshot();
    else if (key === "x") this.actions.flip();
    else if (key === "h") this.fold();
    else if (key === "?") this.help.showModal();
    else if (key === "escape") this.actions.clearReading();
    else return;
    event.preventDefault();
  }
}
