// The numbers of the chosen step, and its clusters.
import { certificateNote } from "./certificate";
import { ratingColour, verdictColours, verdictName } from "./colours";
import { isInSpace, type Steps, type Trial } from "./data";
import { DataTable, type Column } from "./data_table";
import { append, el, replace, type Child } from "./elements";
import { degrees } from "./geometry";
import { count, fixed, nameOf, percent, significant } from "./numbers";
import type { Hypothesis, Store } from "./store";
import { outcomeSentence } from "./summary_header";
import { explained } from "./words";

/** Clusters beyond these are shown when they are asked for. */
const mostClusters = 10;

export class Details {
  readonly element = el("section", { class: "details", "aria-label": "The step in numbers" });
  /** What the trial came to, and what the step says. */
  readonly verdict = el("div", { class: "verdicts-line", "aria-live": "polite" });
  private readonly facts = el("div", {});
  private readonly certificate = el("div", { class: "certificates" });
  private readonly poses = (["estimate", "reference"] as const).map((pose) => this.poseButton(pose, pose));
  private readonly clusters = new DataTable<number>(this.columns(), { keys: 3, most: mostClusters, what: "clusters" });
  /** What the local map can be laid under. */
  private readonly hypotheses = el(
    "div",
    { class: "hypotheses" },
    el("p", {}, "Local map under ", ...this.poses, " or a cluster:"),
    this.clusters.element,
  );

  constructor(private readonly store: Store) {
    append(this.element, this.facts, this.hypotheses, this.certificate);
    store.subscribe((change) => change.hypothesis && this.update());
  }

  update(): void {
    const { steps, trial, report, run } = this.store;
    const { step } = this.store.selected;
    const hasSteps = steps !== undefined && steps.step.length > 0;
    // Of a run's only trial the page begins with it.
    const isAlone = report.runs.length === 1 && run.trials.length === 1 && !report.live;
    replace(this.verdict, trial && !isAlone && outcome(trial), hasSteps && verdict(steps, step));
    this.hypotheses.hidden = !hasSteps;
    if (!hasSteps) {
      replace(this.facts, el("p", {}, trial?.why ?? "There is no step to show."));
      replace(this.certificate);
      return;
    }
    // Steps are moved by keys, whatever has the focus.
    const focused = document.activeElement;
    const hypothesis = focused?.getAttribute("data-hypothesis");
    const word = this.facts.contains(focused) ? focused?.textContent : null;
    const isOpen = this.certificate.querySelector("details")?.open ?? false;
    replace(this.facts, facts(steps, step));
    replace(this.certificate, trial && certificateNote(trial, step, isOpen));
    this.showClusters(steps, step);
    if (hypothesis != null) this.element.querySelector<HTMLElement>(`[data-hypothesis="${hypothesis}"]`)?.focus();
    if (word != null) [...this.facts.querySelectorAll<HTMLElement>(".word")].find(({ textContent }) => textContent === word)?.focus();
  }

  private showClusters({ best }: Steps, step: number): void {
    const chosen = this.store.selected.hypothesis;
    const listed = best.first[step + 1] - best.first[step];
    const atLeast = typeof chosen === "number" ? chosen + 1 : 0;
    this.clusters.setRows(Array.from({ length: listed }, (_, rank) => rank), atLeast);
    for (const button of this.poses) button.setAttribute("aria-pressed", String(button.dataset.hypothesis === chosen));
  }

  private poseButton(hypothesis: Hypothesis, text: string): HTMLElement {
    return el(
      "button",
      {
        type: "button",
        "data-hypothesis": hypothesis,
        "aria-pressed": String(hypothesis === this.store.selected.hypothesis),
        click: () => this.store.chooseHypothesis(hypothesis),
      },
      text,
    );
  }

  /** Of the clusters of the step, by their ranks. */
  private columns(): Column<number>[] {
    const of = (tell: (best: Steps["best"], k: number) => Child) => (rank: number): Child => {
      const { steps, selected } = this.store;
      return steps ? tell(steps.best, steps.best.first[selected.step] + rank) : "";
    };
    return [
      { name: "cluster", cell: (rank) => this.poseButton(rank, String(rank + 1)) },
      { name: "r", cell: of(({ r }, k) => el("span", {}, el("i", { class: "swatch", style: `background: ${ratingColour(r[k])}` }), significant(r[k]))) },
      { name: "r̄", cell: of(({ r_normalised: r }, k) => significant(r[k])) },
      { name: "hypotheses", cell: of(({ size }, k) => count(size[k])) },
      { name: "x, m", cell: of(({ x }, k) => fixed(x[k], 2)) },
      { name: "y, m", cell: of(({ y }, k) => fixed(y[k], 2)) },
      ...(isInSpace(this.store.report) ? [{ name: "z, m", meaning: "Height of the robot in the map.", cell: of(({ z }, k) => (z?.[k] == null ? "–" : fixed(z[k], 2))) }] : []),
      { name: "θ, °", cell: of(({ theta }, k) => fixed(degrees(theta[k]), 1)) },
    ];
  }
}

function outcome(trial: Trial): HTMLElement {
  const kind = trial.outcome ?? "running";
  return el("p", { class: "trial-outcome" }, `Trial ${trial.trial}: `, el("strong", { class: `outcome ${kind}` }, kind), ` – ${outcomeSentence(trial)}`);
}

function verdict(steps: Steps, step: number): HTMLElement {
  const kind = steps.verdict[step];
  return el(
    "p",
    { class: "verdict" },
    el("strong", { style: `border-color: ${verdictColours[kind]}` }, verdictName(kind)),
    ` ${steps.sentences[steps.why[step]] ?? ""}`,
  );
}

function facts(steps: Steps, step: number): HTMLElement {
  const error = steps.translation_error_m[step];
  const confidence = steps.confidence[step];
  const omega = steps.omega_best[step];
  const score = steps.score_best[step];
  const all: [name: string, value: string, word?: string][] = [
    ["Ω best", significant(omega)],
    ...(score === omega ? [] : [["score best", significant(score)] as [string, string]]),
    ["Ω max", significant(steps.omega_max[step])],
    ["Ω′", significant(steps.omega_place[step])],
    ["error", error == null ? "–" : `${fixed(error, 3)} m, ${fixed(steps.rotation_error_deg[step], 2)}°`],
    ...(confidence == null ? [] : [["confidence", percent(confidence)] as [string, string]]),
    ["hypotheses", count(steps.hypotheses[step])],
    ["proposals", count(steps.proposals[step])],
    ["clusters", count(steps.clusters[step])],
    ["local map", `${count(steps.local_map_points[step])} points`],
    ...(steps.range_noise_m[step] == null
      ? []
      : [["ε, range noise", `${significant(steps.contact_epsilon_m[step])} m, ${significant(steps.range_noise_m[step])} m`] as [string, string]]),
    ["time", `${fixed(steps.step_ms[step], 1)} ms, matching ${fixed(steps.match_ms[step], 1)} ms`],
    ...Object.entries(steps.evidence)
      .filter(([, values]) => values[step] != null)
      .map(([name, values]): [string, string, string] => [nameOf(name), significant(values[step]), `evidence: ${name}`]),
  ];
  return el("dl", {}, ...all.map(([name, value, word = name]) => el("div", {}, explained(el("dt", {}, name), word), el("dd", {}, value))));
}
