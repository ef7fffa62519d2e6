// The page begins here: it reads what it is to show, and connects the picture with its controls.

import { Compare } from "./compare";
import { about, embedded } from "./embedded";
import { Groups } from "./groups";
import { Labels } from "./labels";
import { Legend } from "./legend";
import { Light, type LightHeader } from "./light";
import { Live } from "./live";
import { byId, fail } from "./page";
import { Panel } from "./panel";
import { Damaged } from "./part";
import { ReadingCard } from "./reading";
import { report } from "./report";
import { screenshot } from "./screenshot";
import { whenIdle } from "./pieces";
import { Surfaces, type SurfacesHeader } from "./surfaces";
import { type Shown, Viewer } from "./viewer";

/** A solution that is written into the page; what it has in common with the `other` is written once. */
async function shown(which: "" | "-before", other?: Shown): Promise<Shown | undefined> {
  const light = await embedded<LightHeader>(`light${which}`);
  if (!light) return undefined;
  const part = await embedded<SurfacesHeader>(`surfaces${which}`);
  const surfaces = part ? new Surfaces(part) : other?.surfaces;
  if (!surfaces) throw new Damaged("it has light, but nothing to fall on");
  return { surfaces, light: new Light(light, other?.light) };
}

/** Finds coarser levels of detail for a camera that moves, while there is nothing better to do. */
async function findLevels({ after, before }: Viewer): Promise<void> {
  await whenIdle(after.findLevels());
  if (before) await whenIdle(before.findLevels());
}

async function start(): Promise<void> {
  const { live: isLive, compared } = about();
  const live = isLive ? new Live() : undefined;
  const after = live ? await live.first() : await shown("");
  if (!after) throw new Damaged("there is no light in it");
  const before = compared && (await shown("-before", after));

  const canvas = byId<HTMLCanvasElement>("picture");
  const viewer = await Viewer.make(canvas, after, before, compared?.same_elements);
  const legend = new Legend(viewer);
  const labels = new Labels(viewer);
  const reading = new ReadingCard(viewer, canvas);
  const compare = before && compared ? new Compare(viewer, compared.names) : undefined;
  const relight = () => {
    viewer.relight(viewer.after);
    report(viewer.after);
    reading.relit();
  };
  const groups = new Groups(viewer.after, relight);
  const save = () => void screenshot(viewer, labels, legend, after.surfaces.header.name);
  new Panel(viewer, { screenshot: save, flip: () => compare?.flip(), clearReading: () => reading.clear() });
  report(viewer.after);
  viewer.draw();
  void findLevels(viewer);
  byId("loading").hidden = true;
  document.body.classList.add("ready");
  canvas.addEventListener("webglcontextlost", () => {
    fail("The graphics card has given up", "Load the page again. If it happens often, solve with fewer --elements.");
  });
  // For tests, and for the curious.
  Object.assign(window, { isolux: { viewer, reading, labels } });
  void live?.follow((light) => {
    viewer.after.light = light;
    groups.keep();
    relight();
  });
}

/** Whether this browser can draw it. */
function hasWebGl(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

if (typeof DecompressionStream === "undefined") {
  fail("This browser is too old", "The page needs one of 2023 or later.");
} else if (!hasWebGl()) {
  fail("This browser cannot draw in three dimensions", "The page needs WebGL 2. Another browser, or one with its hardware acceleration "
    + "switched on, will show it. Pictures and numbers need none: isolux render SOLUTION -o picture.png -o numbers.csv");
} else {
  start().catch((error: unknown) => {
    const isDamaged = error instanceof Damaged || error instanceof SyntaxError;
    const what = error instanceof Error ? error.message : String(error);
    if (isDamaged) fail("This page is damaged", `It cannot be shown: ${what}. Write it anew: isolux view SOLUTION`);
    else fail("This page cannot be shown", what);
    if (!isDamaged) throw error;
  });
}
