// The numbers of the chosen step, and its clusters.
import { certificateNote } from "./certificate";
import { ratingColour, verdictColours, verdictNames } from "./colours";
import { stepTime, type Steps } from "./data";
import { el, replace, table } from "./elements";
import { degrees } from "./geometry";
import { count, fixed, nameOf, percent, significant } from "./numbers";
import type { Hypothesis, Store } from "./store";
import { explained } from "./words";

export class Details {
  readonly element = el("section", { class: "details", "aria-label": "The step in numbers" });

  constructor(private readonly store: Store) {
    store.subscribe((change) => change.hypothesis && this.update());
  }

  update(): void {
    const { steps, trial } = this.store;
    const { step } = this.store.selected;
    if (!steps || steps.step.length === 0) {
      replace(this.element, el("p", {}, trial?.why ?? "There is no step to show."));
      return;
    }
    const focused = document.activeElement?.getAttribute("data-hypothesis");
    const word = this.element.contains(document.activeElement) ? document.activeElement?.closest(".word")?.textContent : null;
    const scrolled = this.element.querySelector(".scroll")?.scrollTop ?? 0;
    replace(
      this.element,
      verdict(steps, step),
      trial && certificateNote(trial, step),
      facts(steps, step),
      this.hypotheses(steps, step),
    );
    if (scrolled > 0) this.element.querySelector(".scroll")?.scrollTo(0, scrolled);
    if (focused != null) this.element.querySelector<HTMLElement>(`[data-hypothesis="${focused}"]`)?.focus();
    // Steps are moved by keys, whatever has the focus.
    if (word != null) [...this.element.querySelectorAll<HTMLElement>(".word")].find(({ textContent }) => textContent === word)?.focus();
  }

  /** What the local map can be laid under. */
  private hypotheses(steps: Steps, step: number): HTMLElement {
    const { best } = steps;
    const chosen = this.store.selected.hypothesis;
    const button = (hypothesis: Hypothesis, text: string): HTMLElement =>
      el(
        "button",
        {
          type: "button",
          "data-hypothesis": hypothesis,
          "aria-pressed": String(hypothesis === chosen),
          click: () => this.store.chooseHypothesis(hypothesis),
        },
        text,
      );
    const rows = [];
    for (let k = best.first[step]; k < best.first[step + 1]; ++k) {
      const rank = k - best.first[step];
      rows.push([
        button(rank, String(rank + 1)),
        el("span", {}, el("i", { class: "swatch", style: `background: ${ratingColour(best.r[k])}` }), significant(best.r[k])),
        significant(best.r_normalised[k]),
        count(best.size[k]),
        fixed(best.x[k], 2),
        fixed(best.y[k], 2),
        fixed(degrees(best.theta[k]), 1),
      ]);
    }
    return el(
      "div",
      { class: "hypotheses", "data-table": "clusters" },
      el("p", {}, "Local map under ", button("estimate", "estimate"), button("reference", "reference"), " or a cluster:"),
      table(["cluster", "r", "r̄", "hypotheses", "x, m", "y, m", "θ, °"], rows),
    );
  }
}

function verdict(steps: Steps, step: number): HTMLElement {
  const kind = steps.verdict[step];
  return el(
    "p",
    { class: "verdict", "aria-live": "polite" },
    el("strong", { style: `border-color: ${verdictColours[kind]}` }, verdictNames[kind]),
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
    ["time", `${fixed(stepTime(steps, step), 1)} ms, matching ${fixed(steps.match_ms[step], 1)} ms`],
    ...Object.entries(steps.evidence)
      .filter(([, values]) => values[step] != null)
      .map(([name, values]): [string, string, string] => [nameOf(name), significant(values[step]), `evidence: ${name}`]),
  ];
  return el("dl", {}, ...all.map(([name, value, word = name]) => el("div", {}, explained(el("dt", {}, name), word), el("dd", {}, value))));
}
