// Matplotlib's viridis at tenths, as published (bids.github.io/colormap).
const tenths = [
  [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140],
  [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37],
];

/** The colour of a share, linear between tenths: red, green, blue. */
export function viridisAt(share) {
  const i = Math.min(Math.floor(10 * share), 9);
  return tenths[i].map((low, k) => low + (10 * share - i) * (tenths[i + 1][k] - low));
}
