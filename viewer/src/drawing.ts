// The surfaces of a solution in three.js: a mesh with draw calls for each batch, and the light on it.

import {
  BufferAttribute, BufferGeometry, ClampToEdgeWrapping, type DataTexture, GLSL3, type IUniform, type Material, Mesh, MirroredRepeatWrapping,
  type PerspectiveCamera, RawShaderMaterial, RepeatWrapping, Scene, SRGBColorSpace, Texture, Vector3, type WebGLRenderer,
} from "three";
import { luminance, toLinear } from "./colour";
import { Details } from "./details";
import type { Light } from "./light";
import type { Pieces } from "./pieces";
import { gather, provoke, type Provoked } from "./provoking";
import surfaceFragment from "./shaders/surface.frag.glsl";
import surfaceVertex from "./shaders/surface.vert.glsl";
import tone from "./shaders/tone.glsl";
import type { Batch, Surfaces, TextureHeader } from "./surfaces";
import { elementTexture, shared } from "./uniforms";

const WRAPPING = { repeat: RepeatWrapping, mirror: MirroredRepeatWrapping, clamp: ClampToEdgeWrapping };

/** A texture, and its mean colour for those who switch textures off. */
interface Image {
  texture: Texture;
  mean: Vector3;
}

export class Drawing {
  readonly surfaces: Surfaces;
  light: Light;
  private readonly scene = new Scene();
  private readonly geometry = new BufferGeometry();
  /** Its triangles, finer and coarser. */
  readonly details: Details;
  /** Of every element: irradiance [lux], and the standard error of its luminance. */
  readonly elements: DataTexture;
  /** Luminance [lux] of the irradiance of every element, and its standard error. */
  lux: Float32Array = new Float32Array();
  errors: Float32Array = new Float32Array();
  /** Area [m²] of every element that is drawn; 0 of the others. */
  readonly seen: Float32Array;
  private readonly source: Uint32Array;
  /** What each material is made with, whatever is chosen; and what is chosen. */
  private readonly materials: { material: RawShaderMaterial; defines: Record<string, string> }[] = [];
  private chosen = "";
  private readonly emissions: { batch: Batch; uniform: IUniform<Vector3> }[] = [];

  private constructor(surfaces: Surfaces, light: Light, renderer: WebGLRenderer, other: Drawing | undefined) {
    this.surfaces = surfaces;
    this.light = light;
    this.seen = new Float32Array(surfaces.areas.length);
    for (const e of surfaces.elementOf) this.seen[e] = surfaces.areas[e]!;
    this.elements = elementTexture(surfaces.header.elements, renderer.capabilities.maxTextureSize);
    if (other && other.surfaces === surfaces) {
      this.source = this.borrow(other);
      this.details = other.details;
    } else {
      const { indices, source } = this.build(provokingCorner(renderer));
      this.source = source;
      this.details = new Details(surfaces, indices);
    }
    this.geometry.setAttribute("irradiance", new BufferAttribute(new Float32Array(3 * this.source.length), 3));
  }

  /** Makes vertices whose values are flat over triangles at this corner; of which vertex of the surfaces each is a copy. */
  private build(corner: 0 | 2): Provoked {
    const { indices, elementOf, positions, uv, emissionUv, tint } = this.surfaces;
    const provoked = provoke(indices, elementOf, positions.length / 3, corner);
    const { source, element } = provoked;
    const add = (name: string, values: Float32Array | undefined, size: number) =>
      values && this.geometry.setAttribute(name, new BufferAttribute(gather(values, size, source), size));
    this.geometry.setAttribute("element", new BufferAttribute(element, 1));
    add("position", positions, 3);
    add("uv", uv, 2);
    add("emissionUv", emissionUv, 2);
    add("tint", tint, 3);
    return provoked;
  }

  /** Takes the vertices of another drawing of the same surfaces, whose light is that before. */
  private borrow(other: Drawing): Uint32Array {
    for (const [name, attribute] of Object.entries(other.geometry.attributes)) {
      this.geometry.setAttribute(name === "irradiance" ? "irradianceBefore" : name, attribute);
    }
    return other.source;
  }

  /** The surfaces with light on them; if `other` has the same, it lends its geometry, and differences to it can be shown. */
  static async make(surfaces: Surfaces, light: Light, renderer: WebGLRenderer, other?: Drawing): Promise<Drawing> {
    const drawing = new Drawing(surfaces, light, renderer, other);
    const materials: RawShaderMaterial[] = [];
    const images = new Map<string, Promise<Image>>();
    for (const batch of surfaces.header.batches) {
      materials.push(await drawing.material(batch, images, renderer, other));
    }
    const mesh = new Mesh(drawing.geometry, materials);
    mesh.frustumCulled = false;
    mesh.matrixAutoUpdate = false;
    drawing.scene.add(mesh);
    drawing.relight();
    return drawing;
  }

  /** Draws what `camera` sees of it at a level of detail (0 has all); everything in `material`, if one is given. */
  draw(renderer: WebGLRenderer, camera: PerspectiveCamera, material: Material | null = null, level = 0): void {
    const { index, chunks } = this.details.level(level);
    this.geometry.setIndex(index);
    this.geometry.groups = chunks.seenBy(camera);
    this.scene.overrideMaterial = material;
    renderer.render(this.scene, camera);
  }

  /** Finds coarser levels of its surfaces, in pieces. */
  findLevels(): Pieces<void> {
    const light = this.light.atVertices();
    return this.details.find(Float32Array.from({ length: light.length / 3 }, (_, v) => luminance(light[3 * v]!, light[3 * v + 1]!, light[3 * v + 2]!)));
  }

  /** Takes programs that are compiled for these choices. */
  choose(choices: Record<string, string | number>): void {
    const key = JSON.stringify(choices);
    if (key === this.chosen) return;
    this.chosen = key;
    for (const { material, defines } of this.materials) {
      material.defines = { ...defines, ...choices };
      material.needsUpdate = true;
    }
  }

  /** Shows the light as it is now: after new light came, or lamps were dimmed. */
  relight(): void {
    const vertices = this.geometry.getAttribute("irradiance") as BufferAttribute;
    (vertices.array as Float32Array).set(gather(this.light.atVertices(), 3, this.source));
    vertices.needsUpdate = true;

    const irradiance = this.light.onElements();
    const texels = this.elements.image.data as Float32Array;
    this.errors = this.light.errorsOnElements();
    this.lux = new Float32Array(this.errors.length);
    for (let e = 0; e < this.lux.length; e++) {
      const [r, g, b] = [irradiance[3 * e]!, irradiance[3 * e + 1]!, irradiance[3 * e + 2]!];
      this.lux[e] = luminance(r, g, b);
      texels[4 * e] = r;
      texels[4 * e + 1] = g;
      texels[4 * e + 2] = b;
      texels[4 * e + 3] = this.errors[e]!;
    }
    this.elements.needsUpdate = true;

    for (const { batch, uniform } of this.emissions) {
      const factor = batch.group === null ? [1, 1, 1] : this.light.factors[batch.group]!;
      uniform.value.set(...(batch.emission.map((v, c) => v * factor[c]!) as [number, number, number]));
    }
  }

  private async material(
    batch: Batch,
    images: Map<string, Promise<Image>>,
    renderer: WebGLRenderer,
    other: Drawing | undefined,
  ): Promise<RawShaderMaterial> {
    const image = (header: TextureHeader) => {
      const key = JSON.stringify(header);
      const found = images.get(key) ?? this.image(header, renderer);
      images.set(key, found);
      return found;
    };
    const defines: Record<string, string> = {};
    const emission = { value: new Vector3() };
    const uniforms: Record<string, IUniform> = {
      ...shared,
      elements: { value: this.elements },
      elementsBefore: { value: other?.elements ?? this.elements },
      reflectivity: { value: new Vector3(...batch.reflectivity) },
      emission,
    };
    this.emissions.push({ batch, uniform: emission });
    if (this.surfaces.tint) defines.HAS_TINT = "";
    if (this.geometry.hasAttribute("irradianceBefore")) defines.HAS_BEFORE = "";
    if (batch.reflectivity_texture) {
      const { texture, mean } = await image(batch.reflectivity_texture);
      defines.HAS_UV = "";
      Object.assign(uniforms, { reflectivityMap: { value: texture }, reflectivityMean: { value: mean } });
    }
    if (batch.emission_texture) {
      const { texture, mean } = await image(batch.emission_texture);
      defines.HAS_EMISSION_UV = "";
      Object.assign(uniforms, { emissionMap: { value: texture }, emissionMean: { value: mean } });
    }
    const material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: surfaceVertex,
      fragmentShader: surfaceFragment.replace("out vec4 colour;", `out vec4 colour;\n${tone}`),
      defines,
      uniforms,
    });
    this.materials.push({ material, defines });
    return material;
  }

  private async image({ image, wrap: [wrapU, wrapV] }: TextureHeader, renderer: WebGLRenderer): Promise<Image> {
    const bitmap = await this.surfaces.image(image);
    const texture = new Texture(bitmap);
    texture.flipY = false;
    texture.colorSpace = SRGBColorSpace;
    texture.wrapS = WRAPPING[wrapU];
    texture.wrapT = WRAPPING[wrapV];
    texture.anisotropy = Math.min(8, renderer.capabilities.getMaxAnisotropy());
    texture.needsUpdate = true;
    return { texture, mean: meanColour(bitmap) };
  }
}

/** Linear mean colour of an image, from a few of its pixels. */
function meanColour(bitmap: ImageBitmap): Vector3 {
  const SIZE = 64;
  const context = new OffscreenCanvas(SIZE, SIZE).getContext("2d")!;
  context.drawImage(bitmap, 0, 0, SIZE, SIZE);
  const { data } = context.getImageData(0, 0, SIZE, SIZE);
  const mean = new Vector3();
  for (let k = 0; k < data.length; k += 4) {
    mean.x += toLinear(data[k]! / 255);
    mean.y += toLinear(data[k + 1]! / 255);
    mean.z += toLinear(data[k + 2]! / 255);
  }
  return mean.divideScalar(data.length / 4);
}

/** Which corner's values are flat over a triangle: the first where that can be chosen, for there it is free of cost everywhere. */
export function provokingCorner(renderer: WebGLRenderer): 0 | 2 {
  const extension = renderer.getContext().getExtension("WEBGL_provoking_vertex");
  if (!extension) return 2;
  extension.provokingVertexWEBGL(extension.FIRST_VERTEX_CONVENTION_WEBGL);
  return 0;
}
