// Two solutions side by side: a divider to drag, with the one before on its left, and a key that flips between them.

import { byId } from "./page";
import type { Viewer } from "./viewer";

/** What one arrow key moves the divider, as a share of the width. */
const STEP = 0.02;

export class Compare {
  private readonly divider = byId("divider");

  constructor(private readonly viewer: Viewer, [after, before]: [string, string]) {
    const { divider } = this;
    byId("compare").hidden = false;
    byId("name-before").textContent = before;
    byId("name-after").textContent = after;
    byId("compare-names").textContent = `Left ${before}, right ${after}`;
    byId("mode-difference-label").hidden = !viewer.sameElements;
    byId("compare-note").hidden = viewer.sameElements;
    byId("flip").addEventListener("click", () => this.flip());
    byId("split").addEventListener("click", () => this.move(0.5));
    divider.addEventListener("pointerdown", (event) => divider.setPointerCapture(event.pointerId));
    divider.addEventListener("pointermove", (event) => {
      if (divider.hasPointerCapture(event.pointerId)) this.move(event.clientX / divider.parentElement!.clientWidth);
    });
    divider.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -STEP, ArrowRight: STEP }[event.key];
      if (!way) return;
      event.preventDefault();
      event.stopPropagation();
      this.move(viewer.settings.divider + way);
    });
    viewer.drawn.push(() => this.place());
  }

  /** Shows the one alone, then the other. */
  flip(): void {
    this.move(this.viewer.settings.divider >= 1 ? 0 : 1);
  }

  /** Puts the divider at this share of the width. */
  move(share: number): void {
    this.viewer.settings.divider = Math.min(Math.max(share, 0), 1);
    this.viewer.update();
  }

  private place(): void {
    const { divider } = this.viewer.settings;
    this.divider.hidden = this.viewer.isDifference;
    this.divider.style.left = `${100 * divider}%`;
    this.divider.setAttribute("aria-valuenow", String(Math.round(100 * divider)));
    byId("name-before").hidden = this.viewer.isDifference || divider < 0.05;
    byId("name-after").hidden = this.viewer.isDifference || divider > 0.95;
  }
}
