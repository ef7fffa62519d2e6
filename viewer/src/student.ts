// Student's t: how many standard errors a 95 % margin is.

/** For infinitely many degrees of freedom. */
const NORMAL = 1.959964;

/**
 * Quantile for any degrees of freedom, from a table of those of 1, 2, 3 ...: linear in 1/freedom between the entries and beyond
 * the last. Not a number without freedom.
 */
export function studentsT(table: readonly number[], freedom: number): number {
  if (!(freedom >= 1)) return NaN;
  const at = (n: number) => (n <= table.length ? table[n - 1]! : NORMAL);
  const [low, high] = freedom < table.length ? [Math.floor(freedom), Math.floor(freedom) + 1] : [table.length, Infinity];
  const share = (1 / low - 1 / freedom) / (1 / low - 1 / high);
  return at(low) + (at(high) - at(low)) * share;
}
