// What came out, on top of the page: large for one run, side by side for several.
import type { Report, Run, Summary } from "./data";
import { el, replace } from "./elements";
import { count, fixed, significant } from "./numbers";
import type { Store } from "./store";
import { explained } from "./words";

/** More than these are in the summary further down. */
const mostRuns = 12;

interface Figure {
  label: string;
  /** Of the style sheet. */
  kind: (summary: Summary) => string;
  tell: (summary: Summary) => string;
}

const outcomes: (Figure & { number: (summary: Summary) => number })[] = (
  [
    ["right", (s: Summary) => s.trials.right],
    ["wrong", (s: Summary) => s.trials.wrong],
    ["undecided", (s: Summary) => s.trials.undecided],
    ["declared", (s: Summary) => s.trials.declared_without_reference ?? 0],
    ["failed", (s: Summary) => s.trials.failed ?? 0],
  ] as const
).map(([label, number]) => ({
  label,
  // What did not happen needs no colour.
  kind: (s) => (number(s) > 0 ? label : "none"),
  number,
  tell: (s) => count(number(s)),
}));

const ofRight = (tell: (summary: Summary) => string) => (summary: Summary): string =>
  summary.trials.right > 0 ? tell(summary) : "–";

const medians: Figure[] = [
  { label: "steps", kind: () => "", tell: ofRight((s) => fixed(s.steps_to_localize.median, 1).replace(".0", "")) },
  { label: "way", kind: () => "", tell: ofRight((s) => `${fixed(s.distance_to_localize_m.median, 2)} m`) },
  { label: "error", kind: () => "", tell: ofRight((s) => `${fixed(s.translation_error_m.median, 3)} m`) },
  { label: "angle error", kind: () => "", tell: ofRight((s) => `${fixed(s.rotation_error_deg.median, 2)}°`) },
  { label: "wall time of a step", kind: () => "", tell: (s) => `${significant(s.step_ms.median, 2)} ms` },
];

/** Those that every run has, and of the others those that some run has. */
function figuresOf(summaries: Summary[]): { outcomes: typeof outcomes; medians: Figure[] } {
  const always = ["right", "wrong", "undecided"];
  return { outcomes: outcomes.filter((o) => always.includes(o.label) || summaries.some((s) => o.number(s) > 0)), medians };
}

/** Names of the experiments; what runs are called besides is theirs. */
export function experimentsOf({ runs }: Report): string {
  return [...new Set(runs.map((run) => run.settings.name?.text ?? run.name))].join(", ");
}

export function summaryHeader(store: Store): HTMLElement | null {
  const { runs } = store.report;
  const finished = runs.filter((run) => run.summary);
  if (finished.length === 0) return null;
  return runs.length === 1 ? tiles(finished[0].summary as Summary) : overview(store, finished);
}

function tiles(summary: Summary): HTMLElement {
  const { outcomes: shown, medians } = figuresOf([summary]);
  const tile = ({ label, kind, tell }: Figure): HTMLElement =>
    el("div", { class: `tile ${kind(summary)}`, "data-figure": label }, word(label, "dt"), el("dd", {}, tell(summary)));
  const seeds = `${count(summary.trials.count)} ${summary.trials.count === 1 ? "trial" : "trials"}, seed ${summary.seed}`;
  return el(
    "section",
    { id: "figures", class: "figures", "aria-label": "What came out" },
    el("dl", { class: "tiles" }, ...shown.map(tile), el("div", { class: "gap", "aria-hidden": "true" }), ...medians.map(tile)),
    el("p", { class: "note" }, `${seeds}. Steps, way and errors: medians of right trials. Time: median of all steps.`),
  );
}

/** The name of a figure, with what it means. */
function word(label: string, tag: "dt" | "span"): HTMLElement {
  return explained(el(tag, {}, label), label === "error" ? "error at declaration" : label);
}

/** Right, wrong and all others of a run's trials, as a bar of that length. */
function bar(summary: Summary): HTMLElement {
  const part = (outcome: (typeof outcomes)[number]): HTMLElement =>
    el("i", { class: outcome.label, style: `width: ${(100 * outcome.number(summary)) / Math.max(1, summary.trials.count)}%` });
  return el("span", { class: "outcomes", "aria-hidden": "true" }, ...outcomes.map(part));
}

function overview(store: Store, finished: Run[]): HTMLElement {
  const { runs } = store.report;
  const shown = finished.slice(0, mostRuns);
  const figures = figuresOf(shown.map((run) => run.summary as Summary));
  const columns = [...figures.outcomes, ...figures.medians];
  const rows = shown.map((run) => {
    const i = runs.indexOf(run);
    const summary = run.summary as Summary;
    return el(
      "tr",
      { "data-run": i },
      el("th", { scope: "row" }, el("button", { type: "button", click: () => store.chooseRun(i) }, run.name)),
      el("td", { class: "share" }, bar(summary)),
      ...columns.map((figure) => el("td", { class: `number ${figure.kind(summary)}`, "data-figure": figure.label }, figure.tell(summary))),
    );
  });
  const mark = (): void => {
    for (const row of rows) {
      const isChosen = Number(row.dataset.run) === store.selected.run;
      row.querySelector("button")?.setAttribute("aria-pressed", String(isChosen));
    }
  };
  store.subscribe((change) => change.run && mark());
  mark();
  const rest = finished.length - shown.length;
  const note = el("p", { class: "note" });
  replace(
    note,
    "Steps, way and errors: medians of right trials. Time: median of all steps.",
    rest > 0 && ` The other ${rest} runs are in the summary below.`,
  );
  return el(
    "section",
    { id: "figures", class: "figures", "aria-label": "What came out" },
    el(
      "div",
      { class: "scroll", tabindex: 0 },
      el(
        "table",
        { class: "overview" },
        el(
          "thead",
          {},
          el("tr", {}, ...["run", "trials"].map((text) => el("th", { scope: "col" }, word(text, "span"))), ...columns.map((c) => el("th", { scope: "col" }, word(c.label, "span")))),
        ),
        el("tbody", {}, ...rows),
      ),
    ),
    note,
  );
}
