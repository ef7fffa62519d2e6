// Drafts: the picture with fewer pixels and coarser surfaces, for cameras that move where the whole takes too long.

import { Governor } from "./governor";

/** Pixels for each of the page, along each side, and the level of detail. */
export interface Draft {
  pixels: number;
  level: number;
}

/** Fewest pixels for each of the page, along each side. */
const FEWEST_PIXELS = 0.35;
/** Pixels that a triangle has, if neither are too many. */
const PER_TRIANGLE = 4;
/** What a machine without a graphics card begins with. */
const SOFTWARE = { pixels: 0.5, triangles: 50_000 };

/** Steps down from the whole picture of a `size` in pixels of the page, each of half the pixels or of a coarser level: of what there is too much. */
export function steps(pixels: number, size: number, triangles: number[]): Draft[] {
  const found: Draft[] = [];
  for (let halvings = 0, level = 0; ; ) {
    const few = pixels / 2 ** (halvings / 2);
    found.push({ pixels: few, level });
    const areFewest = few < FEWEST_PIXELS * Math.SQRT2;
    const isCoarsest = level === triangles.length - 1;
    if (areFewest && isCoarsest) return found;
    const isCrowded = PER_TRIANGLE * triangles[level]! > size * few ** 2;
    if (areFewest || (isCrowded && !isCoarsest)) level++;
    else halvings++;
  }
}

/** Which draft is due. */
export class Drafts {
  private known = "";
  private steps: Draft[] = [];
  private governor = new Governor(1);

  constructor(private readonly isSoftware: boolean) {}

  /** Begins anew if there are other levels, or the picture has another size. */
  fit(pixels: number, size: number, triangles: number[]): void {
    const key = [pixels, size, ...triangles].join();
    if (key === this.known) return;
    this.known = key;
    this.steps = steps(pixels, size, triangles);
    const isLight = ({ pixels, level }: Draft) => pixels < 1.01 * SOFTWARE.pixels && triangles[level]! <= SOFTWARE.triangles;
    const first = this.steps.findIndex(isLight);
    this.governor = new Governor(this.steps.length, this.isSoftware ? (first < 0 ? this.steps.length - 1 : first) : 0);
  }

  /** The draft that is due; the whole picture, if there is time for it. */
  get due(): Draft {
    return this.steps[this.governor.step]!;
  }

  /** The draft that was drawn last took so many milliseconds. */
  took(ms: number): void {
    this.governor.took(ms);
  }

  /** Something else was drawn. */
  pause(): void {
    this.governor.pause();
  }
}
