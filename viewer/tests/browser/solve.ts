// Before the tests: small rooms are solved and written as pages, tables and pictures, by the built program.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, rmSync } from "node:fs";
import { ISOLUX, OUT } from "./files";

const run = (...words: string[]) => execFileSync(ISOLUX, words, { cwd: OUT, stdio: ["ignore", "ignore", "inherit"] });

export default function solve(): void {
  if (!existsSync(ISOLUX)) throw new Error(`there is no ${ISOLUX}: build it first (make build)`);
  rmSync(OUT, { recursive: true, force: true });
  mkdirSync(OUT, { recursive: true });
  // Of equal elements, so that a point is mostly in the one whose middle is nearest; all others follow the light.
  run("solve", "cornell-box", "--elements", "4000", "--mesh", "uniform", "--rays", "2M", "--width", "640",
    "-o", "room.html", "-o", "room.csv", "-o", "room.png", "-o", "room.isolux");
  // As many rays as users have by default: with ten an element, coarser levels differ from the whole by its noise.
  run("solve", "cornell-box", "--elements", "40000", "-o", "fine.html");
  run("solve", "office", "--elements", "6000", "--rays", "2M", "--light-groups", "Ceiling=ceiling light*;Windows=window*", "-o", "day.isolux");
  run("mix", "day.isolux", "--set", "Ceiling=0.5", "--set", "Windows=1.5*#ff8040", "-o", "evening.isolux", "-o", "evening.csv");
  run("view", "day.isolux", "-o", "day.html");
  run("view", "evening.isolux", "--before", "day.isolux", "-o", "compared.html");
  run("solve", "cornell-box", "--elements", "1000", "--rays", "200k", "-o", "coarse.isolux");
  run("view", "room.isolux", "--before", "coarse.isolux", "-o", "unlike.html");
}
