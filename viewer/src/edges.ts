// The edges of elements, as thin lines: the number of the element at every pixel is drawn aside, and lines where it changes. So
// they are edges of elements whatever triangles draw them, and cost nothing while nobody wants to see them.

import {
  BufferAttribute, BufferGeometry, DataTexture, FloatType, GLSL3, Mesh, NearestFilter, OrthographicCamera, type PerspectiveCamera,
  RawShaderMaterial, RedFormat, Scene, WebGLRenderTarget, type WebGLRenderer,
} from "three";
import type { Drawing } from "./drawing";
import edgeLines from "./shaders/edge_lines.frag.glsl";
import edgeNumber from "./shaders/edge_number.frag.glsl";
import screenVertex from "./shaders/screen.vert.glsl";
import surfaceVertex from "./shaders/surface.vert.glsl";

/** Part of the screen: left end and width in pixels. */
export type Strip = [number, number];

export class Edges {
  private readonly areas = { value: null as DataTexture | null };
  private readonly known = new Map<Drawing, DataTexture>();
  private readonly numbers = new RawShaderMaterial({
    glslVersion: GLSL3, vertexShader: surfaceVertex, fragmentShader: edgeNumber, uniforms: { areas: this.areas },
  });
  private readonly target = new WebGLRenderTarget(1, 1, { minFilter: NearestFilter, magFilter: NearestFilter });
  private readonly screen = new Scene();
  private readonly camera = new OrthographicCamera();

  constructor(private readonly renderer: WebGLRenderer) {
    const triangle = new BufferGeometry();
    triangle.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const lines = new RawShaderMaterial({
      glslVersion: GLSL3, vertexShader: screenVertex, fragmentShader: edgeLines, transparent: true, depthTest: false, depthWrite: false,
      uniforms: { numbers: { value: this.target.texture } },
    });
    const mesh = new Mesh(triangle, lines);
    mesh.frustumCulled = false;
    this.screen.add(mesh);
  }

  /** Draws the edges over what is on the screen, each drawing's in its strip. */
  draw(parts: { drawing: Drawing; strip: Strip }[], camera: PerspectiveCamera, width: number, height: number, level: number): void {
    this.target.setSize(width, height);
    this.target.scissorTest = true;
    for (const { drawing, strip } of parts) {
      this.areas.value = this.areasOf(drawing);
      this.target.scissor.set(strip[0], 0, strip[1], height);
      this.renderer.setRenderTarget(this.target);
      this.renderer.clear();
      drawing.draw(this.renderer, camera, this.numbers, level);
    }
    this.renderer.setRenderTarget(null);
    this.renderer.setScissorTest(false);
    this.renderer.render(this.screen, this.camera);
  }

  private areasOf(drawing: Drawing): DataTexture {
    const known = this.known.get(drawing);
    if (known) return known;
    const { width, height } = drawing.elements.image;
    const areas = new Float32Array(width * height);
    areas.set(drawing.surfaces.areas);
    const texture = new DataTexture(areas, width, height, RedFormat, FloatType);
    texture.needsUpdate = true;
    this.known.set(drawing, texture);
    return texture;
  }
}
