// What came out of a run, on top of the page: the verdict of its only trial, or how many were right.
import type { Report, Run, Summary, Trial } from "./data";
import { el } from "./elements";
import { count, fixed, significant } from "./numbers";
import { explained } from "./words";

interface Figure {
  label: string;
  /** Of the style sheet. */
  kind?: (summary: Summary) => string;
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
  { label: "steps", tell: ofRight((s) => fixed(s.steps_to_localize.median, 1).replace(".0", "")) },
  { label: "way", tell: ofRight((s) => `${fixed(s.distance_to_localize_m.median, 2)} m`) },
  { label: "error", tell: ofRight((s) => `${fixed(s.translation_error_m.median, 3)} m`) },
  { label: "angle error", tell: ofRight((s) => `${fixed(s.rotation_error_deg.median, 2)}°`) },
  { label: "wall time of a step", tell: (s) => (s.steps > 0 ? `${significant(s.step_ms.median, 2)} ms` : "–") },
];

/** Names of the experiments; what runs are called besides is theirs. */
export function experimentsOf({ runs }: Report): string {
  return [...new Set(runs.map((run) => run.settings.name?.text ?? run.name))].join(", ");
}

export function summaryHeader({ summary, trials }: Run): HTMLElement | null {
  if (!summary) return null;
  return trials.length === 1 ? verdictOf(trials[0], summary) : tiles(summary);
}

/** What a trial came to, in a sentence. */
export function outcomeSentence(trial: Trial): string {
  const { outcome, steps, distance_m: way, translation_error_m: error, rotation_error_deg: angle } = trial;
  const counted = `${count(steps)} ${steps === 1 ? "step" : "steps"}${way === undefined ? "" : ` and ${fixed(way, 2)} m`}`;
  const off = error === undefined ? "" : `, ${fixed(error, 3)} m and ${fixed(angle, 2)}° from the reference`;
  switch (outcome) {
    case "right":
    case "wrong":
      return `localized after ${counted}${off}`;
    case "declared":
      return `localized after ${counted}; there is no reference to judge it by`;
    case "failed":
      return `a strategy failed after ${counted}: ${trial.why ?? ""}`;
    case "undecided":
      return `not localized in ${counted}: ${trial.why ?? ""}`;
    default:
      return "running";
  }
}

const note = "Steps, way and errors: medians of right trials. Time: median of all steps.";

function verdictOf(trial: Trial, summary: Summary): HTMLElement {
  const outcome = trial.outcome ?? "running";
  return el(
    "section",
    { id: "figures", class: "figures", "aria-label": "What came out" },
    el(
      "p",
      { class: `answer ${outcome}` },
      explained(el("strong", { "data-figure": "outcome" }, outcome)),
      el("span", {}, outcomeSentence(trial)),
      el("small", {}, `one trial, seed ${summary.seed}${summary.steps > 0 ? `; a step takes ${significant(summary.step_ms.median, 2)} ms` : ""}`),
    ),
  );
}

function tiles(summary: Summary): HTMLElement {
  const always = ["right", "wrong", "undecided"];
  const shown = outcomes.filter((o) => always.includes(o.label) || o.number(summary) > 0);
  const tile = ({ label, kind, tell }: Figure): HTMLElement =>
    el("div", { class: `tile ${kind?.(summary) ?? ""}`, "data-figure": label }, word(label), el("dd", {}, tell(summary)));
  return el(
    "section",
    { id: "figures", class: "figures", "aria-label": "What came out" },
    el("dl", { class: "tiles" }, ...shown.map(tile), el("div", { class: "gap", "aria-hidden": "true" }), ...medians.map(tile)),
    el("p", { class: "note" }, `${count(summary.trials.count)} trials, seed ${summary.seed}. ${note}`),
  );
}

/** The name of a figure, with what it means. */
function word(label: string): HTMLElement {
  return explained(el("dt", {}, label), label === "error" ? "error at declaration" : label);
}
