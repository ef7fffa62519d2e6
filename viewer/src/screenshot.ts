// The picture as a PNG file, with the legend and the values on isolux lines if there are any.

import type { Labels } from "./labels";
import type { Legend } from "./legend";
import { make } from "./page";
import { MOST_PIXELS, type Viewer } from "./viewer";

/** Offers what is on the screen as a file. */
export async function screenshot(viewer: Viewer, labels: Labels, legend: Legend, name: string): Promise<void> {
  viewer.draw();
  const source = viewer.renderer.domElement;
  const ratio = Math.min(window.devicePixelRatio, MOST_PIXELS);
  const canvas = make("canvas", { width: Math.round(source.clientWidth * ratio), height: Math.round(source.clientHeight * ratio) });
  const context = canvas.getContext("2d")!;
  context.fillStyle = "#000000";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(source, 0, 0, canvas.width, canvas.height);
  if (labels.found.length > 0) context.drawImage(labels.canvas, 0, 0, canvas.width, canvas.height);
  if (!legend.canvas.hidden) {
    const [width, height] = [legend.canvas.clientWidth * ratio, legend.canvas.clientHeight * ratio];
    context.drawImage(legend.canvas, 16 * ratio, canvas.height - height - 16 * ratio, width, height);
  }
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!blob) return;
  const url = URL.createObjectURL(blob);
  make("a", { href: url, download: `${name || "isolux"}.png` }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
