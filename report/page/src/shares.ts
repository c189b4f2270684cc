// Distributions of what trials leave.

/** What part of the sample is no larger than each x; null where the sample is empty. */
export function cumulativeShare(sample: { values: number[]; of: number }, x: number[]): (number | null)[] {
  if (sample.of === 0) return x.map(() => null);
  const sorted = [...sample.values].sort((a, b) => a - b);
  let n = 0;
  return x.map((limit) => {
    while (n < sorted.length && sorted[n] <= limit) ++n;
    return n / sample.of;
  });
}
