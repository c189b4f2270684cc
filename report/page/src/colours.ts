// Colours that colour-blind readers tell apart: Okabe and Ito's for kinds of things, viridis for ratings.
import type { VerdictKind } from "./data";

const runColours = 6; // --run-0 to --run-5 of the style sheet
const dashes: number[][] = [[], [7, 3], [2, 3]];

/** For style sheets, where it follows the theme. */
export function runColour(i: number): string {
  return `var(--run-${i % runColours})`;
}

/** For drawings: line of the i-th run: colours first, then dashes, so that 18 are told apart. */
export function runLine(i: number): { colour: string; dash: number[] } {
  return {
    colour: themeColour(`run-${i % runColours}`),
    dash: dashes[Math.floor(i / runColours) % dashes.length],
  };
}

export const verdictColours: Record<VerdictKind, string> = {
  searching: "#9a9a9a",
  ambiguous: "#e69f00",
  localized: "#0072b2",
  unknown_place: "#cc79a7",
};

export function verdictName(kind: VerdictKind): string {
  return kind.replace("_", " ");
}

// Eleven points of matplotlib's viridis, in between which it is all but linear.
const viridis = [
  [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140],
  [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37],
];

// From the blue of what is localized to a red brown.
const errors = [[0, 114, 178], [86, 180, 233], [240, 228, 66], [230, 159, 0], [213, 94, 0]];

/** At `share` of the way from the first colour to the last. */
function mixed(colours: number[][], share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const i = Math.min(Math.floor(at), colours.length - 2);
  const mix = colours[i].map((low, k) => Math.round(low + (at - i) * (colours[i + 1][k] - low)));
  return `rgb(${mix.join(", ")})`;
}

/** Of a rating r in [0, 1]. */
export function ratingColour(r: number): string {
  return mixed(viridis, r);
}

/** Black or white, whichever is read more easily on the colour of a rating: viridis is dark below the middle. */
export function inkOn(r: number): string {
  return r > 0.43 ? "#000000" : "#ffffff";
}

/** m; smaller and larger errors look the same as these. */
export const errorRange = { least: 0.01, most: 10 };

/** Of an error in m; equal ratios of errors are equally far apart. */
export function errorColour(error: number): string {
  const { least, most } = errorRange;
  return mixed(errors, Math.log(Math.max(error, least) / least) / Math.log(most / least));
}

/** A colour of the style sheet, which depends on light and dark. */
export function themeColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Red, green, blue and opacity of "#rrggbb". */
export function bytesOf(colour: string): number[] {
  return [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16)).concat(255);
}
