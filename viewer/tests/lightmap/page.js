// Shows a baked scene as docs/lightmaps.md says, and compares it with a picture of the engine.
//
// window.show({ glb, lightmap, reference, width, height }) renders from the first camera of the file and gives the mean absolute difference
// in levels of 8 bits, the share of pixels that differ by more than 16, and both pictures as data URLs.

import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MozLightmap } from './moz-lightmap.js';

/** The scene in a GLB file, with the map of a sidecar attached. */
async function load(glb, lightmap) {
  const loader = new GLTFLoader();
  loader.register((parser) => new MozLightmap(parser));
  const gltf = await loader.loadAsync(glb);
  if (lightmap) {
    const { exposure_stops } = gltf.asset.extras.isolux;
    const map = await new EXRLoader().loadAsync(lightmap);
    map.channel = 1;
    // Rows of an .exr come from below, texture coordinates of glTF from above.
    map.repeat.y = -1;
    map.offset.y = 1;
    const materials = new Set();
    gltf.scene.traverse((object) => object.isMesh && materials.add(object.material));
    for (const material of materials) {
      material.lightMap = map;
      material.lightMapIntensity = 2 ** exposure_stops;
      material.emissiveIntensity *= 2 ** exposure_stops;
    }
  }
  return gltf;
}

/**
 * The picture of the first camera: 8-bit sRGB, rows from above. Drawn twice as large and made smaller, without multisampling, which reads
 * textures beside triangles where it hits only their edges, and so other charts.
 */
function draw(gltf, width, height) {
  const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  renderer.setPixelRatio(2);
  renderer.setSize(width, height);
  renderer.toneMapping = THREE.NoToneMapping;
  const camera = gltf.cameras[0];
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  renderer.render(gltf.scene, camera);
  const canvas = Object.assign(document.createElement('canvas'), { width, height });
  const context = canvas.getContext('2d');
  context.fillRect(0, 0, width, height);
  context.drawImage(renderer.domElement, 0, 0, width, height);
  renderer.dispose();
  return context.getImageData(0, 0, width, height);
}

/** A picture of the engine: a .png as it is, an .exr [cd/m²] exposed by 2^stops, without a tone curve. */
async function reference(url, stops) {
  if (url.endsWith('.png')) {
    const bitmap = await createImageBitmap(await (await fetch(url)).blob());
    const canvas = Object.assign(document.createElement('canvas'), { width: bitmap.width, height: bitmap.height });
    const context = canvas.getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, bitmap.width, bitmap.height);
  }
  const loader = new EXRLoader();
  loader.setDataType(THREE.FloatType);
  const { image } = await loader.loadAsync(url);
  const picture = new ImageData(image.width, image.height);
  const encode = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  for (let y = 0; y < image.height; y++) {
    for (let x = 0; x < image.width; x++) {
      const from = 4 * ((image.height - 1 - y) * image.width + x);
      const to = 4 * (y * image.width + x);
      for (let c = 0; c < 3; c++) {
        const exposed = Math.min(image.data[from + c] * 2 ** stops, 1);
        picture.data[to + c] = Math.round(255 * encode(exposed));
      }
      picture.data[to + 3] = 255;
    }
  }
  return picture;
}

function asUrl(picture) {
  const canvas = Object.assign(document.createElement('canvas'), { width: picture.width, height: picture.height });
  canvas.getContext('2d').putImageData(picture, 0, 0);
  return canvas.toDataURL('image/png');
}

window.show = async ({ glb, lightmap, reference: url, width, height }) => {
  const gltf = await load(glb, lightmap);
  const shown = draw(gltf, width, height);
  const expected = await reference(url, gltf.asset.extras.isolux.exposure_stops);
  let sum = 0;
  let far = 0;
  for (let k = 0; k < shown.data.length; k += 4) {
    const differences = [0, 1, 2].map((c) => Math.abs(shown.data[k + c] - expected.data[k + c]));
    sum += differences[0] + differences[1] + differences[2];
    far += Math.max(...differences) > 16 ? 1 : 0;
  }
  const pixels = shown.data.length / 4;
  return { mean: sum / (3 * pixels), far: far / pixels, shown: asUrl(shown), expected: asUrl(expected) };
};
window.ready = true;
