// All trials: one run's as a list to choose from, and what all runs make of them.
import type uPlot from "uplot";
import { chart, type ChartOptions, type Line } from "./charts";
import { runLine, themeColour } from "./colours";
import { lineSample } from "./curves";
import { stepTime, type Run, type Trial } from "./data";
import { BoxPlots } from "./distributions";
import { el, replace, section, table } from "./elements";
import { groupsOf, type Group } from "./groups";
import { count, fixed, percent } from "./numbers";
import { cumulativeShare } from "./shares";
import { hasStarts, StartsMap } from "./starts_map";
import type { Store } from "./store";
import { explained } from "./words";

/** Chooses the trial, and shows it: in the list where nothing else is known of it. */
function openTrial(store: Store, trial: number): void {
  store.chooseTrial(trial);
  const row = document.querySelector(`#trials [data-trial="${trial}"]`);
  const view = document.getElementById("view") ?? row ?? document.getElementById("trials");
  view?.scrollIntoView({ behavior: "auto" });
}

/** Laying out thousands of rows takes longer than all the rest of the page. */
const mostRows = 500;

/** The list of the chosen run's trials. */
export class TrialList {
  readonly element: HTMLElement;
  private readonly list = el("div", {});
  private hasAll = false;

  constructor(private readonly store: Store) {
    this.element = section("trials", "Trials", this.list);
    store.subscribe((change) => {
      if (change.run) this.fill();
      else if (change.trial) this.mark();
    });
  }

  fill(): void {
    const { trials } = this.store.run;
    const hasCertificates = trials.some((trial) => trial.certificate);
    const certificate = ({ certificate: c }: Trial): string[] =>
      hasCertificates ? [c ? `${percent(c.contact)}, elsewhere ≤ ${percent(c.at_most)}` : "–"] : [];
    const word = (text: string, meant: string): HTMLElement => explained(el("span", {}, text), meant);
    const shown = this.hasAll ? trials : trials.slice(0, mostRows);
    const rows = shown.map((trial, i) => [
      el("button", { type: "button", "data-trial": i, click: () => openTrial(this.store, i) }, String(trial.trial)),
      `${fixed(trial.start.distance_m, 1)} m`,
      el("span", { class: `outcome ${trial.outcome ?? "running"}` }, trial.outcome ?? "running"),
      count(trial.steps),
      fixed(trial.distance_m, 2),
      fixed(trial.translation_error_m, 3),
      fixed(trial.rotation_error_deg, 2),
      ...certificate(trial),
      trial.why ?? "",
    ]);
    replace(
      this.list,
      table(
        [
          "trial",
          word("start", "start of a trial"),
          "outcome",
          word("steps", "steps of a trial"),
          word("distance, m", "way of a trial"),
          "error, m",
          "error, °",
          ...(hasCertificates ? ["contact certified"] : []),
          "why",
        ],
        rows,
        "trials",
      ),
      shown.length < trials.length &&
        el("p", { class: "note" }, `The first ${count(shown.length)}. `, el("button", { type: "button", click: () => this.fillAll() }, `all ${count(trials.length)} trials`)),
    );
    this.mark();
  }

  private fillAll(): void {
    this.hasAll = true;
    this.fill();
  }

  private mark(): void {
    this.list.querySelectorAll<HTMLElement>("[data-trial]").forEach((button) => {
      const isChosen = Number(button.dataset.trial) === this.store.selected.trial;
      button.setAttribute("aria-pressed", String(isChosen));
    });
  }
}

/** As many as lines are told apart. */
const mostCurves = 18;

interface Sample {
  label: string;
  index: number;
  values: number[];
  /** What the share is of; more than there are values if some never come. */
  of: number;
}

/** How the trials of each run went: shares, intervals and distributions. */
export class Distributions {
  readonly element: HTMLElement;
  private readonly charts: { rebuild: () => void }[];

  constructor(store: Store) {
    const { runs } = store.report;
    const groups = groupsOf(store.report);
    const curved = groups.slice(0, mostCurves);
    const rights = (value: (trial: Trial) => number | undefined) => (group: Group): Pick<Sample, "values" | "of"> => {
      const right = group.trials.filter((trial) => trial.outcome === "right").map(value);
      return { values: right.filter((v): v is number => v !== undefined), of: group.trials.length };
    };
    const ofRight = (value: (trial: Trial) => number | undefined) => (group: Group): Pick<Sample, "values" | "of"> => {
      const { values } = rights(value)(group);
      return { values, of: values.length };
    };
    const times = (group: Group): Pick<Sample, "values" | "of"> => {
      const values = group.trials.flatMap(({ columns }) =>
        columns ? columns.step.map((_, i) => stepTime(columns, i)) : [],
      );
      return { values, of: values.length };
    };
    const share = (
      id: string,
      title: string,
      xLabel: string,
      sample: (group: Group) => Pick<Sample, "values" | "of">,
      options: Partial<ChartOptions> = {},
    ): ShareChart =>
      new ShareChart(id, title, xLabel, curved.map((group, index) => ({ label: group.name, index, ...sample(group) })), options);
    const errors = [
      share("translation", "Translation error when localized", "m", ofRight((trial) => trial.translation_error_m)),
      share("rotation", "Rotation error when localized", "°", ofRight((trial) => trial.rotation_error_deg)),
      share("time", "Wall time of a step", "ms", times, { logX: true }),
    ];
    const curves = [
      share("over_steps", "Localized, by steps", "steps", rights((trial) => trial.steps)),
      share("over_distance", "Localized, by distance", "distance, m", rights((trial) => trial.distance_m)),
      // Of several, box plots say the same side by side.
      ...(groups.length > 1 ? [] : errors),
    ].filter((each) => !each.isEmpty);
    const success = groups === runs && runs.length > 1 && runs.every((run) => run.summary) ? [new SuccessChart(runs)] : [];
    const starts = runs.some(hasStarts) ? [new StartsMap(store, (trial) => openTrial(store, trial))] : [];
    this.charts = [...starts, ...success, ...curves];
    const boxes = new BoxPlots(groups);
    const names = curved.length > 1 ? curved.map((group, i) => el("span", {}, lineSample(i), group.name)) : [];
    const left = groups.length - curved.length;
    this.element = section(
      "distributions",
      "Over all trials",
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
  }

  rebuild(): void {
    for (const each of this.charts) each.rebuild();
  }
}

class ShareChart {
  readonly element: HTMLElement;
  private readonly target = el("div", { class: "plot" });
  private drawn: ReturnType<typeof chart> | null = null;

  constructor(
    id: string,
    title: string,
    private readonly xLabel: string,
    private readonly samples: Sample[],
    private readonly options: Partial<ChartOptions>,
  ) {
    this.element = el("div", { class: "panel", "data-share": id }, el("h3", {}, title), this.target);
  }

  get isEmpty(): boolean {
    return this.samples.every((sample) => sample.values.length === 0);
  }

  rebuild(): void {
    this.drawn?.destroy();
    this.drawn = null;
    const all = this.samples.flatMap((sample) => sample.values);
    const x = [...new Set(this.options.logX ? all.filter((v) => v > 0) : [0, ...all])].sort((a, b) => a - b);
    const lines = this.samples.map((sample): Line => ({
      label: sample.label,
      ...runLine(sample.index),
      values: cumulativeShare(sample, x),
      stepped: true,
    }));
    this.drawn = chart(this.target, {
      x,
      lines,
      xLabel: this.xLabel,
      labels: ["share"],
      range: [0, 1],
      height: 190,
      ...this.options,
    });
  }
}

/** Right and wrong of all trials, with their 95 % intervals. */
class SuccessChart {
  readonly element: HTMLElement;
  private readonly target = el("div", { class: "plot" });
  private drawn: ReturnType<typeof chart> | null = null;

  constructor(private readonly runs: Run[]) {
    this.element = el(
      "div",
      { class: "panel", "data-share": "success" },
      el("h3", {}, "Right (●) and wrong (■), with 95 % intervals"),
      this.target,
    );
  }

  rebuild(): void {
    this.drawn?.destroy();
    const none = this.runs.map(() => null);
    this.drawn = chart(this.target, {
      x: this.runs.map((_, i) => i + 1),
      lines: [{ label: "success", colour: themeColour("ink"), dash: [], values: none }],
      xLabel: "run, in the order of the table",
      labels: ["share"],
      range: [0, 1],
      height: 190,
      xRange: [0.5, this.runs.length + 0.5],
      whole: true,
      hooks: { draw: [(plot) => this.runs.forEach((run, i) => drawIntervals(plot, run, i))] },
    });
  }
}

function drawIntervals(plot: uPlot, run: Run, i: number): void {
  if (!run.summary) return;
  const { ctx } = plot;
  const { success_rate, false_rate } = run.summary;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = runLine(i).colour;
  ctx.lineWidth = 2 * ratio;
  [success_rate, false_rate].forEach((rate, k) => {
    const x = plot.valToPos(i + 1 + (k === 0 ? -0.12 : 0.12), "x", true);
    const [low, value, high] = [rate.low, rate.value, rate.high].map((v) => plot.valToPos(v, "y", true));
    ctx.beginPath();
    ctx.moveTo(x, low);
    ctx.lineTo(x, high);
    ctx.stroke();
    ctx.beginPath();
    if (k === 0) ctx.arc(x, value, 4 * ratio, 0, 2 * Math.PI);
    else ctx.rect(x - 3 * ratio, value - 3 * ratio, 6 * ratio, 6 * ratio);
    ctx.fill();
  });
  ctx.restore();
}
