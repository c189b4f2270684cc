// All trials: one run's as a list to choose from, and what all runs make of them.
import { bestFirst, ofRight, stepTimes, type Group } from "./answers";
import type { ChartOptions } from "./charts";
import { lineSample } from "./curves";
import type { Run, Trial } from "./data";
import { DataTable, type Column } from "./data_table";
import { BoxPlots } from "./distributions";
import { el, replace, section } from "./elements";
import { count, fixed, percent } from "./numbers";
import { intervalChart, shareChart, type Mark, type Sample, type SharePanel } from "./share_chart";
import { hasStarts, StartsMap } from "./starts_map";
import type { Store } from "./store";

/** Chooses the trial, and shows it: in the list where nothing else is known of it. */
function openTrial(store: Store, trial: number): void {
  store.chooseTrial(trial);
  const row = document.querySelector(`#trials [data-trial="${trial}"]`);
  const view = document.getElementById("view") ?? row ?? document.getElementById("trials");
  view?.scrollIntoView({ behavior: "auto" });
}

const mostRows = 50;

const outcomeOrder = ["wrong", "failed", "undecided", "declared", "right"];

/** A row of the list: a trial with its index in the run. */
interface Listed {
  trial: Trial;
  index: number;
}

function trialColumns(store: Store, hasCertificates: boolean): Column<Listed>[] {
  const least = (by: (trial: Trial) => number | string | undefined): Column<Listed>["order"] => ({ by: ({ trial }) => by(trial), best: "least" });
  const certificate: Column<Listed> = {
    name: "contact certified",
    cell: ({ trial: { certificate: c } }) => (c ? `${percent(c.contact)}, elsewhere ≤ ${percent(c.at_most)}` : "–"),
    order: { by: ({ trial: { certificate: c } }) => c && c.contact - c.at_most, best: "most" },
  };
  return [
    {
      name: "trial",
      cell: ({ trial, index }) => el("button", { type: "button", "data-trial": index, "aria-pressed": String(index === store.selected.trial), click: () => openTrial(store, index) }, String(trial.trial)),
      order: least(({ trial }) => trial),
    },
    {
      name: "outcome",
      cell: ({ trial: { outcome } }) => el("span", { class: `outcome ${outcome ?? "running"}` }, outcome ?? "running"),
      order: least(({ outcome }) => outcomeOrder.indexOf(outcome ?? "")),
    },
    { name: "steps", word: "steps of a trial", cell: ({ trial }) => count(trial.steps), order: least(({ steps }) => steps) },
    { name: "error, m", cell: ({ trial }) => fixed(trial.translation_error_m, 3), order: least(({ translation_error_m: m }) => m) },
    { name: "error, °", cell: ({ trial }) => fixed(trial.rotation_error_deg, 2), order: least(({ rotation_error_deg: deg }) => deg) },
    { name: "distance, m", word: "way of a trial", cell: ({ trial }) => fixed(trial.distance_m, 2), order: least(({ distance_m: m }) => m) },
    { name: "start, m", word: "start of a trial", cell: ({ trial }) => fixed(trial.start.distance_m, 1), order: least(({ start }) => start.distance_m) },
    ...(hasCertificates ? [certificate] : []),
    { name: "why", cell: ({ trial }) => trial.why ?? "", kind: () => "long" },
  ];
}

/** The list of the chosen run's trials. */
export class TrialList {
  readonly element: HTMLElement;
  private readonly target = el("div", {});
  private readonly controls = el("p", { class: "controls" });
  private table: DataTable<Listed> | null = null;
  private hasCertificates = false;
  /** Empty for all. */
  private outcome: string = "";

  constructor(private readonly store: Store) {
    this.element = section("trials", "Trials", this.controls, this.target);
    store.subscribe((change) => {
      if (change.run) this.fill();
      else if (change.trial) this.mark();
    });
  }

  fill(): void {
    const hasCertificates = this.store.run.trials.some((trial) => trial.certificate);
    // News of a run that goes on leave the order and the rows that the reader has asked for.
    if (!this.table || !this.store.report.live || hasCertificates !== this.hasCertificates) {
      this.hasCertificates = hasCertificates;
      this.table = new DataTable(trialColumns(this.store, hasCertificates), { keys: 3, most: mostRows, what: "trials", className: "trials" });
      replace(this.target, this.table.element);
    }
    this.showOutcome(this.outcome);
  }

  /** What is asked for most is which were wrong. */
  private drawControls(): void {
    const { trials } = this.store.run;
    const kinds = [...new Set(trials.map(({ outcome }) => outcome ?? "running"))].sort((a, b) => outcomeOrder.indexOf(a) - outcomeOrder.indexOf(b));
    const choice = (outcome: string, text: string): HTMLElement =>
      el("button", { type: "button", "data-outcome": outcome, "aria-pressed": String(outcome === this.outcome), click: () => this.showOutcome(outcome) }, text);
    const of = (kind: string): number => trials.filter(({ outcome }) => (outcome ?? "running") === kind).length;
    this.controls.hidden = kinds.length < 2;
    replace(this.controls, choice("", `all ${count(trials.length)}`), ...kinds.map((kind) => choice(kind, `${kind} ${count(of(kind))}`)));
  }

  private showOutcome(outcome: string): void {
    const listed = this.store.run.trials.map((trial, index) => ({ trial, index }));
    const some = listed.filter(({ trial }) => (trial.outcome ?? "running") === outcome);
    this.outcome = some.length > 0 ? outcome : "";
    this.table?.setRows(some.length > 0 ? some : listed);
    this.drawControls();
  }

  private mark(): void {
    this.target.querySelectorAll<HTMLElement>("[data-trial]").forEach((button) => {
      const isChosen = Number(button.dataset.trial) === this.store.selected.trial;
      button.setAttribute("aria-pressed", String(isChosen));
    });
  }
}

/** As many as lines are told apart. */
const mostCurves = 18;

/** How the trials of each run went: shares, intervals and distributions; of the runs that are looked at together. */
export class Distributions {
  readonly element: HTMLElement;
  private readonly target = el("div", {});
  private readonly starts: StartsMap | null;
  private charts: { rebuild: () => void }[] = [];

  constructor(private readonly store: Store) {
    this.starts = store.report.runs.some(hasStarts) ? new StartsMap(store, (trial) => openTrial(store, trial)) : null;
    this.element = section("distributions", "Over all trials", this.target);
    store.subscribe((change) => change.shown && this.fill());
  }

  fill(): void {
    const runs = [...this.store.shown];
    const groups = bestFirst(runs, "setting");
    const curved = groups.slice(0, mostCurves);
    const ofAll = ({ trials }: Group): number => trials.length;
    /** Of the values there are, unless `of` says otherwise; no chart where there are none. */
    const share = (
      id: string,
      title: string,
      axes: Partial<ChartOptions>,
      values: (group: Group) => number[],
      of = (group: Group): number => values(group).length,
    ): SharePanel[] => {
      const samples = curved.map((group, index): Sample => ({ label: group.name, index, values: values(group), of: of(group) }));
      return samples.every((sample) => sample.values.length === 0) ? [] : [shareChart(id, title, samples, axes)];
    };
    const errors = [
      ...share("translation", "Translation error when localized", { xLabel: "error, m" }, ofRight((trial) => trial.translation_error_m)),
      ...share("rotation", "Rotation error when localized", { xLabel: "error, °" }, ofRight((trial) => trial.rotation_error_deg)),
      ...share("time", "Wall time of a step", { xLabel: "time, ms", logX: true }, stepTimes),
    ];
    const curves = [
      ...share("over_steps", "Localized, by steps", { xLabel: "steps" }, ofRight((trial) => trial.steps), ofAll),
      ...share("over_distance", "Localized, by distance", { xLabel: "distance, m" }, ofRight((trial) => trial.distance_m), ofAll),
      // Of several, box plots say the same side by side.
      ...(groups.length > 1 ? [] : errors),
    ];
    const isOfRuns = groups.every((group) => group.runs.length === 1 && group.runs[0].summary);
    const success = isOfRuns && groups.length > 1 ? [successChart(groups.map((group) => group.runs[0]))] : [];
    const starts = this.starts ? [this.starts] : [];
    this.charts = [...starts, ...success, ...curves];
    const boxes = new BoxPlots(groups);
    const names = curved.length > 1 ? curved.map((group, i) => el("span", {}, lineSample(i), group.name)) : [];
    const left = groups.length - curved.length;
    replace(
      this.target,
      names.length > 0 && el("p", { class: "names" }, ...names, left > 0 && el("span", {}, `and ${left} more, in the boxes below`)),
      el(
        "div",
        { class: "over-trials" },
        ...starts.map((each) => each.element),
        el("div", { class: "panels" }, ...[...success, ...curves].map((each) => each.element)),
      ),
      boxes.element,
      curves.length > 0 &&
        el(
          "p",
          { class: "note" },
          "Curves are cumulative: what part of all trials was rightly localized by then" +
            (groups.length > 1 ? "." : ", of right declarations had an error no larger, or of steps took no longer."),
        ),
    );
    this.rebuild();
  }

  rebuild(): void {
    for (const each of this.charts) each.rebuild();
  }
}

/** Right and wrong of all trials, with their 95 % intervals. */
function successChart(runs: Run[]): SharePanel {
  const marks = runs.flatMap(({ summary }, index): Mark[] =>
    summary && summary.trials.count > 0
      ? [
          { x: index + 0.88, rate: summary.success_rate, index, shape: "●" },
          { x: index + 1.12, rate: summary.false_rate, index, shape: "■" },
        ]
      : [],
  );
  return intervalChart("success", "Right (●) and wrong (■), with 95 % intervals", marks, {
    xLabel: "run, in the order of the table",
    xRange: [0.5, runs.length + 0.5],
    whole: true,
  });
}
