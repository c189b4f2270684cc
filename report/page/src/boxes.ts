// What a box plot shows of a sample.

export interface Box {
  kind: "box";
  /** Whiskers: the farthest values within 1.5 times the box's length from it (Tukey). */
  low: number;
  quarter: number;
  median: number;
  three_quarters: number;
  high: number;
  /** Beyond the whiskers. */
  outliers: number[];
}

/** Few values say more by themselves. */
export interface Dots {
  kind: "dots";
  median: number;
  values: number[];
}

const fewest = 8;

/** Linear between neighbours, as the program's own quantiles. */
export function quantile(sorted: number[], share: number): number {
  const at = share * (sorted.length - 1);
  const i = Math.min(Math.floor(at), sorted.length - 2);
  return sorted.length === 1 ? sorted[0] : sorted[i] + (at - i) * (sorted[i + 1] - sorted[i]);
}

/** Null for no values. */
export function boxOf(values: number[]): Box | Dots | null {
  if (values.length === 0) return null;
  const sorted = [...values].sort((a, b) => a - b);
  const median = quantile(sorted, 0.5);
  if (sorted.length < fewest) return { kind: "dots", median, values: sorted };
  const [quarter, three_quarters] = [quantile(sorted, 0.25), quantile(sorted, 0.75)];
  const reach = 1.5 * (three_quarters - quarter);
  const inside = sorted.filter((v) => v >= quarter - reach && v <= three_quarters + reach);
  const outliers = sorted.filter((v) => v < inside[0] || v > inside[inside.length - 1]);
  return { kind: "box", low: inside[0], quarter, median, three_quarters, high: inside[inside.length - 1], outliers };
}
