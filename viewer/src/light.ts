// The light on the surfaces: irradiance at vertices and on elements, with errors; a set for each group of lamps.
//
//     E = sum of f_g E_g,    V = sum of f_g² V_g        by channel
//
// as crates/core/src/superposition.rs has it, so that what is read here is what `isolux mix` would write.

import { luminance, type Rgb } from "./colour";
import type { Part } from "./part";
import { studentsT } from "./student";

/** Of an object, in the summary. */
export interface ObjectSummary {
  object: number;
  name: string;
  /** Which side of it, if it has two. */
  side: "front" | "back" | null;
  area: number;
  mean: number;
  min: number;
  max: number;
  mean_error: { std_error: number; freedom: number } | null;
}

/** The text of a .json file. */
export interface Summary {
  version: string;
  scene: { name: string };
  elements: number;
  method: string;
  parameters: Record<string, string>;
  seed: number;
  rays: number;
  replicates: number;
  rms_error_estimate: number | null;
  mean: number | null;
  mean_error: { std_error: number; freedom: number } | null;
  objects: ObjectSummary[];
}

export interface LightHeader {
  exposure_stops: number;
  /** Number of the camera to begin with. */
  camera: number;
  smoothing: string;
  /** For 1, 2, 3 ... degrees of freedom, two-sided 95 %. */
  students_t: number[];
  has_groups: boolean;
  groups: { name: string; factor: Rgb; freedom: number | null }[];
  summary: Summary;
}

/** Lamps that are dimmed together; irradiances are at factor 1. */
interface Group {
  freedom: number;
  /** Irradiance [lux] at the vertices, and on the elements with its standard errors: red, green, blue. */
  vertices: Float32Array;
  elements: Float32Array;
  errors: Float32Array;
}

/** What is known of the light on an element. */
export interface Reading {
  /** Irradiance [lux] by channel, and its luminance. */
  irradiance: Rgb;
  lux: number;
  /** Standard error of the luminance [lux], and the margin with 95 % confidence; not a number if unknown. */
  stdError: number;
  margin: number;
}

export class Light {
  readonly header: LightHeader;
  /** How many times each group emits what it did when it was solved. */
  readonly factors: Rgb[];
  private readonly groups: Group[];

  /** Light that has no numbers of its own is that of `other`, with the lamps dimmed otherwise. */
  constructor(part: Part<LightHeader>, other?: Light) {
    this.header = part.header;
    this.factors = part.header.groups.map((group) => [...group.factor]);
    if (other && !part.has("irradiance 0")) {
      this.groups = other.groups;
      return;
    }
    this.groups = part.header.groups.map(({ freedom }, k) => ({
      freedom: freedom ?? NaN,
      vertices: part.floats(`vertex irradiance ${k}`),
      elements: part.floats(`irradiance ${k}`),
      errors: part.floats(`std_error ${k}`),
    }));
  }

  /** Whether the lamps are as in the file. */
  get isAsSolved(): boolean {
    return this.header.groups.every(({ factor }, g) => factor.every((v, c) => Math.abs(v - this.factors[g]![c]!) <= 1e-6 * v));
  }

  /** Irradiance [lux] at all vertices. */
  atVertices(): Float32Array {
    return this.sum((group) => group.vertices);
  }

  /** Irradiance [lux] on all elements. */
  onElements(): Float32Array {
    return this.sum((group) => group.elements);
  }

  /** Standard error of the luminance [lux] of all elements. */
  errorsOnElements(): Float32Array {
    const count = this.groups[0]!.errors.length / 3;
    return Float32Array.from({ length: count }, (_, e) => luminance(...this.error(e)));
  }

  /** What is known of the light on element `e`. */
  reading(e: number): Reading {
    const irradiance: Rgb = [0, 1, 2].map((c) => {
      let sum = 0;
      this.lit().forEach(({ group, factor }) => (sum += group.elements[3 * e + c]! * factor[c]!));
      return sum;
    }) as Rgb;
    const stdError = luminance(...this.error(e));
    const margin = stdError * studentsT(this.header.students_t, this.freedom(e));
    return { irradiance, lux: luminance(...irradiance), stdError, margin };
  }

  /** Standard error [lux] on element `e`, by channel. */
  private error(e: number): Rgb {
    const variance: Rgb = [0, 0, 0];
    for (const { group, factor } of this.lit()) {
      for (let c = 0; c < 3; c++) variance[c]! += (group.errors[3 * e + c]! * factor[c]!) ** 2;
    }
    return variance.map(Math.sqrt) as Rgb;
  }

  /** Degrees of freedom of the error on element `e` (Welch, Satterthwaite). */
  private freedom(e: number): number {
    let [all, parts] = [0, 0];
    const lit = this.lit();
    if (lit.length === 1) return lit[0]!.group.freedom;
    for (const { group, factor } of lit) {
      const [r, g, b] = [0, 1, 2].map((c) => group.errors[3 * e + c]! * factor[c]!) as Rgb;
      const variance = luminance(r, g, b) ** 2;
      all += variance;
      parts += variance ** 2 / group.freedom;
    }
    return all ** 2 / parts;
  }

  /** The groups that are switched on. */
  private lit(): { group: Group; factor: Rgb }[] {
    const all = this.groups.map((group, g) => ({ group, factor: this.factors[g]! }));
    return all.filter(({ factor }) => factor.some((v) => v > 0));
  }

  private sum(of: (group: Group) => Float32Array): Float32Array {
    const sum = new Float32Array(of(this.groups[0]!).length);
    for (const { group, factor } of this.lit()) {
      const [r, g, b] = factor;
      const light = of(group);
      for (let k = 0; k < sum.length; k += 3) {
        sum[k]! += light[k]! * r;
        sum[k + 1]! += light[k + 1]! * g;
        sum[k + 2]! += light[k + 2]! * b;
      }
    }
    return sum;
  }
}
