// What one has chosen to see.

import type { Scale } from "./scale";
import type { Mode } from "./uniforms";

export interface Settings {
  mode: Mode;
  /** Stops above the automatic exposure. */
  stops: number;
  textured: boolean;
  /** Isolux lines. */
  lines: boolean;
  /** Edges of the elements. */
  edges: boolean;
  /** One value for each element, as it was computed. */
  byElement: boolean;
  logarithmic: boolean;
  /** Errors in percent of the value, not in lux. */
  relativeError: boolean;
  /** The ends of the scale, if somebody has chosen them, for each mode. */
  ends: Partial<Record<Mode, Pick<Scale, "low" | "high">>>;
  /** Where the divider between two solutions is: 0 shows the first alone, 1 the one before alone. */
  divider: number;
}

export function defaults(): Settings {
  return {
    mode: "light", stops: 0, textured: true, lines: false, edges: false, byElement: false, logarithmic: false, relativeError: true,
    ends: {}, divider: 0.5,
  };
}
