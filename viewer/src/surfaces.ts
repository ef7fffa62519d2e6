// The surfaces: which triangles are drawn, where they are, and what is on them.

import type { Rgb } from "./colour";
import { nearby } from "./nearby";
import type { Part } from "./part";

type Wrap = "repeat" | "mirror" | "clamp";

export interface TextureHeader {
  image: number;
  wrap: [Wrap, Wrap];
}

/** Triangles that reflect and emit alike. */
export interface Batch {
  material: string;
  reflectivity: Rgb;
  reflectivity_texture: TextureHeader | null;
  /** Exitance [lm/m²] at factor 1 of the group. */
  emission: Rgb;
  emission_texture: TextureHeader | null;
  /** The light group that they belong to. */
  group: number | null;
  /** Triangles. */
  first: number;
  count: number;
}

export interface CameraHeader {
  name: string;
  position: Rgb;
  forward: Rgb;
  up: Rgb;
  /** Full vertical angle [rad] of a perspective camera, and height [m] of the picture of an orthographic one. */
  vertical_angle: number | null;
  height: number | null;
  aspect: number | null;
}

export interface SurfacesHeader {
  name: string;
  elements: number;
  vertices: number;
  triangles: number;
  bounds: { center: Rgb; radius: number };
  objects: string[];
  batches: Batch[];
  cameras: CameraHeader[];
}

/** The arrays of a part. */
export class Surfaces {
  readonly header: SurfacesHeader;
  readonly positions: Float32Array;
  readonly uv: Float32Array | undefined;
  readonly emissionUv: Float32Array | undefined;
  readonly tint: Float32Array | undefined;
  /** Three vertices of every triangle. */
  readonly indices: Uint32Array;
  /** Element of every triangle. */
  readonly elementOf: Uint32Array;
  /** Of every element: area [m²], face (twice the number of its object, and one more on its back), mean reflectivity. */
  readonly areas: Float32Array;
  readonly faceOf: Uint32Array;
  readonly reflectivities: Float32Array;
  /** Name of the material of every object. */
  readonly materialOf: string[] = [];
  private readonly part: Part<SurfacesHeader>;

  constructor(part: Part<SurfacesHeader>) {
    const floats = (name: string) => (part.has(name) ? part.floats(name) : undefined);
    this.part = part;
    this.header = part.header;
    this.positions = part.floats("position");
    this.uv = floats("uv");
    this.emissionUv = floats("emission_uv");
    this.tint = floats("tint");
    const [indices, elementOf] = [part.numbers("index"), part.numbers("triangle_element")];
    const order = nearby(part.header.batches, indices, this.positions);
    this.elementOf = order.map((t) => elementOf[t]!);
    this.indices = new Uint32Array(indices.length).map((_, k) => indices[3 * order[Math.floor(k / 3)]! + (k % 3)]!);
    this.areas = part.floats("area");
    this.faceOf = part.numbers("face");
    this.reflectivities = part.floats("reflectivity");
    for (const { material, first, count } of part.header.batches) {
      for (let t = first; t < first + count; t++) this.materialOf[this.objectOf(this.elementOf[t]!)] = material;
    }
  }

  /** Number of the object of an element. */
  objectOf(element: number): number {
    return this.faceOf[element]! >> 1;
  }

  /** The image of a texture. */
  image(number: number): Promise<ImageBitmap> {
    const blob = new Blob([this.part.file(`image ${number}`)]);
    return createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  }
}
