// Light maps that glTF materials have by the extension MOZ_lightmap, for GLTFLoader of three.js:
//
//     loader.register((parser) => new MozLightmap(parser));

import { LinearSRGBColorSpace } from 'three';

export class MozLightmap {
  name = 'MOZ_lightmap';

  constructor(parser) {
    this.parser = parser;
  }

  /** Attaches the light map while a material is made. */
  async extendMaterialParams(material, parameters) {
    const extension = this.parser.json.materials[material].extensions?.[this.name];
    if (!extension) return;
    await this.parser.assignTexture(parameters, 'lightMap', { texCoord: 1, ...extension }, LinearSRGBColorSpace);
    parameters.lightMapIntensity = extension.intensity ?? 1;
  }
}
