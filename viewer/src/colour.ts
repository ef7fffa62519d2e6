// Colours: linear Rec. 709, as everywhere in isolux.

export type Rgb = [number, number, number];

/** Luminance of a colour; of irradiance that is what a luxmeter reads. */
export function luminance(r: number, g: number, b: number): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Linear value of an sRGB channel in [0, 1]. */
export function toLinear(v: number): number {
  return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
}

/** sRGB value in [0, 1] of a linear channel. */
export function toSrgb(v: number): number {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
}

/** Linear colour of `#rrggbb`. */
export function fromHex(text: string): Rgb {
  const channel = (k: number) => toLinear(parseInt(text.slice(1 + 2 * k, 3 + 2 * k), 16) / 255);
  return [channel(0), channel(1), channel(2)];
}

/** `#rrggbb` of a linear colour in [0, 1]. */
export function toHex(colour: Rgb): string {
  const channel = (v: number) => Math.round(255 * toSrgb(Math.min(Math.max(v, 0), 1)));
  return "#" + colour.map((v) => channel(v).toString(16).padStart(2, "0")).join("");
}
