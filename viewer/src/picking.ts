// What is at a point of the screen: the surfaces are drawn once more, into one pixel that holds numbers instead of colours. So what is
// found is what is seen, and nothing has to be built for it.

import {
  GLSL3, NearestFilter, type PerspectiveCamera, RawShaderMaterial, RGBAIntegerFormat, UnsignedIntType, Vector3, WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import type { Rgb } from "./colour";
import type { Drawing } from "./drawing";
import pickFragment from "./shaders/pick.frag.glsl";
import surfaceVertex from "./shaders/surface.vert.glsl";

/** A point on a surface. */
export interface Picked {
  element: number;
  /** World position [m]. */
  position: Vector3;
  /** Irradiance [lux] as it is interpolated there. */
  irradiance: Rgb;
}

export class Picking {
  private readonly what = { value: 0 };
  private readonly material = new RawShaderMaterial({
    glslVersion: GLSL3, vertexShader: surfaceVertex, fragmentShader: pickFragment, uniforms: { what: this.what },
  });
  private readonly target = new WebGLRenderTarget(1, 1, {
    format: RGBAIntegerFormat, type: UnsignedIntType, internalFormat: "RGBA32UI", minFilter: NearestFilter, magFilter: NearestFilter,
  });

  constructor(private readonly renderer: WebGLRenderer) {}

  /** What is at (x, y) of a picture of so many pixels, counted from its upper left corner; nothing where there is no surface. */
  at(drawing: Drawing, camera: PerspectiveCamera, x: number, y: number, width: number, height: number): Picked | undefined {
    camera.setViewOffset(width, height, x - 0.5, y - 0.5, 1, 1);
    const [element, ...light] = this.read(drawing, camera, 0);
    const place = this.read(drawing, camera, 1);
    camera.clearViewOffset();
    if (!element) return undefined;
    const floats = (bits: number[]) => [...new Float32Array(Uint32Array.from(bits).buffer)] as Rgb;
    return { element: element - 1, position: new Vector3(...floats(place.slice(0, 3))), irradiance: floats(light) };
  }

  private read(drawing: Drawing, camera: PerspectiveCamera, what: number): number[] {
    this.what.value = what;
    this.renderer.setRenderTarget(this.target);
    this.renderer.clear();
    drawing.draw(this.renderer, camera, this.material);
    const found = new Uint32Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, found);
    this.renderer.setRenderTarget(null);
    return [...found];
  }
}
