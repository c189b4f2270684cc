// What came out of runs, told together where they are of one method or setting, and which of them is best.
import { quantile } from "./boxes";
import type { Report, Run, Trial } from "./data";

/** Runs that answer one question together. */
export interface Group {
  name: string;
  runs: Run[];
  trials: Trial[];
  /** Whether it has all trials, of all cases and seeds that any other one has: harder cases may be what others lack. */
  isWhole: boolean;
}

/** What is told apart: settings over all cases and seeds, each case of them, or single runs. */
export type Level = "setting" | "case" | "run";

export interface Answer extends Group {
  right: number;
  wrong: number;
  undecided: number;
  declared: number;
  failed: number;
  /** Medians of right trials, and of the times of all steps; null where there are none. */
  steps: number | null;
  way_m: number | null;
  error_m: number | null;
  angle_deg: number | null;
  step_ms: number | null;
  /** The largest of the runs. */
  memory_mb: number | null;
}

/** Whether all of them are parts of experiments with variants, cases or seeds, no two are the same one, and those of a setting have one localizer. */
function areParts(runs: Run[]): boolean {
  const parts = new Set(runs.map(partKey));
  const methods = new Map<string, string>();
  const isSameMethod = (run: Run): boolean => {
    const key = JSON.stringify([experimentOf(run), run.provenance?.variant?.setting]);
    const known = methods.get(key) ?? localizerOf(run);
    methods.set(key, known);
    return known === localizerOf(run);
  };
  return runs.every((run) => run.provenance?.variant) && parts.size === runs.length && runs.every(isSameMethod);
}

const localizers = new WeakMap<Run, string>();

/** All its values. */
function localizerOf(run: Run): string {
  const known = localizers.get(run);
  if (known !== undefined) return known;
  const values = Object.entries(run.settings).filter(([path]) => path.startsWith("localizer."));
  const text = JSON.stringify(values.map(([path, setting]) => [path, setting.text]).sort());
  localizers.set(run, text);
  return text;
}

const experimentOf = (run: Run): string => run.settings.name?.text ?? run.name;

function partKey(run: Run): string {
  const { setting, case: its, seed } = run.provenance?.variant ?? {};
  return JSON.stringify([experimentOf(run), setting, its, seed]);
}

function nameOf(run: Run, level: Level, isOfMany: boolean): string {
  const { variant } = run.provenance ?? {};
  if (!variant || level === "run") return run.name;
  const parts = isOfMany ? [experimentOf(run), variant.setting] : [variant.setting || experimentOf(run)];
  return [...parts, level === "case" ? variant.case : ""].filter(Boolean).join(", ");
}

/** In the order of their first runs. */
export function groupsOf(runs: Run[], level: Level): Group[] {
  const actual = areParts(runs) ? level : "run";
  const isOfMany = new Set(runs.map(experimentOf)).size > 1;
  const groups = new Map<string, Run[]>();
  for (const run of runs) {
    const name = nameOf(run, actual, isOfMany);
    groups.set(name, [...(groups.get(name) ?? []), run]);
  }
  const places = actual === "setting" ? placesOf(runs) : 0;
  return [...groups].map(([name, its]) => groupOf(name, its, placesOf(its) >= places && its.every(({ summary }) => summary?.complete ?? true)));
}

export function groupOf(name: string, runs: Run[], isWhole = true): Group {
  return { name, runs, trials: runs.flatMap(({ trials }) => trials), isWhole };
}

/** How many cases with a seed they are chosen by. */
function placesOf(runs: Run[]): number {
  return new Set(chosenBy(runs).map(({ provenance }) => JSON.stringify([provenance?.variant?.case, provenance?.variant?.seed]))).size;
}

/** The levels that tell different things apart. */
export function levelsOf(runs: Run[]): Level[] {
  const levels: Level[] = ["setting", "case", "run"];
  const sizes = levels.map((level) => groupsOf(runs, level).length);
  return levels.filter((_, i) => sizes.indexOf(sizes[i]) === i);
}

function median(values: number[]): number | null {
  return values.length === 0 ? null : quantile([...values].sort((a, b) => a - b), 0.5);
}

/** What right trials have of a value. */
export const ofRight = (value: (trial: Trial) => number | undefined) => ({ trials }: Pick<Group, "trials">): number[] =>
  trials.flatMap((trial) => (trial.outcome === "right" ? (value(trial) ?? []) : []));

/** As many of a run as it has of all steps: each tells some of its times only. */
export function stepTimes({ runs }: Pick<Group, "runs">): number[] {
  const timed = runs.flatMap(({ step_ms, timed_steps }) => (step_ms?.length && timed_steps ? { step_ms, timed_steps } : []));
  const share = Math.min(...timed.map(({ step_ms, timed_steps }) => step_ms.length / timed_steps));
  return timed.flatMap(({ step_ms, timed_steps }) => spread(step_ms, Math.round(share * timed_steps)));
}

/** Of all steps where the summary of the only run tells it, also of steps that were not written; else of the times that are told. */
function medianTime(group: Group): number | null {
  const [{ summary }, ...others] = group.runs;
  return summary && summary.steps > 0 && others.length === 0 ? summary.step_ms.median : median(stepTimes(group));
}

/** So many of some values, equally far apart in their order, with both ends. */
function spread(values: number[], wanted: number): number[] {
  const count = Math.min(values.length, Math.max(wanted, 1));
  return Array.from({ length: count }, (_, i) => values[count < 2 ? Math.floor(values.length / 2) : Math.round((i * (values.length - 1)) / (count - 1))]);
}

export function answerOf(group: Group): Answer {
  const of = (outcome: Trial["outcome"]): number => group.trials.filter((trial) => trial.outcome === outcome).length;
  const medianOf = (value: (trial: Trial) => number | undefined): number | null => median(ofRight(value)(group));
  const memory = group.runs.flatMap(({ summary }) => summary?.peak_rss_mb ?? []);
  return {
    ...group,
    right: of("right"),
    wrong: of("wrong"),
    undecided: of("undecided"),
    declared: of("declared"),
    failed: of("failed"),
    steps: medianOf(({ steps }) => steps),
    way_m: medianOf(({ distance_m }) => distance_m),
    error_m: medianOf(({ translation_error_m }) => translation_error_m),
    angle_deg: medianOf(({ rotation_error_deg }) => rotation_error_deg),
    step_ms: medianTime(group),
    memory_mb: memory.length > 0 ? Math.max(...memory) : null,
  };
}

/** Right less wrong trials, as a share of all: a wrong answer undoes a right one. */
export function scoreOf({ right, wrong, trials }: Answer): number {
  return trials.length > 0 ? (right - wrong) / trials.length : -Infinity;
}

/** The best come first: whole ones by score, then by fewer steps; those alike stay in their order. */
export function byAnswer(a: Answer, b: Answer): number {
  return Number(b.isWhole) - Number(a.isWhole) || scoreOf(b) - scoreOf(a) || (a.steps ?? Infinity) - (b.steps ?? Infinity) || 0;
}

/** Runs on cases that nothing may be chosen by. */
export function isJudged({ provenance }: Run): boolean {
  return provenance?.variant?.role === "judge";
}

/** Those without the judged ones, or all where there is nothing else. */
function chosenBy(runs: Run[]): Run[] {
  return runs.every(isJudged) ? runs : runs.filter((run) => !isJudged(run));
}

/** The best groups of runs first, and in them all of their runs. */
export function bestFirst(runs: Run[], level: Level): Group[] {
  const scored = (group: Group): Answer => answerOf(groupOf(group.name, chosenBy(group.runs), group.isWhole));
  return groupsOf(runs, level)
    .map((group) => ({ group, answer: scored(group) }))
    .sort((a, b) => byAnswer(a.answer, b.answer))
    .map(({ group }) => group);
}

/** Runs as the page shows them: those of the best setting first, and of each the best. */
export function rankRuns(report: Report): void {
  report.runs = bestFirst(report.runs, "setting").flatMap(({ runs }) => bestFirst(runs, "run").flatMap((group) => group.runs));
}

/** A value by which runs are told apart, such as the method, a parameter, the case or the seed. */
export interface Axis {
  name: string;
  valueOf: (run: Run) => string;
  values: string[];
  /** Neither method nor case nor seed: there may be many of them. */
  isParameter: boolean;
}

const mostValues = 24;
/** Cases are there to choose a setting by, or to judge what was chosen. */
export const casesAxis = "cases";

/** What runs can be chosen by: few values each, and not as many as there are runs. */
export function axesOf(runs: Run[]): Axis[] {
  const paths = areParts(runs) ? [...new Set(runs.flatMap((run) => Object.keys(run.provenance?.variant?.values ?? {})))] : [];
  const axis = (name: string, valueOf: (run: Run) => string): Axis => ({ name, valueOf, values: [...new Set(runs.map(valueOf))], isParameter: name !== "method" && paths.includes(name) });
  const roles: Record<string, string> = { choose: "to choose by", judge: "to judge by" };
  const all = [
    axis(casesAxis, (run) => roles[run.provenance?.variant?.role ?? ""] ?? ""),
    axis("experiment", experimentOf),
    ...paths.map((path) => axis(path, (run) => run.provenance?.variant?.values[path] ?? "–")),
    axis("case", (run) => run.provenance?.variant?.case ?? ""),
    axis("seed", (run) => String(run.provenance?.variant?.seed ?? "")),
  ];
  return all.filter(({ values }) => values.length > 1 && values.length <= mostValues && values.length < runs.length);
}

/** All words are found in a run's name, or in what it sets otherwise than other runs: "kmeans intel". */
export function searched(runs: Run[], words: string): Run[] {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  if (wanted.length === 0) return runs;
  const paths = differingPaths(runs);
  return runs.filter((run) => {
    const own = paths.flatMap((path) => (run.settings[path] ? [`${path}=${run.settings[path].text}`] : []));
    const told = [run.name, ...own].join("\n").toLowerCase();
    return wanted.every((word) => told.includes(word));
  });
}

/** Files are the same if their content is. */
export function identityOf(run: Run, path: string): string | undefined {
  const setting = run.settings[path];
  return setting && (setting.identity ?? setting.text);
}

export function differingPaths(runs: Run[]): string[] {
  const paths = [...new Set(runs.flatMap((run) => Object.keys(run.settings)))].sort();
  return paths.filter((path) => runs.some((run) => identityOf(run, path) !== identityOf(runs[0], path)));
}
