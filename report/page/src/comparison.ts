// What `glocal compare` says of the runs. It is read here alone, and what is not there is not told.
import { el, list, section } from "./elements";
import type { Report } from "./data";
import { table } from "./data_table";
import { fixed, nameOf, percent, significant } from "./numbers";

/** More rows are folded. */
const mostAtFirst = 12;

type Json = Record<string, unknown>;

const isObject = (value: unknown): value is Json => typeof value === "object" && value !== null && !Array.isArray(value);
const objects = (value: unknown): Json[] => (Array.isArray(value) ? value.filter(isObject) : []);
const texts = (value: unknown): string[] => (Array.isArray(value) ? value.filter((text): text is string => typeof text === "string") : []);
const text = (value: unknown): string | undefined => (typeof value === "string" ? value : undefined);
const number = (value: unknown): number | undefined => (typeof value === "number" ? value : undefined);

interface Interval {
  value: number;
  low?: number;
  high?: number;
}

interface Row {
  variant: string;
  measure: string;
  baseline?: number;
  own?: number;
  difference?: Interval & { unit: string };
  /** Absent where no test could reject. */
  p?: number;
  isSignificant: boolean;
}

interface Read {
  baseline: string;
  /** That all share, and at how many places. */
  starts?: number;
  places?: number;
  significance?: number;
  /** A sentence a variant. */
  conclusions: string[];
  warnings: string[];
  /** Shares of 1. */
  methods: { name: string; right?: Interval; wrong?: Interval; undecided?: Interval }[];
  rows: Row[];
  /** Measures in which a variant does as the baseline does, start by start. */
  alike: { variant: string; measures: string[] }[];
}

function interval(value: unknown): Interval | undefined {
  if (!isObject(value) || typeof value.value !== "number") return undefined;
  return { value: value.value, low: number(value.low), high: number(value.high) };
}

function sum(json: Json, ...keys: string[]): number | undefined {
  const all = keys.map((key) => number(json[key]) ?? NaN);
  const total = all.reduce((a, b) => a + b, 0);
  return Number.isNaN(total) ? undefined : total;
}

/** An outcome has counts of starts by how both ended there, a measure has medians. */
function rowOf(variant: string, json: Json): Row {
  const points = interval(json.difference_points);
  const difference = points ?? interval(json.mean_difference);
  return {
    variant,
    measure: nameOf(text(json.outcome) ?? text(json.measure) ?? ""),
    baseline: sum(json, "both", "only_baseline") ?? number(json.baseline_median),
    own: sum(json, "both", "only_variant") ?? number(json.variant_median),
    difference: difference && { ...difference, unit: points ? " points" : "" },
    p: json.has_chance === false ? undefined : number(json.p_holm),
    isSignificant: json.significant === true,
  };
}

/** False where no place differs: there is nothing to test. */
function differs(json: Json): boolean {
  return number(json.differing_places) !== 0;
}

export function read(comparison: unknown): Read | null {
  if (!isObject(comparison)) return null;
  const pairs = objects(comparison.pairs).map((pair) => ({
    variant: text(pair.variant) ?? "",
    conclusion: text(pair.conclusion),
    warnings: texts(pair.warnings),
    tests: [...objects(pair.outcomes), ...objects(pair.measures)],
  }));
  return {
    baseline: text(comparison.baseline) ?? "the baseline",
    starts: number(comparison.starts),
    places: number(comparison.places),
    significance: number(comparison.significance),
    conclusions: pairs.flatMap(({ conclusion }) => conclusion ?? []),
    warnings: [...texts(comparison.warnings), ...pairs.flatMap(({ variant, warnings }) => warnings.map((warning) => `${variant}: ${warning}`))],
    methods: objects(comparison.methods).map((method) => ({
      name: text(method.name) ?? "",
      right: interval(method.success_rate),
      wrong: interval(method.false_rate),
      undecided: interval(method.undecided_rate),
    })),
    rows: pairs.flatMap(({ variant, tests }) => tests.filter(differs).map((test) => rowOf(variant, test))),
    alike: pairs
      .map(({ variant, tests }) => ({ variant, measures: tests.filter((test) => !differs(test)).map((test) => rowOf("", test).measure) }))
      .filter(({ measures }) => measures.length > 0),
  };
}

function between({ low, high }: Interval, tell: (value: number) => string): string {
  return low === undefined || high === undefined ? "" : ` (${tell(low)} to ${tell(high)})`;
}

const share = (rate: Interval | undefined): string => (rate ? `${percent(rate.value)}${between(rate, (v) => (100 * v).toFixed(1))}` : "–");

function methodsTable(methods: Read["methods"]): HTMLElement {
  return table(
    "comparison",
    ["method", "right (95 %)", "wrong (95 %)", "undecided (95 %)"],
    methods.map(({ name, right, wrong, undecided }) => [name, share(right), share(wrong), share(undecided)]),
  );
}

function cells({ measure, baseline, own, difference: d, p, isSignificant }: Row): (Node | string)[] {
  const told = p === undefined ? "–" : p < 0.001 ? "< 0.001" : fixed(p, 3);
  return [
    measure,
    d === undefined ? "–" : `${significant(d.value)}${d.unit}${between(d, significant)}`,
    isSignificant ? el("strong", {}, told) : told,
    significant(baseline),
    significant(own),
  ];
}

function over({ starts, places }: Read): string {
  if (starts === undefined) return "";
  return `, over the ${starts} starts that all share${places === undefined ? "" : `, at ${places} places`}`;
}

export function comparisonSection({ comparison, comparison_refused: refused }: Report): HTMLElement | null {
  if (refused !== undefined) return section("comparison", "Comparison", el("p", { class: "warning" }, refused));
  const found = read(comparison);
  if (!found) return null;
  const { baseline, rows, alike } = found;
  return section(
    "comparison",
    `Comparison with ${baseline}`,
    list(found.conclusions),
    list(found.warnings, "warning"),
    found.methods.length > 0 && methodsTable(found.methods),
    rows.length > 0 &&
      el(
        "details",
        { class: "tests", open: rows.length <= mostAtFirst },
        el("summary", {}, "Where they differ, in numbers"),
        table("comparison", ["variant", "measure", "difference (95 %)", "p", "baseline's", "variant's"], rows.map((row) => [row.variant, ...cells(row)])),
        list(alike.map(({ variant, measures }) => `${variant}: no start differs in ${measures.join(", ")}.`)),
        el(
          "p",
          { class: "note" },
          `Differences are variant less baseline${over(found)}. p is after Holm`,
          found.significance !== undefined && `; bold: significant, below ${found.significance}`,
          ".",
        ),
      ),
  );
}
