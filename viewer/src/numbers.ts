// Numbers for people.

/** As many decimals as show `digits` significant ones: 1234, 12.3, 0.0123. */
export function significant(value: number, digits: number): string {
  if (!Number.isFinite(value)) return "?";
  if (value === 0) return "0";
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(value))));
  return value.toFixed(Math.min(decimals, 12));
}

/** `262.0 ± 1.3`: the margin with two digits, and the value as far as they reach. */
export function withMargin(value: number, margin: number): string {
  if (!(margin > 0)) return significant(value, 5);
  const decimals = Math.min(Math.max(0, 1 - Math.floor(Math.log10(margin))), 9);
  return `${value.toFixed(decimals)} ± ${margin.toFixed(decimals)}`;
}

/** `114 million`. */
export function many(count: number): string {
  const names: [number, string][] = [[1e12, "trillion"], [1e9, "billion"], [1e6, "million"]];
  const found = names.find(([size]) => count >= size);
  return found ? `${significant(count / found[0], 3)} ${found[1]}` : count.toLocaleString("en");
}

/** A value on a scale, as short as can be. */
export function short(value: number): string {
  return Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(0) : String(Number(significant(value, 3)));
}
