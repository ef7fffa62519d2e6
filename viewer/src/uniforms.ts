// What all surfaces are drawn with: uniforms that their materials share.

import { DataTexture, FloatType, LinearFilter, type Texture } from "three";
import { RGBAFormat, Vector2 } from "three";
import type { Settings } from "./settings";
import { MOST_LEVELS, type PaletteName, texels } from "./scale";

/** What is shown of the surfaces; the numbers are those of surface.frag.glsl. */
export const MODES = { light: 0, illuminance: 1, error: 2, difference: 3 } as const;
export type Mode = keyof typeof MODES;

/** Uniforms of all materials. */
export const shared = {
  exposure: { value: 1 },
  relativeError: { value: true },
  palette: { value: null as Texture | null },
  range: { value: new Vector2(0, 1) },
  logarithmic: { value: false },
  levelCount: { value: 0 },
  levels: { value: new Float32Array(MOST_LEVELS) },
  lineWidth: { value: 1.5 },
};

/** What the programs of all surfaces are compiled for. */
export function choices({ mode, byElement, textured }: Settings, hasLines: boolean): Record<string, string | number> {
  return {
    MODE: MODES[mode],
    ...(byElement && { BY_ELEMENT: "" }),
    ...(textured && { TEXTURED: "" }),
    ...(hasLines && { LINES: "" }),
  };
}

const PALETTE_SIZE = 256;
const palettes = new Map<PaletteName, Texture>();

/** A row of the colours of a palette. */
export function paletteTexture(name: PaletteName): Texture {
  const known = palettes.get(name);
  if (known) return known;
  const texture = new DataTexture(texels(name, PALETTE_SIZE), PALETTE_SIZE, 1, RGBAFormat);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  palettes.set(name, texture);
  return texture;
}

/** A texture with a texel of four floats for each element; shaders find it by its number. */
export function elementTexture(elements: number, most: number): DataTexture {
  const width = Math.min(4096, most);
  const height = Math.max(1, Math.ceil(elements / width));
  return new DataTexture(new Float32Array(4 * width * height), width, height, RGBAFormat, FloatType);
}
