// The illuminance all over the picture, coarsely: the surfaces are drawn once more, into a few pixels that hold numbers.

import { GLSL3, NearestFilter, RawShaderMaterial, RGBAIntegerFormat, UnsignedIntType, Vector3, WebGLRenderTarget } from "three";
import luxFragment from "./shaders/lux.frag.glsl";
import surfaceVertex from "./shaders/surface.vert.glsl";
import type { Viewer } from "./viewer";

/** Pixels of the page between samples. */
export const STEP = 4;

export class LuxMap {
  width = 0;
  height = 0;
  private samples = new Float32Array();
  private readonly material = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: surfaceVertex, fragmentShader: luxFragment });
  private readonly target = new WebGLRenderTarget(1, 1, {
    format: RGBAIntegerFormat, type: UnsignedIntType, internalFormat: "RGBA32UI", minFilter: NearestFilter, magFilter: NearestFilter,
  });

  /** Samples what `viewer` shows. */
  take(viewer: Viewer): void {
    const { renderer, camera } = viewer;
    const { clientWidth, clientHeight } = renderer.domElement;
    [this.width, this.height] = [Math.ceil(clientWidth / STEP), Math.ceil(clientHeight / STEP)];
    this.target.setSize(this.width, this.height);
    this.target.scissorTest = true;
    for (const { drawing, strip: [left, wide] } of viewer.parts(clientWidth)) {
      this.target.scissor.set(Math.round(left / STEP), 0, Math.ceil(wide / STEP), this.height);
      renderer.setRenderTarget(this.target);
      renderer.clear();
      drawing.draw(renderer, camera.camera, this.material);
    }
    const bits = new Uint32Array(4 * this.width * this.height);
    renderer.readRenderTargetPixels(this.target, 0, 0, this.width, this.height, bits);
    renderer.setRenderTarget(null);
    this.samples = new Float32Array(bits.buffer);
  }

  /** Illuminance [lux] at a sample, counted from the upper left; NaN beside the surfaces. */
  lux(x: number, y: number): number {
    const at = this.at(x, y);
    const isSurface = at !== undefined && [0, 1, 2, 3].some((k) => this.samples[at + k] !== 0);
    return isSurface ? this.samples[at + 3]! : NaN;
  }

  /** The point of the surface there. */
  position(x: number, y: number): Vector3 {
    return new Vector3().fromArray(this.samples, this.at(x, y) ?? 0);
  }

  private at(x: number, y: number): number | undefined {
    const [column, row] = [Math.round(x), this.height - 1 - Math.round(y)];
    return column >= 0 && column < this.width && row >= 0 && row < this.height ? 4 * (row * this.width + column) : undefined;
  }
}
