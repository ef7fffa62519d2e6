// The picture as a PNG file, with the legend if there is one.

import type { Legend } from "./legend";
import { make } from "./page";
import type { Viewer } from "./viewer";

/** Offers what is on the screen as a file. */
export async function screenshot(viewer: Viewer, legend: Legend, name: string): Promise<void> {
  viewer.draw();
  const source = viewer.renderer.domElement;
  const canvas = make("canvas", { width: source.width, height: source.height });
  const context = canvas.getContext("2d")!;
  context.fillStyle = "#000000";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(source, 0, 0);
  if (!legend.canvas.hidden) {
    const ratio = viewer.renderer.getPixelRatio();
    const [width, height] = [legend.canvas.clientWidth * ratio, legend.canvas.clientHeight * ratio];
    context.drawImage(legend.canvas, 16 * ratio, canvas.height - height - 16 * ratio, width, height);
  }
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!blob) return;
  const url = URL.createObjectURL(blob);
  make("a", { href: url, download: `${name || "isolux"}.png` }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
