// What is known of the solution as a whole: how it was computed, and the light on each object.

import type { Drawing } from "./drawing";
import type { ObjectSummary } from "./light";
import { many, significant, withMargin } from "./numbers";
import { byId, make, terms } from "./page";
import { studentsT } from "./student";

/** More objects than this are not listed. */
const MOST_OBJECTS = 200;

/** Writes the head of the panel, the table of objects and how it was computed. */
export function report(drawing: Drawing): void {
  const { light: { header }, surfaces } = drawing;
  const { summary } = header;
  const name = surfaces.header.name || "without a name";
  document.title = `${name} · isolux`;
  byId("scene-name").textContent = name;
  byId("scene-size").textContent = `${summary.elements.toLocaleString("en")} elements · ${many(summary.rays)} rays`;
  const margin = (error: { std_error: number; freedom: number } | null) =>
    error ? error.std_error * studentsT(header.students_t, error.freedom) : NaN;

  const rows: [string, string][] = [["Method", summary.method]];
  const { isAsSolved } = drawing.light;
  if (isAsSolved && summary.mean !== null) rows.push(["Mean irradiance", `${withMargin(summary.mean, margin(summary.mean_error))} lx`]);
  if (isAsSolved && summary.rms_error_estimate !== null) rows.push(["RMS error, expected", `${significant(100 * summary.rms_error_estimate, 3)} %`]);
  rows.push(
    ["Replicates", String(summary.replicates)],
    ["Seed", String(summary.seed)],
    ["Surface shown", header.smoothing === "none" ? "as computed" : "smoothed within the error bars"],
    ["isolux", summary.version],
  );
  byId("about-rows").replaceChildren(...terms(rows));

  const objects = means(drawing).sort((a, b) => b.area - a.area);
  byId("objects-body").replaceChildren(
    ...objects.slice(0, MOST_OBJECTS).map((object) =>
      make("tr", {},
        make("th", { textContent: object.name, title: object.name, scope: "row" }),
        make("td", { textContent: withMargin(object.mean, object.margin) }),
        make("td", { textContent: significant(object.area, 3) }))),
  );
  const left = objects.length - MOST_OBJECTS;
  byId("objects-note").textContent = left > 0 ? `and ${left} smaller ones` : "";
}

/** Number of a side of an object: elements on the only side of one that has none on the other are on its front. */
const faceNumber = (object: number, side: ObjectSummary["side"]): number => 2 * object + (side === "back" ? 1 : 0);

/** Mean irradiance of each object, or of each side of it, [lux] as the lamps are now, with its 95 % margin, if that is known. */
function means({ light, surfaces, lux }: Drawing): { name: string; area: number; mean: number; margin: number }[] {
  const sums = new Map<number, number>();
  surfaces.faceOf.forEach((face, e) => sums.set(face, (sums.get(face) ?? 0) + surfaces.areas[e]! * lux[e]!));
  return light.header.summary.objects.map(({ object, name, side, area, mean_error }) => ({
    name: (name || `number ${object}`) + (side ? `, ${side}` : ""),
    area,
    mean: (sums.get(faceNumber(object, side)) ?? 0) / area,
    // That of a mixture is not known here; isolux mix tells it.
    margin: mean_error && light.isAsSolved ? mean_error.std_error * studentsT(light.header.students_t, mean_error.freedom) : NaN,
  }));
}
