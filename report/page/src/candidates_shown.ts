// Which of a step's clusters the map draws, and how strongly: hundreds of weak ones would hide the few that matter.

/** px: where cells are as large as this, each has one cluster. */
const largestCell = 16;
const faintest = 0.2;

/**
 * How opaque a cluster is drawn: fully where its rating is next to the best, hardly at three quarters of it and below.
 */
export function opacityOf(r: number, best: number): number {
  if (best <= 0) return 1;
  const strength = (r / best - 0.75) / 0.2;
  return Math.min(1, Math.max(faintest, faintest + (1 - faintest) * strength));
}

/**
 * The clusters of [begin, end), which fall in rating, that are drawn at `scale` px per m: the best of each square cell of 8
 * to 16 px. Cells are halved as the scale doubles, so that zooming in only adds clusters. Rising rating: the best is drawn
 * last.
 */
export function thinnedOut(at: { x: number[]; y: number[] }, begin: number, end: number, scale: number): number[] {
  const side = 2 ** Math.floor(Math.log2(largestCell / scale)); // m
  const taken = new Set<string>();
  const kept: number[] = [];
  for (let k = begin; k < end; ++k) {
    const cell = `${Math.floor(at.x[k] / side)} ${Math.floor(at.y[k] / side)}`;
    if (taken.has(cell)) continue;
    taken.add(cell);
    kept.push(k);
  }
  return kept.reverse();
}
