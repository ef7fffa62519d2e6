// The files that the tests read.

import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";

/** The program under test. */
export const ISOLUX = process.env.ISOLUX ?? resolve(import.meta.dirname, "../../../target/release/isolux");

/** Where it leaves its files. */
export const OUT = resolve(import.meta.dirname, "../../out");

export const file = (name: string) => join(OUT, name);

/** Rows of a table without quoted commas, by the names of its columns without units. */
export function table(name: string): Record<string, string>[] {
  const [head, ...rows] = readFileSync(file(name), "utf8").trim().split("\n").map((line) => line.split(","));
  const names = head!.map((column) => column.split(" ")[0]!);
  return rows.map((row) => Object.fromEntries(names.map((column, k) => [column, row[k]!])));
}
